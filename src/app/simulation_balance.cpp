// When the work of a run is shared out anew among the ranks, and how it goes on from there.
#include <algorithm>
#include <cmath>

#include "app/simulation.hpp"
#include "particles/particle_options.hpp"

namespace silt {

Costs Simulation::costs() const {
  const auto here = [this](Task task) { return seconds_[task] - seconds_before_[task]; };
  return Balance::measure(*mesh_, particles_.get(), here(moving_particles), here(solving_fluid) + here(exchanging));
}

/// Whether the work should be shared out anew; if so the state is written for the run that goes on from it.
bool Simulation::uneven() {
  const Costs measured = costs();
  const double imbalance = Balance::imbalance(*mesh_, particles_.get(), measured);
  if (!balance_->worthwhile(imbalance, reached_)) return false;
  hand_on(imbalance, measured);
  return true;
}

/// The mesh was shared out before there were particles.
bool Simulation::uneven_at_start() {
  ParticleOptions options;
  options_.read("particles", options);
  if (!particles_ || particles_->total() == 0 || options_.given("mesh_weight")) return false;
  const double substeps = options.fixed ? 1 : std::ceil(time_options_.step / particles_->time_step());
  const bool solved = fluid_ && options_.find("fluid_type").value_or("") != "prescribed";
  const bool at_once = options_.find("fluid_type").value_or("") == "compressible" ||
                       options_.find("fluid_scheme").value_or("") == "monolithic";
  const double unknowns =
      solved ? static_cast<double>(fluid_->unknowns()) / static_cast<double>(mesh_->total_cells) : 0;
  const Costs expected = Balance::estimate(substeps, unknowns, at_once);
  const double imbalance = Balance::imbalance(*mesh_, particles_.get(), expected);
  if (!balance_->worthwhile_at_start(imbalance, particles_.get())) return false;
  hand_on(imbalance, expected);
  return true;
}

/// Writes the state, and gives what has been seen so far to the run that goes on from it.
void Simulation::hand_on(double imbalance, const Costs& costs) {
  write_checkpoint("balance.h5", costs);
  carried_ = std::make_unique<Carried>();
  carried_->file = output_->directory().path("balance.h5");
  carried_->reached = imbalance;
  carried_->expectations = std::move(expectations_);
  carried_->profiles = std::move(profiles_);
  std::copy(seconds_.begin(), seconds_.end(), carried_->seconds.begin());
}

}  // namespace silt
