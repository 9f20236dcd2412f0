#include "app/simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/catalogue.hpp"
#include "base/error.hpp"
#include "base/expression.hpp"
#include "fluid/boundary/boundary_conditions.hpp"
#include "particles/insertion/insertion_options.hpp"
#include "particles/potential.hpp"
#include "particles/walls/wall_boundary.hpp"

namespace silt {
namespace {

/// A formula that gives no number spoils what it is used for, on some ranks or in silence: no heat, no wall.
template <class Error>
void refuse_bad_formulas() {
  if (const std::string formula = Expression::check(); !formula.empty()) throw Error(formula);
}

/// Throws UserError for a condition on a boundary that the mesh has not (the sides of a periodic direction are none).
void refuse_unknown_boundaries(const Mesh& mesh, const Options& options) {
  auto properties = Options::declared<BoundaryOptions>();
  for (const auto& property : Options::declared<WallBoundaryOptions>()) properties.push_back(property);
  for (const auto& property : Options::declared<PotentialBoundaryOptions>()) properties.push_back(property);
  for (const auto& name : options.names("boundary", properties)) {
    if (std::find(mesh.boundaries.begin(), mesh.boundaries.end(), name) != mesh.boundaries.end()) continue;
    const std::string hint = nearest(name, mesh.boundaries);
    throw UserError(fmt::format("-boundary_{}_...: the mesh has no boundary {}{}; there are {}", name, name,
                                hint.empty() ? "" : fmt::format(" (did you mean {}?)", hint),
                                fmt::join(mesh.boundaries, ", ")));
  }
}

}  // namespace

void CaseOptions::options(OptionGroup& option) {
  option("title", title, "what the run is called in its output");
  option("gravity", gravity, "m/s2", "acceleration of gravity");
}

void TimeOptions::options(OptionGroup& option) {
  option("end", end, "s", "end of the run", non_negative);
  option("step", step, "s", "fluid step; with -time_courant the longest one", positive);
  option("courant", courant, "-", "target of the largest |u| dt/h, which the step follows; 0: constant step",
         non_negative);
  option("least_step", least_step, "s",
         "a step that fails is repeated shorter; where it would have to be shorter than this the run stops; 0: a "
         "thousandth of "
         "-time_step",
         non_negative);
}

/// Adds the wall time of its scope to a task.
class Simulation::Stopwatch {
 public:
  Stopwatch(Simulation& simulation, Task task) : seconds_(simulation.seconds_[task]) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Simulation::Simulation(Options& options, std::unique_ptr<Carried> carried)
    : options_(options), carried_(std::move(carried)) {
  options.read("", case_);
  options.read("time", time_options_);
  const MeshOptions mesh(options);
  checkpoint_ = std::make_unique<Checkpoint>(options);
  balance_ = std::make_unique<Balance>(options);
  restart_ = Checkpoint::open(options);
  if (carried_) restart_ = std::make_unique<CheckpointReader>(carried_->file);
  mesh_ = std::make_unique<Mesh>(mesh, restart_ ? partition_of(*restart_, carried_ != nullptr) : Partition{});
  refuse_unknown_boundaries(*mesh_, options);
  fluid_ = Fluid::create(*mesh_, options, case_.gravity);
  // The films between near particles are of the fluid that carries them.
  if (fluid_ && options.find("lubrication_type") && !options.find("lubrication_viscosity"))
    options.set("lubrication_viscosity", fmt::format("{}", fluid_->viscosity()), "-fluid_viscosity");
  particles_ = Particles::create(*mesh_, options, case_.gravity, restart_ != nullptr);
  if (!fluid_ && !particles_)
    throw UserError("there is neither a fluid (-fluid_type) nor a particle (-insertion_<name>_...) to run");
  if (restart_) {
    if ((restart_->number("has_particles") != 0) != (particles_ != nullptr))
      restart_->refuse(particles_ ? "has no particles, this case has some" : "has particles, this case has none");
    if (particles_) particles_->load(*restart_, carried_ != nullptr);
  }
  if (fluid_ && particles_ && fluid_->total_energy() && options.find("fluid_symmetry").value_or("") == "axisymmetric")
    throw UserError(
        "-fluid_symmetry axisymmetric carries no particles, which move in space: give a mesh in space (or no "
        "-insertion_...)");
  if (fluid_ && particles_ && options.given("fluid_void_fraction") &&
      options.find("fluid_type").value_or("incompressible") == "incompressible")
    throw UserError("-fluid_void_fraction excludes particles, which make the void fraction (-insertion_...)");
  if (fluid_ && particles_)
    coupling_ = std::make_unique<Coupling>(*mesh_, *particles_, *fluid_, options, case_.gravity);
  if (!coupling_ && options.given("brownian_temperature"))
    throw UserError("-brownian_temperature needs a fluid whose drag goes with the noise (-fluid_type)");
  const bool flow = fluid_ != nullptr, grains = particles_ != nullptr;
  output_ = std::make_unique<Output>(*mesh_, options, flow, grains, restart_ ? restart_->path() : "");
  diagnostics_ = std::make_unique<Diagnostics>(*mesh_, options, case_.gravity, fluid_.get(), particles_.get());
  exact_ = std::make_unique<ExactSolution>(*mesh_, options, fluid_.get());
  probes_ = std::make_unique<Probes>(*mesh_, options, fluid_.get());
  profiles_ = std::make_unique<Profiles>(*mesh_, options, grains);
  budget_ = std::make_unique<Budget>(options, flow, grains);
  walls_ = std::make_unique<WallTable>(particles_.get());
  energy_ = std::make_unique<EnergyTable>(particles_.get());
  auto through_time = diagnostics_->columns(), along_lines = probes_->line_columns();
  for (const auto& column : exact_->columns()) through_time.push_back(column);
  for (const auto& column : walls_->columns()) through_time.push_back(column);
  for (const auto& column : energy_->quantities()) through_time.push_back(column);
  for (const auto& column : probes_->columns()) through_time.push_back(column);
  for (const auto& column : profiles_->columns()) along_lines.push_back(column);
  std::vector<std::string> asked;
  for (const auto& name : options.names("expect", Options::declared<ExpectationOptions>()))
    for (const char* which : {"_quantity", "_less"})
      if (const auto quantity = options.find("expect_" + name + which)) asked.push_back(*quantity);
  tracked_ = std::make_unique<TrackedParticles>(grains ? asked : std::vector<std::string>{});
  for (const auto& name : tracked_->names()) through_time.push_back(name);
  statistics_ = std::make_unique<ParticleStatistics>(asked, particles_.get());
  for (const auto& name : statistics_->names()) through_time.push_back(name);
  expectations_ = std::make_unique<Expectations>(options, through_time, along_lines);
  refuse_bad_formulas<UserError>();
  progress_ = std::make_unique<Progress>(options);
  if (time_options_.least_step == 0) time_options_.least_step = 1e-3 * time_options_.step;
  options.refuse_unknown(&catalogue());
  now_.fluid = fluid_.get();
  now_.particles = particles_.get();
  if (!restart_) return;
  const RunClock clock = Checkpoint::load(*restart_, run_parts());
  now_.time = clock.time, now_.dt = clock.dt, now_.step = clock.step;
  shortened_ = clock.shortened;
  if (ended())
    restart_->refuse(
        fmt::format("is of t = {:g} s: nothing is left to run until -time_end {:g}", now_.time, time_options_.end));
}

std::string Simulation::description() const {
  std::vector<std::string> lines;
  lines.push_back(case_.title);
  lines.push_back(fmt::format("mesh       {} cells ({}), {} nodes, {} rank{}", mesh_->total_cells, name(mesh_->cell),
                              mesh_->total_nodes, mpi_size(), mpi_size() > 1 ? "s" : ""));
  if (fluid_)
    lines.push_back(fmt::format("fluid      {}; {} fluid unknowns", fluid_->description(), fluid_->unknowns()));
  if (particles_ && particles_->total() == 0)
    lines.push_back("particles  none yet; their step is found when the first one comes");
  else if (particles_)
    lines.push_back(fmt::format("particles  {}; step {:.3g} s ({})", particles_->total(), particles_->time_step(),
                                particles_->time_step_reason()));
  if (particles_) {
    for (const auto& notice : particles_->notices()) lines.push_back("laws       " + notice);
    for (const auto& warning : particles_->warnings()) lines.push_back("warning    " + warning);
  }
  if (coupling_) lines.push_back(fmt::format("coupling   {}", coupling_->description()));
  lines.push_back(
      fmt::format("time       to {:g} s, step {:g} s{}; output {}", time_options_.end, time_options_.step,
                  time_options_.courant > 0 ? fmt::format(", Courant number {:g}", time_options_.courant) : "",
                  output_->directory().options().directory));
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

int Simulation::check() {
  // The first forces tell whether particles overlap at the start.
  if (particles_ && !restart_) particles_->advance(now_.time, 1e-6 * particles_->time_step());
  progress_->header(description());
  progress_->line("the case is valid; nothing was run or written");
  return 0;
}

int Simulation::run() {
  const bool fresh = !restart_;
  start();
  if (fresh && !ended() && uneven_at_start()) return share_out_anew;
  while (!ended()) {
    choose_step();
    try {
      step();
      report();
      refuse_bad_formulas<RunError>();
    } catch (const RunError& error) {
      const std::string formula = Expression::check();  // what may have come of one
      throw RunError(error.what() + (formula.empty() ? formula : "; " + formula) + save_last_good());
    }
    if (checkpoint_->due(now_.time)) write_checkpoint("checkpoint.h5", costs());
    if (balance_->due(now_.time) && !ended() && uneven()) return share_out_anew;
  }
  finish();
  return expectations_->judge(output_->directory(), *probes_, *profiles_) ? 0 : 1;
}

void Simulation::start() {
  restart_ ? output_->resume(record_of(options_), now_.time) : output_->start(record_of(options_));
  if (carried_) {
    reached_ = Balance::imbalance(*mesh_, particles_.get(),
                                  {restart_->number("cost_particle"), restart_->number("cost_cell")});
    progress_->line(
        fmt::format("t = {:g} s: the work is shared out anew, the busiest rank had {:.3g} of the mean, now {:.3g}",
                    now_.time, carried_->reached, reached_));
    expectations_->inherit(*carried_->expectations);
    profiles_->inherit(*carried_->profiles);
    seconds_before_ = carried_->seconds;
    for (int k = 0; k < tasks; ++k) seconds_[k] += seconds_before_[k];
    if (mpi_rank() == 0) std::filesystem::remove(carried_->file);
    carried_.reset();
  } else {
    progress_->header(description());
  }
  if (particles_ && !restart_) particles_->settle();
  if (coupling_ && !restart_) coupling_->start();
  checkpoint_->start(now_.time);
  balance_->start(now_.time);
  diagnostics_->start(output_->directory());
  exact_->start(output_->directory());
  probes_->start(output_->directory());
  budget_->start(output_->directory(), fluid_.get(), particles_.get());
  if (particles_) departures_.start(output_->directory());
  walls_->start(output_->directory());
  energy_->start(output_->directory());
  progress_->start(now_.time, time_options_.end);
  if (!restart_) report();
  refuse_bad_formulas<RunError>();
  restart_.reset();
}

/// The step asked for, shortened by the Courant target and a failed solve, so that output times and the end are met.
void Simulation::choose_step() {
  double longest = time_options_.step;
  if (shortened_ > 0) {
    longest = std::min(longest, shortened_);
    shortened_ *= 1.3;
    if (shortened_ > time_options_.step) shortened_ = 0;
  }
  if (fluid_ && time_options_.courant > 0) {
    const double rate = fluid_->courant_rate();
    if (rate > 0) longest = std::min(longest, time_options_.courant / rate);
    if (now_.step > 0) longest = std::min(longest, 1.2 * now_.dt);
  }
  if (fluid_) longest = std::min(longest, fluid_->longest_step(now_.step > 0 ? now_.dt : 0));
  const double left = std::min(output_->next(now_.time), time_options_.end) - now_.time;
  // Equal steps up to the target leave no sliver at its end.
  dt_ = left / std::max(1.0, std::ceil(left / longest * (1 - 1e-9)));
}

/// Remembers the state before a step. Without a fluid, which may ask to go back, not before every short one.
void Simulation::keep_state() {
  constexpr int worth_a_copy = 200;
  if (particles_ && !fluid_ && good_.particles && substeps_since_good_ < worth_a_copy) return;
  good_.particles.reset();  // first the room, then the copy
  if (particles_) good_.particles = particles_->snapshot(fluid_ != nullptr);
  if (fluid_) good_.flow = fluid_->kept();
  if (coupling_) {
    good_.exchange.clear();
    for (const auto& array : coupling_->state()) good_.exchange.push_back(*array.values);
    good_.largest_diameter = coupling_->largest_diameter();
    good_.last_step = coupling_->last_step();
  }
  good_.profiles = *profiles_;
  good_.opening = budget_->opening();
  good_.clock = {now_.time, now_.dt, shortened_, now_.step};
  substeps_since_good_ = 0;
}

/// Takes one step; when the fluid cannot, both phases go back to its start and a shorter one is tried.
void Simulation::step() {
  keep_state();
  for (;;) {
    try {
      attempt();
      refuse_bad_formulas<RunError>();
      substeps_since_good_ += now_.particle_step.substeps;
      return;
    } catch (const SolveFailure& failure) {
      refuse_bad_formulas<RunError>();
      dt_ *= 0.5;
      shortened_ = dt_;
      if (dt_ < time_options_.least_step)
        throw RunError(fmt::format("the step at t = {:g} s failed down to {:g} s (-time_least_step): {}", now_.time,
                                   2 * dt_, failure.what()));
      progress_->line(fmt::format("t = {:g} s: {}; trying a step of {:g} s", now_.time, failure.what(), dt_));
      if (particles_) particles_->restore(*good_.particles);
    }
  }
}

std::string Simulation::save_last_good() {
  try {
    if (particles_) particles_->restore(*good_.particles);
    if (fluid_) fluid_->go_back(good_.flow);
    if (coupling_) {
      const auto arrays = coupling_->state();
      for (std::size_t k = 0; k < arrays.size(); ++k) *arrays[k].values = good_.exchange[k];
      coupling_->restored(good_.largest_diameter, good_.last_step);
    }
    now_.time = good_.clock.time, now_.dt = good_.clock.dt, now_.step = good_.clock.step;
    shortened_ = good_.clock.shortened;
    *profiles_ = *good_.profiles;
    budget_->open_with(good_.opening);
    if (now_.time > output_->last()) output_->write(now_);
    write_checkpoint("last_good.h5", costs());
  } catch (const RunError& error) {
    return fmt::format("; the last good state could not be written: {}", error.what());
  }
  return fmt::format("; the last good state, t = {:.6g} s, is in {} (-restart)", now_.time,
                     output_->directory().path("last_good.h5"));
}

RunParts Simulation::run_parts() const {
  return {*mesh_, fluid_.get(), particles_.get(), coupling_.get(), profiles_.get(), expectations_.get(), budget_.get()};
}

void Simulation::write_checkpoint(const std::string& file, const Costs& costs) {
  const Stopwatch watch(*this, writing);
  Checkpoint::write(output_->directory().path(file), run_parts(), {now_.time, now_.dt, shortened_, now_.step}, costs);
}

/// Particles first, with the flow of the step's start; then the flow, with what they did to it; then the account is
/// settled.
void Simulation::attempt() {
  if (particles_) {
    const Stopwatch watch(*this, moving_particles);
    particles_->supply(now_.time, dt_);
  }
  if (coupling_) {
    const Stopwatch watch(*this, exchanging);
    coupling_->before_particles(dt_);
  }
  if (particles_) {
    const Stopwatch watch(*this, moving_particles);
    now_.particle_step = particles_->advance(now_.time, dt_);
  }
  if (coupling_) {
    const Stopwatch watch(*this, exchanging);
    coupling_->before_fluid(dt_);
  }
  if (fluid_) {
    const Stopwatch watch(*this, solving_fluid);
    now_.fluid_step = fluid_->advance(now_.time, dt_);
  }
  if (coupling_) {
    const Stopwatch watch(*this, exchanging);
    coupling_->after_fluid(dt_);
  }
  now_.time += dt_;
  now_.dt = dt_;
  ++now_.step;
}

void Simulation::report() {
  const Stopwatch watch(*this, writing);
  if (now_.step > 0)
    now_.ledger_residual =
        budget_->close(now_, particles_.get(), coupling_ ? coupling_->accounts() : ExchangeAccounts{});
  Quantities quantities;
  diagnostics_->sample(now_, quantities);
  exact_->sample(now_, quantities);
  probes_->sample(now_, quantities);
  profiles_->sample(now_);
  departures_.record(now_);
  walls_->sample(now_, quantities);
  energy_->sample(now_, quantities);
  tracked_->sample(now_, quantities);
  statistics_->sample(now_, quantities);
  expectations_->sample(now_.time, quantities);
  if (output_->due(now_.time) || ended()) {
    output_->write(now_);
    probes_->write_lines(now_);
    profiles_->write(output_->directory());
  }
  if (coupling_)
    if (const std::string warning = coupling_->take_warning(); !warning.empty()) progress_->line(warning);
  progress_->step(now_);
}

void Simulation::finish() {
  if (checkpoint_->wanted()) write_checkpoint("checkpoint.h5", costs());
  progress_->finish(now_);
  if (particles_ && particles_->total() >= 1000)  // fewer have less than what arrays take at least
    progress_->line(fmt::format("memory     particles {}", particles_->memory(good_.particles.get())));
  double total = 0;
  for (double s : seconds_) total += s;
  progress_->line(fmt::format(
      "timing loop {:.3f} s: particles {:.3f}, fluid {:.3f}, coupling {:.3f}, output {:.3f}; {} steps", total,
      seconds_[moving_particles], seconds_[solving_fluid], seconds_[exchanging], seconds_[writing], now_.step));
}

}  // namespace silt
