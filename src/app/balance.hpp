#pragma once
#include <array>

#include "base/checkpoint_file.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"
#include "particles/particles.hpp"

namespace silt {

/// The options `-balance_...`.
struct BalanceOptions {
  double interval = 0, threshold = 1.2, start = 1.05;
  void options(OptionGroup& option);
};

/// What a particle and a cell cost in this run, as measured: wall time of their phases per step over the largest number
/// on any rank (the one that does not wait). s
struct Costs {
  double particle = 1, cell = 1;
};

/// Watches how evenly the work is shared out among the ranks.
class Balance {
 public:
  explicit Balance(Options& options) { options.read("balance", options_); }

  /// Measures the costs of a stretch of steps: seconds spent with particles and with cells. Collective.
  static Costs measure(const Mesh& mesh, const Particles* particles, double particle_seconds, double cell_seconds);
  /// What they will cost, from counts alone, so that the same input gives the same partition: `substeps` of the
  /// particles in a step, solved `unknowns` of the flow a cell (0: none), solved all at once or by pressure correction.
  static Costs estimate(double substeps, double unknowns, bool at_once);
  /// Work of the busiest rank over the mean. Collective.
  static double imbalance(const Mesh& mesh, const Particles* particles, const Costs& costs);

  /// Whether a new multiple of the interval has been passed at this time.
  bool due(double time);
  /// Whether it is worth sharing the work out anew; `reached`: what the last attempt came to, 0 when there was none.
  bool worthwhile(double imbalance, double reached) const {
    return imbalance > options_.threshold && (reached == 0 || imbalance > 1.1 * reached);
  }
  void start(double time) { due(time); }
  /// Whether it is worth it before the first step. Collective.
  bool worthwhile_at_start(double imbalance, const Particles* particles) const;

 private:
  BalanceOptions options_;
  long long looked_ = 0;  ///< multiples of the interval that have been passed
};

/// How the cells are to be shared out in a run that goes on from a checkpoint: as in the run that wrote it on as many
/// ranks; else, or when `anew`, by the particles there are and the costs measured. Collective.
Partition partition_of(const CheckpointReader& from, bool anew);
/// What partition_of() needs. Collective.
void save_partition(const Mesh& mesh, const Costs& costs, CheckpointWriter& to);

}  // namespace silt
