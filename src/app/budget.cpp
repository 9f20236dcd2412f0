#include "app/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace silt {
namespace {

void add_columns(std::vector<std::string>& columns, std::initializer_list<const char*> vectors) {
  for (const char* name : vectors)
    for (char axis : {'x', 'y', 'z'}) columns.push_back(fmt::format("{}_{}", name, axis));
}

/// The largest of some numbers >= 0, or NaN when one of them is NaN: std::max would lose it.
double largest(std::initializer_list<double> values) {
  double result = 0;
  for (double value : values)
    if (!(value <= result) && !std::isnan(result)) result = value;
  return result;
}

void add(std::vector<double>& row, const Vec3& v) { row.insert(row.end(), {v[0], v[1], v[2]}); }

}  // namespace

void LedgerOptions::options(OptionGroup& option) {
  option("tolerance", tolerance, "-", "relative residual of the conservation ledger above which the run stops",
         positive);
  option("mass_tolerance", mass_tolerance, "-",
         "imbalance of the fluid's volume in a step, as a share of what comes in, above which the run stops; the "
         "solvers' tolerances keep it far below",
         positive);
}

Budget::Budget(Options& options, bool with_fluid, bool with_particles)
    : with_fluid_(with_fluid), with_particles_(with_particles) {
  options.read("ledger", options_);
}

void Budget::start(const OutputDirectory& directory, const Fluid* fluid, Particles* particles) {
  std::vector<std::string> columns = {"time",           "residual",     "exchange_residual", "particle_residual",
                                      "taken_residual", "mass_residual"};
  if (with_fluid_) add_columns(columns, {"fluid_momentum", "boundary_impulse", "unaccounted"});
  with_energy_ = fluid != nullptr && fluid->total_energy();
  if (with_energy_)
    columns.insert(columns.end(), {"fluid_energy", "energy_supply", "energy_from_particles", "unaccounted_energy",
                                   "energy_in_transit", "particle_energy"});
  if (with_particles_) {
    add_columns(columns, {"particle_momentum", "gravity", "walls", "drag", "fluid_force", "kicks", "added", "removed",
                          "fields"});
    columns.insert(columns.end(), {"particle_mass", "added_mass", "removed_mass"});
  }
  if (with_fluid_ && with_particles_) {
    add_columns(columns, {"drag_on_fluid", "response_on_fluid", "pressure_on_fluid", "in_transit"});
    columns.insert(columns.end(), {"particle_volume", "deposited_volume"});
  }
  table_ = directory.table("ledger.csv", columns);
  if (particles) {
    const Particles::Totals now = particles->totals();
    particle_momentum_ = now.momentum;
    particle_mass_ = now.mass;
    particles->take_impulses();
  }
}

/// J, what the particles gave a gas in the step.
double Budget::energy_from(const ExchangeAccounts& exchanged) {
  double sum = 0;
  if (const WorkLedger* work = exchanged.work) sum += work->given - work->response + work->displaced + work->inserted;
  if (const HeatLedger* heat = exchanged.heat) sum += heat->given + heat->response_on_fluid;
  return sum;
}

double Budget::close(const Moment& moment, Particles* particles, const ExchangeAccounts& exchanged) {
  const ExchangeLedger* exchange = exchanged.momentum;
  const double exchange_residual = exchange ? exchange->residual : 0;
  double particle_residual = 0, taken_residual = 0;
  Particles::Impulses in;
  Particles::Totals now;
  if (particles) {
    in = particles->take_impulses();
    now = particles->totals();
    const Vec3 sum = in.gravity + in.walls + in.drag + in.fluid_force + in.kicks + in.added + in.removed + in.fields;
    double scale = std::sqrt(2 * now.mass * now.kinetic) + in.exchanged;
    for (const Vec3* v :
         {&in.gravity, &in.walls, &in.drag, &in.fluid_force, &in.kicks, &in.added, &in.removed, &in.fields})
      scale += v->norm();
    scale = std::max(scale, 1e-300);
    particle_residual = (now.momentum - particle_momentum_ - sum).norm() / scale;
    const double moved = std::max({now.mass, particle_mass_, 1e-300});
    particle_residual =
        largest({particle_residual, std::abs(now.mass - particle_mass_ - in.added_mass + in.removed_mass) / moved});
    // A particle that left during the step took with it what it was owed: that is in its removal.
    if (exchange && in.removed.norm() == 0)
      taken_residual =
          largest(
              {(in.drag - exchange->drag_on_particles).norm(), (in.kicks - exchange->given_at_once).norm(),
               (in.fluid_force - exchange->delivered - exchange->buoyancy - exchange->forces_on_particles).norm()}) /
          scale;
  }
  const double residual = largest({exchange_residual, particle_residual, taken_residual});
  std::vector<double> row = {moment.time,       residual,       exchange_residual,
                             particle_residual, taken_residual, with_fluid_ ? moment.fluid_step.mass_residual : 0};
  if (with_fluid_) {
    const Vec3 through = moment.dt * moment.fluid_step.boundary_force;
    Vec3 unaccounted = Vec3::Zero();
    if (fluid_.known) {
      unaccounted = moment.fluid_step.momentum + moment.fluid_step.lent - fluid_.momentum - through;
      if (exchange) unaccounted -= exchange->drag_on_fluid + exchange->response_on_fluid + exchange->pressure_on_fluid;
    }
    add(row, moment.fluid_step.momentum);
    add(row, through);
    add(row, unaccounted);
    if (with_energy_) {
      const double energy = moment.fluid_step.heat, supply = moment.dt * moment.fluid_step.energy_supply;
      const double from = energy_from(exchanged), left = fluid_.known ? energy - fluid_.energy - supply - from : 0;
      row.insert(row.end(), {energy, supply, from, left, exchanged.work ? exchanged.work->in_transit : 0,
                             now.kinetic + now.rotational});
      fluid_.energy = energy;
    }
    fluid_.momentum = moment.fluid_step.momentum + moment.fluid_step.lent;
    fluid_.known = true;
  }
  if (with_particles_) {
    for (const Vec3& v :
         {now.momentum, in.gravity, in.walls, in.drag, in.fluid_force, in.kicks, in.added, in.removed, in.fields})
      add(row, v);
    row.insert(row.end(), {now.mass, in.added_mass, in.removed_mass});
  }
  if (with_fluid_ && with_particles_) {
    const ExchangeLedger none, &e = exchange ? *exchange : none;
    for (const Vec3& v : {e.drag_on_fluid, e.response_on_fluid, e.pressure_on_fluid, e.in_transit}) add(row, v);
    row.insert(row.end(), {e.particle_volume, e.deposited_volume});
  }
  particle_momentum_ = now.momentum;
  particle_mass_ = now.mass;
  table_.row(row);
  if (!(residual <= options_.tolerance))
    throw RunError(
        fmt::format("the ledger is out of balance at t = {:g} s: residual {:.3g} (exchange {:.3g}, particles "
                    "{:.3g}, taken {:.3g}), allowed {:g} (-ledger_tolerance)",
                    moment.time, residual, exchange_residual, particle_residual, taken_residual, options_.tolerance));
  if (with_fluid_ && !(std::abs(moment.fluid_step.mass_residual) <= options_.mass_tolerance))
    throw RunError(
        fmt::format("the fluid's volume is out of balance at t = {:g} s: {:.3g} of what comes in, allowed {:g} "
                    "(-ledger_mass_tolerance)",
                    moment.time, moment.fluid_step.mass_residual, options_.mass_tolerance));
  return residual;
}

}  // namespace silt
