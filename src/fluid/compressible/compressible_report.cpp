// What a step of compressible flow left: fields, balances, boundary flows, state for a restart.
#include <cmath>

#include "fluid/assembly/flow_table.hpp"
#include "fluid/compressible/compressible.hpp"

namespace silt {

std::vector<Fluid::Scalar> Compressible::scalars() const {
  std::vector<Scalar> result = {{"temperature", temperature_}, {"density", density_field_}, {"mach", mach_}};
  if (turbulence_) turbulence_->add_scalars(result);
  return result;
}

/// As in the other schemes: M_i g_i = int N_i grad p_h.
void Compressible::find_pressure_gradient() {
  const FlowTable& table = flow_table(mesh_.cell, 1);
  const int nv = mesh_.nodes_per_cell;
  std::fill(pressure_gradient_.begin(), pressure_gradient_.end(), 0.0);
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * static_cast<size_t>(c) * nv];
    const int* node = &mesh_.cell_nodes[static_cast<size_t>(c) * nv];
    for (int q = 0; q < table.points; ++q) {
      Mat3 J = Mat3::Zero();
      Vec3 slope = Vec3::Zero();
      for (int a = 0; a < nv; ++a) {
        J += vec3(x + 3 * a) * vec3(table.dM[q][a]).transpose();
        slope += pressure_[node[a]] * vec3(table.dM[q][a]);
      }
      if (mesh_.dimension == 2) J(2, 2) = 1;
      const Vec3 gradient = table.weight[q] * J.determinant() * (J.inverse().transpose() * slope);
      for (int a = 0; a < nv; ++a)
        vec3(&pressure_gradient_[3 * static_cast<size_t>(node[a])]) += table.M[q][a] * gradient;
    }
  }
  mesh_.sum_shared(pressure_gradient_.data(), 3);
  for (int i = 0; i < mesh_.nodes; ++i) vec3(&pressure_gradient_[3 * static_cast<size_t>(i)]) /= mass_[i];
}

double Compressible::displacement_power(double reference) const {
  const FlowTable& table = flow_table(mesh_.cell, 1);
  const int nv = mesh_.nodes_per_cell;
  double sum = 0;
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * static_cast<size_t>(c) * nv];
    const int* node = &mesh_.cell_nodes[static_cast<size_t>(c) * nv];
    for (int q = 0; q < table.points; ++q) {
      Mat3 J = Mat3::Zero();
      double p = -reference, rate = 0;
      for (int a = 0; a < nv; ++a) {
        J += vec3(x + 3 * a) * vec3(table.dM[q][a]).transpose();
        p += table.M[q][a] * pressure_[node[a]];
        rate += table.M[q][a] * load_.void_fraction_rate[node[a]];
      }
      if (mesh_.dimension == 2) J(2, 2) = 1;
      sum += table.weight[q] * J.determinant() * p * rate;
    }
  }
  return mpi_sum(sum);
}

std::vector<BoundaryFlow> Compressible::boundary_flow() const {
  const double around = step_.axisymmetric ? 2 * M_PI : 1;
  const auto flows = system_.boundary_flow(step_, state_);
  std::vector<BoundaryFlow> result(flows.size());
  for (size_t b = 0; b < flows.size(); ++b) {
    result[b].volume_flow = around * flows[b].volume * u0_;
    result[b].mass_flow = around * flows[b].mass * p0_ / u0_;
    result[b].mean_pressure = flows[b].pressure * p0_;
    result[b].force = around * p0_ * flows[b].momentum;
    result[b].heat_flow = around * flows[b].energy * p0_ * u0_;
  }
  return result;
}

FluidStep Compressible::report() const {
  const double around = step_.axisymmetric ? 2 * M_PI : 1;
  FluidStep step;
  const std::vector<double> total = system_.totals(conserved_), rate = system_.totals(rate_);
  for (int i = 0; i < mesh_.dimension; ++i) step.momentum[i] = around * total[1 + static_cast<size_t>(i)] * p0_ / u0_;
  step.heat = around * total.back() * p0_;
  double sum = 0, inflow = 0;
  for (const auto& flow : system_.boundary_flow(step_, state_)) {
    sum += flow.mass;
    inflow += std::max(0.0, -flow.mass);
    step.boundary_force -= around * p0_ * flow.momentum;
    step.energy_supply -= around * p0_ * u0_ * flow.energy;
  }
  for (int i = 0; i < mesh_.dimension; ++i) step.energy_supply += step_.gravity[i] * u0_ * u0_ * step.momentum[i];
  if (source_) {
    const size_t m = system_.size();
    double given = 0;
    for (size_t i = 0; i < static_cast<size_t>(mesh_.owned_nodes); ++i) {
      const double* source = &step_.source[i * m];
      double power = source[m - 1];
      for (size_t k = 1; k + 1 < m; ++k) power += source[k] * state_[i * m + k];
      given += system_.weights()[i] * power;
    }
    step.energy_supply += around * p0_ * u0_ * mpi_sum(given);
  }
  if (turbulence_ && !turbulence_->exchange().empty()) {
    double taken = 0;
    for (int i = 0; i < mesh_.owned_nodes; ++i) taken += turbulence_->exchange()[static_cast<size_t>(i)];
    step.energy_supply -= around * mpi_sum(taken);
  }
  step.mass_residual = -(sum + rate[0]) / (inflow > 0 ? inflow : 1.0);
  return step;
}

std::vector<Fluid::StateArray> Compressible::state() {
  const int m = system_.size();
  std::vector<StateArray> result = {{"gas_state", &state_, m},
                                    {"gas_conserved", &conserved_, m},
                                    {"gas_conserved_old", &old_conserved_, m},
                                    {"gas_rate", &rate_, m},
                                    {"gas_steps", &past_, 2},
                                    {"gas_capturing", &last_capturing_, 1, true},
                                    {"gas_capturing_normal", &last_normal_, m - 2, true},
                                    {"velocity_change", &velocity_change_, 3},
                                    {"temperature_change", &temperature_change_, 1}};
  if (turbulence_) turbulence_->add_state(result);
  return result;
}

void Compressible::restored() {
  from_state();
  if (!turbulence_) return;
  turbulence_->restored();
  take_eddy_viscosity();
}

}  // namespace silt
