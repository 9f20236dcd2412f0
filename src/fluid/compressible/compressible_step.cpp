// A step of compressible flow: turbulence, then the flow, and what is done when it cannot be found.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "fluid/compressible/compressible.hpp"

namespace silt {

Turbulence::Flow Compressible::turbulent_flow() const {
  return {velocity_, density_field_, viscosity_field_, load_.void_fraction, {}, true, 0, sound_, options_.heat_ratio};
}

int Compressible::solve_turbulence(double time, double dt) {
  const int iterations = turbulence_->solve(time, difference(dt, order_), dt, turbulent_flow());
  turbulence_->accept();
  take_eddy_viscosity();
  return iterations;
}

void Compressible::take_eddy_viscosity() {
  const size_t corners = mesh_.nodes_per_cell;
  std::vector<double> viscosity(mesh_.cells, 0.0);
  for (size_t c = 0; c < viscosity.size(); ++c)
    for (size_t a = 0; a < corners; ++a)
      viscosity[c] += viscosity_field_[mesh_.cell_nodes[corners * c + a]] / static_cast<double>(corners);
  step_.eddy_viscosity = turbulence_->cell_eddy_viscosity();
  step_.eddy_conductivity = turbulence_->cell_eddy_conductivity(heat_capacity_, options_.prandtl, viscosity);
  for (double& mu : step_.eddy_viscosity) mu *= u0_ / p0_;
  for (double& lambda : step_.eddy_conductivity) lambda *= u0_ / p0_ / options_.gas_constant;
}

/// Towards a steady state the capturing viscosity is the mean of what the state asks for and what the last step had.
/// The viscosity a shock asks for answers every change of the shock with one beyond it: at large steps the two would go
/// back and forth for ever.
void Compressible::relax_capturing() {
  if (mpi_max(past_.empty() ? 0.0 : past_[0]) == 0) return;
  GasFrozen& now = step_.frozen;
  for (size_t c = 0; c < now.viscosity.size(); ++c) now.viscosity[c] = 0.5 * (now.viscosity[c] + last_capturing_[c]);
  for (size_t c = 0; c < now.normal.size(); ++c) now.normal[c] = 0.5 * (now.normal[c] + last_normal_[c]);
}

/// The flow of a step. One that Newton's method cannot find (impulsive starts, sudden changes outside) is found by a
/// scheme of first order; in time it is then found once more from there, with the viscosity that its own residual asks
/// for.
GasNewton::Result Compressible::solve_flow(double time, double dt, const std::vector<double>& before) {
  const bool steady = options_.march == "steady";
  // In time a step that has hardly converged would not keep its balances.
  const double accepted = steady ? 0.1 : 1e-3;
  rescued_ = false;
  prepare(time, dt, order_);
  if (steady) std::fill(rate_.begin(), rate_.end(), 0.0);
  system_.freeze(step_, state_, rate_);
  if (steady) relax_capturing();
  system_.to_vector(state_, unknown_);
  try {
    return newton_.solve(step_, unknown_, norm_scale(), accepted);
  } catch (const SolveFailure&) {
  }
  state_ = before;
  prepare(time, dt, 1);
  system_.freeze(step_, state_, rate_);
  const std::vector<double> guess = state_;
  GasNewton::Result result;
  // What enters may be faster than what is there, by which the viscosity goes.
  for (const double factor : {1.0, 4.0}) {
    step_.frozen.make_first_order(factor);
    system_.to_vector(guess, unknown_);
    result.newton += GasNewton::most_iterations;
    try {
      const GasNewton::Result found = newton_.solve(step_, unknown_, norm_scale(), accepted);
      result.newton += found.newton, result.linear += found.linear;
      break;
    } catch (const SolveFailure&) {
      if (factor > 1) throw;
    }
  }
  rescued_ = true;
  if (steady) return result;
  std::vector<double> found, rate;
  SILT_PETSC(system_.from_vector(unknown_, found));
  rate = system_.conserved(step_, found);
  for (size_t k = 0; k < rate.size(); ++k) rate[k] = step_.rate * rate[k] + step_.known[k];
  system_.freeze(step_, found, rate);
  try {
    const GasNewton::Result sharp = newton_.solve(step_, unknown_, norm_scale(), accepted);
    result.newton += sharp.newton, result.linear += sharp.linear;
  } catch (const SolveFailure&) {
    system_.to_vector(found, unknown_);
  }
  return result;
}

FluidStep Compressible::advance(double time, double dt) {
  const std::vector<double> before = state_;
  const size_t n = mesh_.nodes, m = system_.size();
  Turbulence::Snapshot turbulence_before;
  if (turbulence_) turbulence_before = turbulence_->snapshot();
  GasNewton::Result result;
  int turbulence_iterations = 0;
  try {
    if (turbulence_) turbulence_iterations = solve_turbulence(time, dt);
    result = solve_flow(time, dt, before);
    SILT_PETSC(system_.from_vector(unknown_, state_));
    bool bad = false;
    for (size_t i = 0; i < n; ++i) bad = bad || !(state_[i * m] > 0) || !(state_[i * m + m - 1] > 0);
    if (mpi_any(bad)) throw SolveFailure("pressure or temperature of the gas fell to zero");
  } catch (const SolveFailure&) {
    state_ = before;
    if (turbulence_) {
      turbulence_->restore(turbulence_before);
      take_eddy_viscosity();
    }
    throw;
  }
  last_newton_ = result.newton;
  last_capturing_ = step_.frozen.viscosity;
  last_normal_ = step_.frozen.normal;
  old_conserved_ = std::move(conserved_);
  conserved_ = system_.conserved(step_, state_);
  for (size_t k = 0; k < n * m; ++k) rate_[k] = step_.rate * conserved_[k] + step_.known[k];
  for (size_t i = 0; i < n; ++i) {
    past_[2 * i] = std::min(past_[2 * i] + 1, 3.0);
    past_[2 * i + 1] = dt;
    for (size_t k = 0; k + 2 < m; ++k)
      velocity_change_[3 * i + k] = (state_[i * m + 1 + k] - before[i * m + 1 + k]) * u0_;
    temperature_change_[i] = (state_[i * m + m - 1] - before[i * m + m - 1]) * T0_;
  }
  from_state();
  FluidStep step = report();
  step.courant = courant_rate() * dt;
  step.newton_iterations = result.newton;
  step.turbulence_iterations = turbulence_iterations;
  step.first_order = rescued_;
  step.velocity_iterations = step.pressure_iterations = result.linear;
  return step;
}

}  // namespace silt
