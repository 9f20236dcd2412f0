#pragma once
#include <vector>

#include "coupling/filter.hpp"
#include "coupling/kernel.hpp"
#include "fluid/fluid.hpp"
#include "particles/particles.hpp"

namespace silt {

/// What the work of the forces between fluid and particles moved in one fluid step. J, all ranks.
struct WorkLedger {
  double given = 0;       ///< to the fluid by its load: minus the work that was owed for
  double owed = 0;        ///< work on the particles that the load stands for
  double response = 0;    ///< taken from the fluid at its nodes for the change of its velocity
  double settled = 0;     ///< the same summed over the particles
  double displaced = 0;   ///< given to the fluid by particles that went to another pressure
  double inserted = 0;    ///< given to the fluid by the volume of particles that came (negative: left) at mean pressure
  double in_transit = 0;  ///< work on the particles (positive) that the fluid has still to be charged with
  double residual = 0;    ///< largest imbalance, relative to the magnitudes summed
};

/// The energy of a fluid that solves for its total energy, against that of its particles (docs/theory/coupling.md,
/// C12): each particle carries the account of the work that the fluid did on it and was not charged with. The next
/// step's load charges it. What the fluid paid in the same step, by its response and by being displaced, is booked in
/// advance.
class WorkExchange {
 public:
  WorkExchange(const Mesh& mesh, const std::vector<double>& mass, Particles& particles, Fluid& fluid)
      : mesh_(mesh), mass_(mass), particles_(particles), fluid_(fluid) {}

  /// Sets the load's energy. The kernel holds owned particles, then those departed. Collective.
  void before_fluid(double dt, double depth, const Filter& filter, const Kernel& kernel);
  /// Takes what the fluid paid per unit of response, before particles are settled. Collective.
  void after_fluid(double dt, double depth, const Filter& filter, const Kernel& kernel);
  /// Opens the account of particle p anew: `response` (kg) and the impulses it is about to get at once and from the
  /// pressure (N s). Local.
  void settle(int p, double response, const Vec3& at_once, const Vec3& pressure);
  /// Closes the step. Throws RunError on all ranks when out of balance. Collective.
  void close(double dt, double depth);
  const WorkLedger& ledger() const { return ledger_; }

 private:
  const Mesh& mesh_;
  const std::vector<double>& mass_;
  Particles& particles_;
  Fluid& fluid_;
  WorkLedger ledger_;
  double exchanged_ = 0, volume_ = 0, moved_ = 0;
  std::vector<double> nodal_, at_particles_;
};

}  // namespace silt
