// What a step of the monolithic scheme left: flows and forces at the boundaries, balances, the Courant number.
#include <algorithm>
#include <array>

#include "fluid/assembly/flow_table.hpp"
#include "fluid/monolithic.hpp"
#include "fluid/space/quadratic_element.hpp"

namespace silt {

double Monolithic::courant_rate() const {
  const LagrangeSpace& space = system_.space();
  double rate = 0;
  for (int c = 0; c < mesh_.cells; ++c)
    for (int a = 0; a < space.nodes_per_cell; ++a) {
      const size_t n = 3 * static_cast<size_t>(space.cell_nodes[static_cast<size_t>(c) * space.nodes_per_cell + a]);
      rate = std::max(rate, vec3(&velocity_[n]).norm() / system_.cell_size()[c]);
    }
  return mpi_max(rate);
}

std::vector<double> Monolithic::velocity_at(const Quadrature& rule) const {
  if (system_.equal_order()) return {};
  const LagrangeSpace& space = system_.space();
  const int nv = space.nodes_per_cell;
  std::vector<double> N(static_cast<size_t>(rule.points) * nv),
      result(3 * static_cast<size_t>(mesh_.cells) * rule.points);
  std::vector<std::array<double, 3>> slopes(nv);
  for (int q = 0; q < rule.points; ++q)
    quadratic_shape(mesh_.cell, rule.point[q].data(), &N[static_cast<size_t>(q) * nv],
                    reinterpret_cast<double(*)[3]>(slopes.data()));
  for (int c = 0; c < mesh_.cells; ++c)
    for (int q = 0; q < rule.points; ++q)
      for (int a = 0; a < nv; ++a)
        vec3(&result[3 * (static_cast<size_t>(c) * rule.points + q)]) +=
            N[static_cast<size_t>(q) * nv + a] *
            vec3(&velocity_[3 * static_cast<size_t>(space.cell_nodes[static_cast<size_t>(c) * nv + a])]);
  return result;
}

std::vector<BoundaryFlow> Monolithic::boundary_flow() const {
  return boundary_flow(system_.boundary_integrals(fields_, unknown_));
}

std::vector<BoundaryFlow> Monolithic::boundary_flow(const std::vector<FacetIntegrals>& integrals) const {
  const std::vector<Vec3> forces = system_.boundary_forces(fields_, unknown_);
  std::vector<BoundaryFlow> result(integrals.size());
  for (size_t b = 0; b < result.size(); ++b) {
    const bool open = boundary_.type(static_cast<int>(b)) == BoundaryType::pressure;
    result[b].volume_flow = open ? integrals[b].volume_flow : boundary_.boundary_flow()[b];
    result[b].mean_pressure = integrals[b].area > 0 ? integrals[b].pressure / integrals[b].area : 0;
    result[b].mass_flow = density_ * result[b].volume_flow;
    if (energy_) result[b].heat_flow = energy_->heat_flow()[b];
    result[b].force = open ? integrals[b].traction : forces[b];
  }
  return result;
}

FluidStep Monolithic::report(double dt) {
  FluidStep step;
  step.courant = courant_rate() * dt;
  const std::vector<FacetIntegrals> integrals = system_.boundary_integrals(fields_, unknown_);
  const std::vector<BoundaryFlow> flows = boundary_flow(integrals);
  double sum = 0, inflow = 0, stored = 0, speed = 0;
  for (size_t b = 0; b < flows.size(); ++b) {
    sum += flows[b].volume_flow;
    inflow += std::max(0.0, -flows[b].volume_flow);
    step.boundary_force -= flows[b].force + integrals[b].convection;
  }
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    stored += system_.lumped_mass()[i] * fields_.alpha_rate[i];
    speed += system_.lumped_mass()[i] / mesh_.volume * vec3(&velocity_[3 * i]).norm();
  }
  stored = mpi_sum(stored);
  step.mass_residual =
      -(sum + stored) / volume_scale_.next(inflow, stored, mpi_sum(speed), mesh_.volume, mesh_.dimension, dt);
  step.momentum = density_ * total_flux();
  if (model_a_) step.lent = dt * lent_force();
  if (drive_) {  // what the mean pressure does to both phases; the particles' share is in their exchange
    step.drive_gradient = drive_gradient_;
    step.drive_velocity = step.momentum[drive_->direction()] / (density_ * mesh_.volume);
    step.boundary_force[drive_->direction()] += drive_gradient_ * mesh_.volume;
  }
  return step;
}

Vec3 Monolithic::total_flux() const {
  const LagrangeSpace& space = system_.space();
  const FlowTable& table = flow_table(mesh_.cell, space.order);
  const int np = mesh_.nodes_per_cell, nv = space.nodes_per_cell;
  const bool simplex = np == mesh_.dimension + 1;
  Vec3 flux = Vec3::Zero();
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * static_cast<size_t>(c) * np];
    double volume = 0;  // of the cell over that of the reference, the same in all of a simplex
    for (int q = 0; q < table.points; ++q) {
      if (q == 0 || !simplex) {
        Mat3 J = Mat3::Zero();
        for (int a = 0; a < np; ++a) J += vec3(x + 3 * a) * vec3(table.dM[q][a]).transpose();
        if (mesh_.dimension == 2) J(2, 2) = 1;
        volume = J.determinant();
      }
      double alpha = 0;
      Vec3 u = Vec3::Zero();
      for (int a = 0; a < nv; ++a) {
        const size_t n = space.cell_nodes[static_cast<size_t>(c) * nv + a];
        alpha += table.N[q][a] * fields_.alpha[n];
        u += table.N[q][a] * vec3(&velocity_[3 * n]);
      }
      flux += table.weight[q] * volume * alpha * u;
    }
  }
  for (int i = 0; i < 3; ++i) flux[i] = mpi_sum(flux[i]);
  return flux;
}

Vec3 Monolithic::lent_force() const {
  // As the weak form has it: s and grad p at the quadrature points.
  const FlowTable& table = flow_table(mesh_.cell, system_.space().order);
  const size_t np = mesh_.nodes_per_cell;
  Vec3 force = Vec3::Zero();
  const bool lent = std::any_of(lent_share_.begin(), lent_share_.end(), [](double share) { return share != 0; });
  for (int c = 0; lent && c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * static_cast<size_t>(c) * np];
    const int* node = &mesh_.cell_nodes[np * static_cast<size_t>(c)];
    for (int q = 0; q < table.points; ++q) {
      Mat3 J = Mat3::Zero();
      Vec3 reference = Vec3::Zero();
      double share = 0;
      for (size_t a = 0; a < np; ++a) {
        J += vec3(x + 3 * a) * vec3(table.dM[q][a]).transpose();
        reference += pressure_[node[a]] * vec3(table.dM[q][a]);
        share += lent_share_[node[a]] * table.M[q][a];
      }
      if (mesh_.dimension == 2) J(2, 2) = 1;
      force += table.weight[q] * J.determinant() * share * (J.inverse().transpose() * reference);
    }
  }
  for (int i = 0; i < 3; ++i) force[i] = mpi_sum(force[i]);
  return force;
}

}  // namespace silt
