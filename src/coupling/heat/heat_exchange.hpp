#pragma once
#include <span>
#include <string>
#include <vector>

#include "coupling/filter.hpp"
#include "coupling/fluid_properties.hpp"
#include "coupling/heat/nusselt.hpp"
#include "coupling/kernel.hpp"
#include "fluid/fluid.hpp"
#include "particles/particles.hpp"

namespace silt {

/// What fluid and particles exchanged in one fluid step, each sum over the particles and over the nodes. J, all ranks.
struct HeatLedger {
  double received = 0;               ///< heat the particles took in their substeps
  double given = 0;                  ///< the load's total times dt: the opposite
  double response_on_particles = 0;  ///< taken for the change of the fluid's temperature
  double response_on_fluid = 0;      ///< the opposite
  double residual = 0;               ///< largest imbalance of the two pairs, relative to the magnitudes summed
};

/// The exchange of heat over one fluid step (docs/theory/coupling.md, C17, C18): particles relax towards the
/// temperature T^n of the fluid with h A, the fluid's load is spread over the nodes by pairs of particle and node, so
/// that heat goes from warm to cold only, and its linearised rest -response_i (T^{n+1} - T^n)_i is given to the
/// particles after the fluid's step with H = m c_p (1 - exp(-h A dt/(m c_p))).
class HeatExchange {
 public:
  HeatExchange(const Mesh& mesh, const std::vector<double>& mass, Particles& particles, Fluid& fluid, Options& options);
  std::string name() const;

  /// Sets what the particles relax to; their velocities relative to the fluid are those of FluidAction. `alpha`: at the
  /// particles. Collective, like the others.
  void before_particles(const FluidProperties& properties, const Filter& filter, const Kernel& kernel,
                        std::span<const double> alpha);
  /// Sets heat and heat_response of the fluid's load. The kernel holds owned particles, then those departed.
  void before_fluid(double dt, double depth, const Filter& filter, const Kernel& kernel);
  /// Settles the rest. Throws RunError on all ranks when out of balance.
  void after_fluid(double dt, double depth, const Filter& filter, const Kernel& kernel);
  const HeatLedger& ledger() const { return ledger_; }

 private:
  const Mesh& mesh_;
  const std::vector<double>& mass_;
  Particles& particles_;
  Fluid& fluid_;
  NusseltModels::Any nusselt_;
  int temperature_, outside_, exchange_, received_;
  HeatLedger ledger_;
  double exchanged_ = 0;
  double mean_ = 0;               ///< K, of the fluid's temperature T^n over its nodes
  std::vector<double> filtered_;  ///< K, T^n less its mean, filtered
  std::vector<double> nodal_, at_particles_, share_, seen_;
};

}  // namespace silt
