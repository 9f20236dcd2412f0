#pragma once
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "app/balance.hpp"
#include "app/budget.hpp"
#include "app/checkpoint.hpp"
#include "app/departures.hpp"
#include "app/diagnostics.hpp"
#include "app/energy_table.hpp"
#include "app/exact_solution.hpp"
#include "app/expectations.hpp"
#include "app/moment.hpp"
#include "app/output.hpp"
#include "app/particle_statistics.hpp"
#include "app/probes.hpp"
#include "app/profiles.hpp"
#include "app/progress.hpp"
#include "app/tracked_particles.hpp"
#include "app/wall_table.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"
#include "coupling/coupling.hpp"
#include "fluid/fluid.hpp"
#include "particles/particles.hpp"

namespace silt {

/// `-title` and `-gravity`.
struct CaseOptions {
  std::string title = "untitled";
  Vec3 gravity = Vec3(0, 0, -9.81);
  void options(OptionGroup& option);
};

/// The options `-time_...`.
struct TimeOptions {
  double end = 1;
  double step = 1e-3;
  double courant = 0;
  double least_step = 0;
  void options(OptionGroup& option);
};

/// One run: owns the parts and moves them through time. A pure particle run and a pure flow run are the same loop with
/// an empty partner.
class Simulation {
 public:
  /// Reads every option and builds the parts; throws UserError before anything is computed or written. Collective.
  explicit Simulation(Options& options) : Simulation(options, nullptr) {}

  /// What a run hands on when its work is shared out anew: the file of its state, and what has been seen so far.
  struct Carried {
    std::string file;
    double reached = 0;  ///< imbalance before
    std::unique_ptr<Expectations> expectations;
    std::unique_ptr<Profiles> profiles;
    std::array<double, 4> seconds{};
  };
  /// Goes on from another one, on other cells of the mesh. Collective.
  Simulation(Options& options, std::unique_ptr<Carried> carried);

  /// Says what would run and returns 0. Collective.
  int check();
  /// Runs to the end; returns 0, or 1 when an expected figure was missed; or `share_out_anew`, with carried() to go on
  /// from. Collective.
  int run();
  static constexpr int share_out_anew = -1;
  std::unique_ptr<Carried> carried() { return std::move(carried_); }

 private:
  void start();
  void choose_step();
  void step();
  void attempt();
  void report();
  void write_checkpoint(const std::string& file, const Costs& costs);
  RunParts run_parts() const;
  void keep_state();
  bool uneven();
  bool uneven_at_start();
  void hand_on(double imbalance, const Costs& costs);
  Costs costs() const;
  /// Goes back to the last good state, writes it and returns words about it for the error that ends the run.
  std::string save_last_good();
  bool ended() const { return now_.time >= time_options_.end * (1 - 1e-12); }
  void finish();
  std::string description() const;

  Options& options_;
  CaseOptions case_;
  TimeOptions time_options_;
  std::unique_ptr<Mesh> mesh_;
  std::unique_ptr<Fluid> fluid_;
  std::unique_ptr<Particles> particles_;
  std::unique_ptr<Coupling> coupling_;

  std::unique_ptr<Output> output_;
  std::unique_ptr<Diagnostics> diagnostics_;
  std::unique_ptr<ExactSolution> exact_;
  std::unique_ptr<Probes> probes_;
  std::unique_ptr<Profiles> profiles_;
  std::unique_ptr<Budget> budget_;
  Departures departures_;
  std::unique_ptr<WallTable> walls_;
  std::unique_ptr<EnergyTable> energy_;
  std::unique_ptr<Expectations> expectations_;
  std::unique_ptr<TrackedParticles> tracked_;
  std::unique_ptr<ParticleStatistics> statistics_;
  std::unique_ptr<Progress> progress_;

  std::unique_ptr<Checkpoint> checkpoint_;
  std::unique_ptr<Balance> balance_;
  std::unique_ptr<Carried> carried_;           ///< from the run before, or for the one after
  double reached_ = 0;                         ///< imbalance when the work was last shared out anew
  std::unique_ptr<CheckpointReader> restart_;  ///< what the run goes on from; null for a fresh run

  /// A state to go back to.
  struct Good {
    std::shared_ptr<const Particles::Snapshot> particles;
    std::optional<Profiles> profiles;
    std::vector<std::vector<double>> flow, exchange;  ///< arrays of fluid and coupling
    double largest_diameter = 0, last_step = 0;       ///< of the coupling
    Budget::Opening opening;
    RunClock clock;
  };
  Good good_;
  int substeps_since_good_ = 0;

  Moment now_;
  double dt_ = 0;         ///< s, the coming step
  double shortened_ = 0;  ///< s, the longest step allowed after a failed solve; 0: none failed lately

  /// Where the wall time of the loop goes.
  enum Task { moving_particles, solving_fluid, exchanging, writing, tasks };
  class Stopwatch;
  std::array<double, tasks> seconds_{}, seconds_before_{};  ///< in all, and on earlier partitions
  static_assert(tasks == 4);
};

}  // namespace silt
