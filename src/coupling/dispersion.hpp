#pragma once
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/filter.hpp"
#include "coupling/kernel.hpp"
#include "fluid/fluid.hpp"
#include "particles/particles.hpp"

namespace silt {

/// The turbulence around a particle.
struct TurbulenceAround {
  double energy;       ///< m2/s2, k
  double dissipation;  ///< m2/s3, epsilon
};

/// Particles feel the mean velocity alone.
struct NoDispersion {
  static constexpr const char* name = "none";
  static constexpr ModelNote note = {"", "", "u' = 0", ""};
  void options(OptionGroup&) {}
};

/// Discrete random walk (Gosman & Ioannides 1983): a particle meets one eddy after the other, each with its own
/// fluctuation u', for as long as the eddy lives or until the particle has crossed it. tau is the particle's response
/// time, xi a normal deviate in each direction.
struct RandomWalkDispersion {
  static constexpr const char* name = "random_walk";
  static constexpr ModelNote note = {"", "Gosman & Ioannides 1983; Shuen, Solomon, Zhang & Faeth 1985",
                                     "u' = (2k/3)^1/2 xi, for min(2 C_L k/epsilon, -tau ln(1 - l_e/(tau |u + u' - "
                                     "v|))), l_e = C_mu^3/4 k^3/2/epsilon, C_mu = 0.09",
                                     "speed and spread of tracers, D = 2/3 C_L k^2/epsilon; crossing of eddies"};
  double lifetime = 0.15;
  bool crossing = true;
  int seed = 1;
  void options(OptionGroup& option) {
    option("lifetime", lifetime, "-", "C_L: Lagrangian time scale times epsilon/k; an eddy lives twice as long",
           positive);
    option("crossing", crossing, "an eddy also ends when the particle has crossed it");
    option("seed", seed, "-", "another seed, other eddies", at_least(0));
  }
  /// s
  double eddy_life(const TurbulenceAround& flow) const { return 2 * lifetime * flow.energy / flow.dissipation; }
  /// s, infinity for a particle that follows the eddy. `response`: tau, 0 for one without inertia; `slip`: m/s.
  double eddy_crossing(const TurbulenceAround& flow, double response, double slip) const {
    constexpr double c_mu = 0.09;
    const double length = std::pow(c_mu, 0.75) * std::pow(flow.energy, 1.5) / flow.dissipation;
    if (!crossing || !(length < response * slip)) return infinity;
    return -response * std::log1p(-length / (response * slip));
  }
};

using DispersionModels = Models<NoDispersion, RandomWalkDispersion>;

/// Turbulent dispersion by the chosen model, from the fluid's k and epsilon. What a particle keeps of its eddy is the
/// column "eddy": u' (m/s), the time that is left of it (s), and how many eddies it has met. The random numbers are a
/// function of the particle's id, the number of the eddy and the seed: any ranks and any steps give the same eddies.
class Dispersion {
 public:
  /// Null for `-dispersion_type none`; throws UserError when the fluid has no k and epsilon.
  static std::unique_ptr<Dispersion> create(const Fluid& fluid, Particles& particles, Options& options);
  Dispersion(RandomWalkDispersion model, Particles& particles);
  std::string name() const { return model_.name; }
  /// Adds the mean fluctuation over the coming step of dt to the fluid velocity at each particle, [owned][3]. The
  /// kernel holds the particles' places. Collective.
  void act(const Fluid& fluid, const Filter& filter, const Kernel& kernel, Particles& particles, double dt,
           std::span<double> velocity);

 private:
  /// Mean fluctuation over dt of a particle with this row of the column.
  Vec3 mean_fluctuation(std::int64_t id, const TurbulenceAround& flow, double response, double slip, double dt,
                        double* row) const;
  std::array<double, 4> deviates(std::int64_t id, double eddy) const;

  RandomWalkDispersion model_;
  int column_;
  std::vector<double> nodal_, at_particles_;
};

}  // namespace silt
