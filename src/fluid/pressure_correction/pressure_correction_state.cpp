// What the pressure correction keeps between steps, and what it tells of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "fluid/assembly/flow_table.hpp"
#include "fluid/initial_projection.hpp"
#include "fluid/initial_state.hpp"
#include "fluid/monolithic.hpp"
#include "fluid/pressure_correction/pressure_correction.hpp"

namespace silt {

void PressureCorrection::start_from(Options& options) {
  boundaries_.evaluate(0, load_.void_fraction.data());
  InitialState start = initial_state(mesh_, options, boundaries_, mesh_.node_coordinates, energy_ != nullptr);
  if (start.stokes) {
    const Monolithic slow(mesh_, options, fluid_, gravity_);
    start.velocity.assign(slow.velocity().begin(), slow.velocity().end());
    start.pressure.assign(slow.pressure().begin(), slow.pressure().end());
  }
  if (!start.velocity.empty()) velocity_ = start.velocity;
  if (!start.pressure.empty()) {
    pressure_ = start.pressure;
    initial_pressure_given_ = true;
  }
  if (!start.temperature.empty()) energy_->set_initial(start.temperature);
}

void PressureCorrection::meet_continuity(std::span<const double> solids_flux) {
  boundaries_.evaluate(0, load_.void_fraction.data());
  boundaries_.impose(velocity_.data());
  project_onto_continuity(mesh_, boundaries_, load_.void_fraction, solids_flux, velocity_);
  old_velocity_ = carrying_ = velocity_;
}

PressureCorrection::Past PressureCorrection::past() const {
  double values[4] = {};
  if (mesh_.nodes > 0) std::copy(past_.begin(), past_.begin() + 4, values);
  MPI_Allreduce(MPI_IN_PLACE, values, 4, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);  // a rank may have no nodes
  return {static_cast<int>(values[0]), values[1], values[2], values[3]};
}

void PressureCorrection::set_static_pressure(const Past& before) {
  set_momentum_terms();
  if (!porous_ && !has_body_force_) return;
  set_cell_forces(has_body_force_ ? body_force_.data() : nullptr);
  for (std::size_t k = 0; porous_ && k < loops_.padded_cells(); ++k)  // nothing was lent yet that would come back
    for (double* balance : cell_.balance)
      balance[k] *= cell_.pressure_share[k] / (cell_.pressure_share[k] + cell_.following[k]);
  assemble_pressure(before);
  const std::vector<double> coefficient = pressure_coefficient();
  std::vector<double> sums(3 * mesh_.nodes, 0.0), right(mesh_.nodes);
  const std::vector<double> zero(3 * mesh_.nodes, 0.0);
  loops_.continuity({zero.data(),
                     zero.data(),
                     zero.data(),
                     coefficient.data(),
                     {cell_.balance[0], cell_.balance[1], cell_.balance[2]}},
                    sums.data());
  mesh_.sum_shared(sums.data(), 2);
  for (int i = 0; i < mesh_.nodes; ++i) {
    right[i] = sums[2 * i];
    pressure_[i] = boundaries_.pressure()[i];
  }
  pressure_solver_.solve(right, pressure_);
}

void PressureCorrection::set_pressure_gradient() {
  std::fill(pressure_gradient_.begin(), pressure_gradient_.end(), 0.0);
  loops_.mean_gradient(pressure_.data(), nullptr, pressure_gradient_.data());
  mesh_.sum_shared(pressure_gradient_.data(), 3);
  for (std::size_t i = 0; i < pressure_gradient_.size(); ++i) pressure_gradient_[i] /= mass_[i / 3];
}

void PressureCorrection::accept(const Past& before, double dt, std::vector<double>& phi,
                                const std::vector<double>& divergence) {
  const int n = mesh_.nodes;
  const auto& outlet = boundaries_.pressure_boundary();
  velocity_change_ = carrying_;
  set_carrying_velocity(phi);
  for (int i = 0; i < 3 * n; ++i) velocity_change_[i] = carrying_[i] - velocity_change_[i];
  for (int i = 0; i < n; ++i) lent_pressure_[i] = pressure_[i] + phi[i];
  std::swap(old_following_, following_);
  following_ = load_.following;
  std::swap(old_increment_, increment_);
  std::swap(increment_, phi);
  for (int i = 0; i < n; ++i) {
    const double rotation = scheme_.rotational ? viscosity_ * divergence[i] : 0;
    // What the correction leaves of the viscous force, alpha mu grad div u, as a pressure: (P + s) p, div u being that
    // of alpha + s of the volume.
    const double alpha = load_.void_fraction[i], follows = load_.following[i];
    const double share = (model_a_ ? alpha + follows : 1.0) * (alpha + follows) / alpha;
    pressure_[i] = outlet[i] >= 0 ? boundaries_.pressure()[i] : pressure_[i] + increment_[i] - rotation / share;
  }
  set_pressure_gradient();
  if (drive_) accept_drive();
  std::swap(old_velocity_, velocity_);
  velocity_ = solution_;
  std::swap(old_void_fraction_, void_fraction_);
  void_fraction_ = load_.void_fraction;
  std::swap(old_drag_, drag_);
  drag_ = drag_now_;
  for (int i = 0; i < n; ++i) {
    past_[4 * i] = std::min(before.steps + 1, starting_steps);
    past_[4 * i + 1] = dt, past_[4 * i + 2] = bdf_.c0, past_[4 * i + 3] = before.rate;
  }
  renew_ = false;
}

std::vector<double> PressureCorrection::superficial_velocity(const std::vector<double>& phi) const {
  const FlowTable& table = flow_table(mesh_.cell, 1);
  const std::size_t nv = mesh_.nodes_per_cell, points = table.points;
  const bool balance = porous_ || has_weight_;
  std::vector<double> result(3 * points * mesh_.cells);
  const std::vector<double> coefficient = pressure_coefficient();
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * nv * c];
    const int* node = &mesh_.cell_nodes[nv * c];
    const double tau = cell_.stabilisation[c];
    Vec3 known = Vec3::Zero();
    if (balance)
      for (int d = 0; d < mesh_.dimension; ++d) known[d] = cell_.balance[d][c];
    for (std::size_t q = 0; q < points; ++q) {
      Mat3 J = Mat3::Zero();
      Vec3 increment = Vec3::Zero(), rest = Vec3::Zero(), flux = Vec3::Zero(), projected = Vec3::Zero();
      for (std::size_t a = 0; a < nv; ++a) {
        const Vec3 slope = vec3(table.dM[q][a]);
        J += vec3(x + 3 * a) * slope.transpose();
        increment += phi[node[a]] * slope;
        rest += pressure_[node[a]] * slope;
        flux += table.M[q][a] * vec3(&flux_[3 * node[a]]);
        projected += table.M[q][a] * vec3(&projection_[3 * node[a]]);
      }
      if (mesh_.dimension == 2) J(2, 2) = 1;
      const Mat3 inverse = J.inverse().transpose();
      vec3(&result[3 * (points * c + q)]) =
          flux - coefficient[c] * (inverse * increment) - tau * (inverse * rest + known - projected);
    }
  }
  return result;
}

double PressureCorrection::courant_rate() const {
  double rate = 0;
  for (int i = 0; i < mesh_.nodes; ++i) rate = std::max(rate, vec3(&velocity_[3 * i]).norm() / node_size_[i]);
  return mpi_max(rate);
}

std::vector<Fluid::StateArray> PressureCorrection::state() {
  // Matrices and hierarchy are made afresh after a checkpoint, as after a restart: both go on with the same bits.
  renew_ = true;
  return arrays();
}

std::vector<Fluid::StateArray> PressureCorrection::arrays() {
  std::vector<StateArray> arrays = {{"velocity", &velocity_, 3},
                                    {"old_velocity", &old_velocity_, 3},
                                    {"pressure", &pressure_, 1},
                                    {"pressure_increment", &increment_, 1},
                                    {"old_pressure_increment", &old_increment_, 1},
                                    {"last_void_fraction", &void_fraction_, 1},
                                    {"old_void_fraction", &old_void_fraction_, 1},
                                    {"drag", &drag_, 1},
                                    {"old_drag", &old_drag_, 1},
                                    {"pressure_gradient", &pressure_gradient_, 3},
                                    {"velocity_change", &velocity_change_, 3},
                                    {"carrying_velocity", &carrying_, 3},
                                    {"following", &following_, 1},
                                    {"old_following", &old_following_, 1},
                                    {"lent_pressure", &lent_pressure_, 1},
                                    {"fluid_steps", &past_, 4}};
  if (drive_) {
    arrays.push_back({"drive_gradient", &last_drive_, 1});
    arrays.push_back({"drive_answer", &drive_answer_, 3});
  }
  if (energy_) energy_->add_state(arrays);
  if (turbulence_) turbulence_->add_state(arrays);
  return arrays;
}

void PressureCorrection::restored() {
  if (turbulence_) turbulence_->restored();
}

std::vector<Fluid::Scalar> PressureCorrection::scalars() const {
  std::vector<Scalar> result = Fluid::scalars();
  if (turbulence_) turbulence_->add_scalars(result);
  return result;
}

Turbulence::Flow PressureCorrection::turbulent_flow(const std::vector<double>& velocity) const {
  return {velocity,         density_field_, viscosity_field_,        load_.void_fraction,
          load_.turbulence, false,          load_.dissipation_factor};
}

void PressureCorrection::set_eddy_viscosity() {
  if (!turbulence_) return;
  const auto& cells = turbulence_->cell_eddy_viscosity();
  eddy_viscosity_.assign(loops_.padded_cells(), cells.empty() ? 0.0 : cells.back());
  std::copy(cells.begin(), cells.end(), eddy_viscosity_.begin());
  turbulence_->add_transposed_stress(mesh_, convecting_, load_.void_fraction, body_force_);
}

}  // namespace silt
