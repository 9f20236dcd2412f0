#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/locator.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"
#include "coupling/dispersion.hpp"
#include "coupling/drag/drag_models.hpp"
#include "coupling/exchange.hpp"
#include "coupling/filter.hpp"
#include "coupling/fluid_forces.hpp"
#include "coupling/fluid_properties.hpp"
#include "coupling/heat/heat_exchange.hpp"
#include "coupling/kernel.hpp"
#include "coupling/thermophoresis.hpp"
#include "coupling/turbulence_modulation.hpp"
#include "coupling/void_fraction.hpp"
#include "coupling/work_exchange.hpp"
#include "fluid/fluid.hpp"
#include "particles/particles.hpp"

namespace silt {

/// The options `-coupling_...`.
struct CouplingOptions {
  std::optional<double> filter_length;
  double void_fraction_minimum = 0.2;
  std::optional<double> depth;
  bool viscous_stress = false;
  void options(OptionGroup& option) {
    option("filter_length", filter_length, "m",
           "length l by which what a particle does to the fluid is spread: a Gaussian of variance 2 l^2 in each "
           "direction, so two standard "
           "deviations are 2.83 l; 0: the cell's shape functions alone. By default two standard deviations are two "
           "particle diameters, "
           "and never less than two cells",
           non_negative);
    option("void_fraction_minimum", void_fraction_minimum, "-", "void fraction below which the run stops",
           Range{0, 1, true, true});
    option("depth", depth, "m",
           "thickness that a 2D mesh stands for; the particles' volume and forces are spread over it", positive);
    option("viscous_stress", viscous_stress, "particles feel V_p div tau of the undisturbed flow as well");
  }
};

/// What a step exchanged: null where there is no coupling, heat or total energy.
struct ExchangeAccounts {
  const ExchangeLedger* momentum = nullptr;
  const HeatLedger* heat = nullptr;
  const WorkLedger* work = nullptr;
};

/// The exchange of volume and momentum between fluid and particles over one fluid step:
///
///     coupling.before_particles(dt);  particles.advance(t, dt);
///     coupling.before_fluid(dt);      fluid.advance(t, dt);
///     coupling.after_fluid(dt);
///
/// Particles go first, with the fluid velocity u^n: the drag impulse I_p that each received is summed. The fluid then
/// has the source -sum_p w_i I_p/dt and the linearised rest -response_i (u^{n+1} - u^n)_i; and each particle is owed
/// for that rest exactly J_p = K_p dt (u^{n+1} - u^n)(x_p). What particles give and take goes through the same weights
/// and the same filter in both directions, so action equals reaction to round-off whatever K_p is (exchange.hpp says
/// what it is). The pressure-gradient impulse of the fluid's step and the part of J_p that contacts must carry are
/// given as a force over the particles' next step.
class Coupling {
 public:
  /// Reads `-coupling_...`, `-drag_...`, `-dispersion_...` and the options of the other forces. Collective.
  Coupling(const Mesh& mesh, Particles& particles, Fluid& fluid, Options& options, const Vec3& gravity);
  ~Coupling();

  /// Takes alpha from where the particles are now, as the start of the first step, and makes the flow's initial
  /// velocity meet continuity among them. Collective.
  void start();

  /// Samples u^n at the particles and sets their FluidAction. Collective.
  void before_particles(double dt);
  /// Sets the fluid's ParticleLoad from where the particles are and what drag gave them. May be repeated with another
  /// fluid state. Collective.
  void before_fluid(double dt);
  /// Settles the rest with the particles and closes the step. Throws RunError on all ranks when the exchange is out of
  /// balance. Collective.
  void after_fluid(double dt);

  /// What a restart needs beside fluid and particles: arrays at the nodes, and the largest diameter so far, by which
  /// the automatic filter was made. restored() follows when they were overwritten. Collective.
  std::vector<Fluid::StateArray> state() { return {{"void_fraction", &void_fraction_.state(), 1}}; }
  double largest_diameter() const { return diameter_; }
  /// s, the step that led to the present flow.
  double last_step() const { return last_step_; }
  void restored(double largest_diameter, double last_step);

  /// The last step's exchange, complete after after_fluid().
  const ExchangeLedger& ledger() const { return ledger_; }
  /// The same of heat; null when fluid or particles have no temperature.
  const HeatLedger* heat_ledger() const { return heat_ ? &heat_->ledger() : nullptr; }
  /// The same of work; null when the fluid does not solve for its total energy.
  const WorkLedger* work_ledger() const { return work_ ? &work_->ledger() : nullptr; }
  /// All of them, as the budget takes them.
  ExchangeAccounts accounts() const { return {&ledger(), heat_ledger(), work_ledger()}; }
  /// One line for the header of the run: filter, drag law.
  std::string description() const;
  /// Words for the terminal, once, when the step was in a regime that this fluid does not handle; else empty.
  std::string take_warning() { return std::exchange(warning_, ""); }
  /// Null when particles do nothing to the turbulence.
  const TurbulenceModulation* modulation() const { return modulation_.get(); }
  const Filter& filter() const { return *filter_; }
  const std::vector<double>& mass() const { return mass_; }

 private:
  /// A gas does not count on particles that follow it (docs/theory/coupling.md, C13).
  void watch_following();
  /// alpha from where the particles are now.
  void take_void_fraction();
  void place_particles();
  /// The point of the cell nearest to x in reference coordinates, for a particle that has left it.
  void place_clamped(int p, int cell, const Vec3& x);
  void prepare_filter();

  const Mesh& mesh_;
  Particles& particles_;
  Fluid& fluid_;
  Vec3 gravity_;
  CouplingOptions options_;
  DragModels::Any drag_;
  double depth_ = 1;     ///< m, thickness of a 2D mesh
  double diameter_ = 0;  ///< m, largest so far: what the automatic filter was made for
  Locator locator_;
  Kernel kernel_;
  VoidFraction void_fraction_;
  std::vector<double> mass_;  ///< [nodes] m3 (m2 in 2D)
  std::unique_ptr<Filter> filter_;
  FluidProperties properties_;
  std::unique_ptr<FluidForces> forces_;
  std::unique_ptr<Thermophoresis> thermophoresis_;    ///< null: none
  std::unique_ptr<Dispersion> dispersion_;            ///< null: none
  std::unique_ptr<TurbulenceModulation> modulation_;  ///< null: none
  std::unique_ptr<HeatExchange> heat_;                ///< null: fluid or particles have no temperature
  std::unique_ptr<WorkExchange> work_;                ///< null: the fluid does not solve for its total energy
  double last_step_ = 0;                              ///< s, the step that led to the present flow; 0: none
  ExchangeLedger ledger_;
  double exchanged_ = 0;  ///< N s, sum of the magnitudes exchanged in this step: the scale of the residual
  std::vector<double> nodal_, at_particles_;
  std::vector<double> solids_;  ///< [nodes] 1 - alpha of this step
  std::vector<Response> responses_;
  std::string warning_;
  bool warned_ = false;
};

}  // namespace silt
