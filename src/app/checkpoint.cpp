#include "app/checkpoint.hpp"

#include <cmath>

#include "app/budget.hpp"
#include "app/expectations.hpp"
#include "app/field_state.hpp"
#include "app/profiles.hpp"

namespace silt {

void CheckpointOptions::options(OptionGroup& option) {
  option("interval", interval, "s", "simulated time between two checkpoints; 0: none", non_negative);
}

void RestartOptions::options(OptionGroup& option) {
  option("restart", file,
         "checkpoint that the run goes on from, on any number of ranks; where it lies in the output directory, the "
         "tables and series there are continued");
}

Checkpoint::Checkpoint(Options& options) { options.read("checkpoint", options_); }

bool Checkpoint::due(double time) {
  if (!wanted()) return false;
  const auto passed = static_cast<long long>(std::floor(time / options_.interval * (1 + 1e-12) + 1e-9));
  const bool is_due = passed > written_;
  written_ = passed;
  return is_due;
}

void Checkpoint::write(const std::string& path, const RunParts& parts, const RunClock& clock, const Costs& costs) {
  CheckpointWriter to;
  to.note("time", clock.time);
  to.note("dt", clock.dt);
  to.note("shortened", clock.shortened);
  to.note("step", static_cast<double>(clock.step));
  to.note("has_fluid", parts.fluid != nullptr);
  to.note("has_particles", parts.particles != nullptr);
  save_partition(parts.mesh, costs, to);
  if (parts.particles) parts.particles->save(to);
  if (parts.fluid) save_fields(parts.mesh, "fluid", parts.fluid->state(), to);
  if (parts.coupling) to.note("coupling_diameter", parts.coupling->largest_diameter());
  if (parts.coupling) to.note("coupling_last_step", parts.coupling->last_step());
  if (parts.coupling) save_fields(parts.mesh, "coupling", parts.coupling->state(), to);
  parts.profiles->save(to);
  parts.expectations->save(to, clock.time);
  const Budget::Opening& opening = parts.budget->opening();
  to.add("ledger_opening", 5,
         mpi_rank() == 0 ? std::vector<double>{opening.known ? 1.0 : 0.0, opening.momentum[0], opening.momentum[1],
                                               opening.momentum[2], opening.energy}
                         : std::vector<double>{});
  to.write(path);
}

std::unique_ptr<CheckpointReader> Checkpoint::open(Options& options) {
  RestartOptions restart;
  options.read("", restart);
  return restart.file.empty() ? nullptr : std::make_unique<CheckpointReader>(restart.file);
}

RunClock Checkpoint::load(const CheckpointReader& from, const RunParts& parts) {
  if ((from.number("has_fluid") != 0) != (parts.fluid != nullptr))
    from.refuse(parts.fluid ? "has no fluid, this case has one" : "has a fluid, this case has none");
  if (parts.particles) parts.particles->load_columns(from);
  if (parts.fluid) {
    load_fields(parts.mesh, "fluid", parts.fluid->state(), from);
    parts.fluid->restored();
  }
  if (parts.coupling) {
    load_fields(parts.mesh, "coupling", parts.coupling->state(), from);
    parts.coupling->restored(from.number("coupling_diameter"), from.number("coupling_last_step"));
  }
  parts.profiles->load(from);
  parts.expectations->load(from);
  const auto opening = from.numbers("ledger_opening");
  parts.budget->open_with({opening[0] != 0, {opening[1], opening[2], opening[3]}, opening[4]});
  return {from.number("time"), from.number("dt"), from.number("shortened"),
          static_cast<long long>(from.number("step"))};
}

}  // namespace silt
