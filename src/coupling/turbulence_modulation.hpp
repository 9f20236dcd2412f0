#pragma once
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

/// A particle in turbulence, as a model of modulation needs it. Each model gives W, what the particle adds to k.
struct ParticleInTurbulence {
  double energy, dissipation;  ///< m2/s2, m2/s3: k and epsilon around it
  double exchange;             ///< kg/s, drag coefficient
  double mass;                 ///< kg
  double slip;                 ///< m/s, |u - v|
  double held;                 ///< 0 free ... 1 held by contacts, which do not follow any eddy
};

/// Particles neither feed nor damp the turbulence.
struct NoModulation {
  static constexpr const char* name = "none";
  static constexpr ModelNote note = {"", "", "W = 0", ""};
  void options(OptionGroup&) {}
};

/// What epsilon gets beside what k gets.
struct AddedDissipation {
  double dissipation_factor = 1.2;
  void options(OptionGroup& option) {
    option("dissipation_factor", dissipation_factor, "-", "C: epsilon gets C epsilon/k times what k gets",
           non_negative);
  }
};

/// The turbulence works against the drag of particles that do not follow it (Simonin & Viollet 1990; Elghobashi &
/// Abou-Arab 1983), q the covariance of the fluctuations of fluid and particle in equilibrium (Tchen-Hinze), none for a
/// held particle.
struct DragDissipation : AddedDissipation {
  static constexpr const char* name = "drag_dissipation";
  static constexpr ModelNote note = {
      "", "Simonin & Viollet 1990; Elghobashi & Abou-Arab 1983",
      "W = -k_p (2 k - q), q = 2 k/(1 + St), St = (m/k_p)/(3/2 C_mu k/epsilon); epsilon: C epsilon/k W",
      "decay among held particles in closed form; limits of St; sums"};
  double work(const ParticleInTurbulence& p) const {
    constexpr double c_mu = 0.09;
    // St/(1 + St) = 1/(1 + T_L k_p/m)
    const double lag = p.dissipation > 0 ? 1 / (1 + 1.5 * c_mu * p.energy / p.dissipation * p.exchange / p.mass) : 0.0;
    return -2 * p.exchange * p.energy * (p.held + (1 - p.held) * lag);
  }
};

/// Wakes: all of the work that the mean slip does against the drag becomes turbulence (Crowe 2000, eq. of the
/// volume-averaged k).
struct SlipProduction : AddedDissipation {
  static constexpr const char* name = "slip_production";
  static constexpr ModelNote note = {"", "Crowe 2000", "W = k_p |u - v|^2; epsilon: C epsilon/k W", "its value; sums"};
  double work(const ParticleInTurbulence& p) const { return p.exchange * p.slip * p.slip; }
};

using ModulationModels = Models<NoModulation, DragDissipation, SlipProduction>;

/// What particles do to the turbulence of the fluid by the chosen model, as a load of its k equation: the same weights
/// and filter as for momentum, so what the particles give is what the fluid gets, to round-off.
class TurbulenceModulation {
 public:
  /// Null for `-modulation_type none`; throws UserError when the fluid solves no equations for k and epsilon or omega.
  static std::unique_ptr<TurbulenceModulation> create(const Mesh& mesh, const std::vector<double>& mass,
                                                      const Fluid& fluid, Options& options);
  TurbulenceModulation(ModulationModels::Any model, const Mesh& mesh, const std::vector<double>& mass)
      : model_(model), mesh_(mesh), mass_(mass) {}
  std::string name() const;
  /// Fills the load's turbulence from the flow and the particles as they are; the kernel holds the owned particles'
  /// places, and perhaps more. Throws RunError when the sums differ. Collective.
  void before_fluid(double depth, const Filter& filter, const Kernel& kernel, Particles& particles, Fluid& fluid);
  /// W, what the particles added to k: summed over them, and over the nodes.
  double given() const { return given_; }
  double received() const { return received_; }

 private:
  ModulationModels::Any model_;
  const Mesh& mesh_;
  const std::vector<double>& mass_;
  double given_ = 0, received_ = 0;
  std::vector<double> nodal_, at_particles_, work_;
};

}  // namespace silt
