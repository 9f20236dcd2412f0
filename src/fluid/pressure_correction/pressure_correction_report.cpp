// What a step of the pressure correction left: balances, boundary flows and forces.
#include <algorithm>

#include "fluid/pressure_correction/pressure_correction.hpp"

namespace silt {

/// Fills flow, mean pressure and force of every boundary; returns the momentum that convection carries in.
Vec3 PressureCorrection::boundary_reactions(std::vector<BoundaryFlow>& flows) const {
  const int boundaries = static_cast<int>(mesh_.boundaries.size()), columns = 9;
  // Per boundary: volume flow, int p, force (3), convected momentum (3), spare.
  std::vector<double> sums(static_cast<std::size_t>(boundaries) * columns, 0.0);
  const auto at = [&](int b) { return sums.data() + static_cast<std::size_t>(b) * columns; };

  // The residual of the momentum rows of constrained nodes is the boundary's force on the fluid beside the pressure,
  // exact to the order of the elements' own balance.
  std::vector<double> residual(3 * mesh_.nodes, 0.0);
  momentum_.apply(velocity_.data(), residual.data(), 3);
  for (const auto& constraint : boundaries_.constraints()) {
    const int i = constraint.node;
    if (i >= mesh_.owned_nodes) continue;
    const Vec3 row = vec3(&residual[3 * i]) - vec3(&right_[3 * i]);
    Vec3 reaction = Vec3::Zero();
    for (int k = 0; k < constraint.count; ++k) reaction += constraint.direction[k] * constraint.direction[k].dot(row);
    vec3(at(boundaries_.velocity_boundary()[i]) + 2) -= reaction;
  }
  for (const auto& rule : boundaries_.facets())
    for (int q = 0; q < rule.points; ++q) {
      const auto& point = rule.point[q];
      Vec3 u = Vec3::Zero();
      double p = 0, alpha = 0;
      for (int a = 0; a < rule.nodes; ++a) {
        const int i = rule.node[a];
        u += point.shape[a] * vec3(&velocity_[3 * i]);
        p += point.shape[a] * pressure_[i];
        alpha += point.shape[a] * load_.void_fraction[i];
      }
      double* sum = at(rule.boundary);
      sum[1] += p * point.area.norm();
      vec3(sum + 2) += p * point.area;
      // What the backflow term takes from fluid that comes in is not carried in.
      const double out = u.dot(point.area);
      const bool taken = out < 0 && boundaries_.type(rule.boundary) == BoundaryType::pressure;
      vec3(sum + 5) -= density_ * alpha * out * (taken ? 1 - fluid_.backflow : 1.0) * u;
    }
  for (int i = 0; i < mesh_.owned_nodes; ++i)
    if (boundaries_.pressure_boundary()[i] >= 0) at(boundaries_.pressure_boundary()[i])[0] += outflow_[i];
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);

  flows.assign(boundaries, {});
  Vec3 convected = Vec3::Zero();
  for (int b = 0; b < boundaries; ++b) {
    flows[b].volume_flow = at(b)[0] + boundaries_.boundary_flow()[b];
    flows[b].mass_flow = density_ * flows[b].volume_flow;
    flows[b].mean_pressure = at(b)[1] / boundaries_.area(b);
    flows[b].force = vec3(at(b) + 2);
    if (energy_) flows[b].heat_flow = energy_->heat_flow()[b];
    convected += vec3(at(b) + 5);
  }
  return convected;
}

std::vector<BoundaryFlow> PressureCorrection::boundary_flow() const {
  std::vector<BoundaryFlow> flows;
  boundary_reactions(flows);
  return flows;
}

FluidStep PressureCorrection::report(double dt) const {
  FluidStep step;
  std::vector<BoundaryFlow> flows;
  step.boundary_force = boundary_reactions(flows);
  for (const auto& flow : flows) step.boundary_force -= flow.force;
  if (drive_) {  // what the mean pressure does to both phases; the particles' share is in their exchange
    step.drive_gradient = drive_gradient_;
    step.drive_velocity = mean_flow(velocity_);
    step.boundary_force[drive_->direction()] += drive_gradient_ * mesh_.volume;
  }
  std::array<double, 3> momentum{};
  for (int i = 0; i < mesh_.owned_nodes; ++i)
    for (int d = 0; d < 3; ++d) momentum[d] += density_ * mass_[i] * load_.void_fraction[i] * velocity_[3 * i + d];
  MPI_Allreduce(MPI_IN_PLACE, momentum.data(), 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  step.momentum = vec3(momentum.data());
  step.lent = lent_impulse();
  step.courant = courant_rate() * dt;
  return step;
}

double PressureCorrection::volume_imbalance(double prescribed, double inflow, double volume_rate) {
  double open = 0, entering = 0, speed = 0;
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    open += outflow_[i];
    entering += std::max(0.0, -outflow_[i]);
    speed += mass_[i] / mesh_.volume * vec3(&velocity_[3 * i]).norm();
  }
  const double scale = volume_scale_.next(inflow + mpi_sum(entering), volume_rate, mpi_sum(speed), mesh_.volume,
                                          mesh_.dimension, bdf_dt_);
  return -(prescribed + mpi_sum(open) + volume_rate) / scale;
}

}  // namespace silt
