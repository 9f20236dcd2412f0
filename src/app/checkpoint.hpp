#pragma once
#include <memory>
#include <string>

#include "app/balance.hpp"
#include "app/moment.hpp"
#include "base/checkpoint_file.hpp"
#include "base/options.hpp"
#include "base/output_directory.hpp"
#include "coupling/coupling.hpp"

namespace silt {

class Budget;
class Expectations;
class Profiles;

/// The options `-checkpoint_...`.
struct CheckpointOptions {
  double interval = 0;
  void options(OptionGroup& option);
};

/// `-restart`.
struct RestartOptions {
  InputFile file;
  void options(OptionGroup& option);
};

/// The parts of a run that a checkpoint holds; null where the run has none.
struct RunParts {
  const Mesh& mesh;
  Fluid* fluid;
  Particles* particles;
  Coupling* coupling;
  Profiles* profiles;          ///< averages so far
  Expectations* expectations;  ///< what they have noted so far
  Budget* budget;              ///< what its next account opens with
};

/// Where the run's clock stands.
struct RunClock {
  double time = 0, dt = 0, shortened = 0;
  long long step = 0;
};

/// One HDF5 file that a run goes on from, `checkpoint.h5` in the output directory: fields, particles with their contact
/// memory and what the fluid owes them, walls, insertions, clock. Each one replaces the one before only when it is
/// complete.
class Checkpoint {
 public:
  explicit Checkpoint(Options& options);
  /// Whether a new multiple of the interval has been passed at this time.
  bool due(double time);
  /// Throws RunError on every rank. Collective.
  static void write(const std::string& path, const RunParts& parts, const RunClock& clock, const Costs& costs);

  /// The file of `-restart`, when given. Throws UserError on every rank for one that is none. Collective.
  static std::unique_ptr<CheckpointReader> open(Options& options);
  /// Loads what follows once all parts are there (particles are loaded by Particles::load before the coupling is made).
  /// Collective.
  static RunClock load(const CheckpointReader& from, const RunParts& parts);
  void start(double time) { due(time); }
  bool wanted() const { return options_.interval > 0; }

 private:
  CheckpointOptions options_;
  long long written_ = 0;  ///< multiples of the interval that have been passed
};

}  // namespace silt
