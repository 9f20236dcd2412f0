// What the monolithic scheme keeps between steps, and what it tells of it.
#include <algorithm>

#include "fluid/initial_projection.hpp"
#include "fluid/monolithic.hpp"

namespace silt {

std::vector<Fluid::StateArray> Monolithic::state() {
  solver_.renew();  // a restart has no factors of earlier steps either
  return arrays();
}

std::vector<Fluid::StateArray> Monolithic::arrays() {
  // A checkpoint sees the vertices as [nodes][3] and the middles by cell.
  const LagrangeSpace& space = system_.space();
  const int np = mesh_.nodes_per_cell, nv = space.nodes_per_cell;
  std::vector<StateArray> result = {{"pressure", &pressure_, 1},
                                    {"velocity", &vertices_, 3},
                                    {"velocity_previous", &vertices_previous_, 3},
                                    {"velocity_change", &change_, 3},
                                    {"fluid_step_previous", &step_previous_, 1},
                                    {"lent_share", &lent_share_, 1}};
  const size_t vertices = 3 * static_cast<size_t>(mesh_.nodes);
  vertices_.assign(velocity_.begin(), velocity_.begin() + static_cast<long>(vertices));
  vertices_previous_.assign(velocity_previous_.begin(), velocity_previous_.begin() + static_cast<long>(vertices));
  if (drive_) result.push_back({"drive_gradient", &last_drive_, 1});
  if (energy_) energy_->add_state(result);
  if (turbulence_) turbulence_->add_state(result);
  if (system_.equal_order()) return result;
  const auto gather = [&](const std::vector<double>& from, std::vector<double>& to) {
    to.resize(3 * static_cast<size_t>(mesh_.cells) * (nv - np));
    for (int c = 0; c < mesh_.cells; ++c)
      for (int a = np; a < nv; ++a)
        std::copy_n(&from[3 * static_cast<size_t>(space.cell_nodes[static_cast<size_t>(c) * nv + a])], 3,
                    &to[3 * (static_cast<size_t>(c) * (nv - np) + a - np)]);
  };
  gather(velocity_, middles_);
  gather(velocity_previous_, middles_previous_);
  result.push_back({"velocity_middles", &middles_, 3 * (nv - np), true});
  result.push_back({"velocity_middles_previous", &middles_previous_, 3 * (nv - np), true});
  return result;
}

void Monolithic::restored() {
  const LagrangeSpace& space = system_.space();
  const int np = mesh_.nodes_per_cell, nv = space.nodes_per_cell;
  std::copy(vertices_.begin(), vertices_.end(), velocity_.begin());
  std::copy(vertices_previous_.begin(), vertices_previous_.end(), velocity_previous_.begin());
  if (!system_.equal_order()) {
    const auto scatter = [&](const std::vector<double>& from, std::vector<double>& to) {
      to.resize(3 * static_cast<size_t>(space.nodes));
      for (int c = 0; c < mesh_.cells; ++c)
        for (int a = np; a < nv; ++a)
          std::copy_n(&from[3 * (static_cast<size_t>(c) * (nv - np) + a - np)], 3,
                      &to[3 * static_cast<size_t>(space.cell_nodes[static_cast<size_t>(c) * nv + a])]);
    };
    scatter(middles_, velocity_);
    scatter(middles_previous_, velocity_previous_);
  }
  system_.to_vector(velocity_.data(), pressure_.data(), unknown_);
  if (turbulence_) turbulence_->restored();
  find_pressure_gradient();
}

void Monolithic::meet_continuity(std::span<const double> solids_flux) {
  boundary_.evaluate(0, load_.void_fraction.data());
  const LagrangeSpace& space = system_.space();
  const size_t vertices = 3 * static_cast<size_t>(mesh_.nodes);
  std::vector<double> before(velocity_.begin(), velocity_.begin() + static_cast<long>(vertices)), after = before;
  boundary_.impose(after.data());
  project_onto_continuity(mesh_, boundary_, load_.void_fraction, solids_flux, after);
  for (size_t i = 0; i < vertices; ++i) after[i] -= before[i];
  // The middles of quadratic elements change as the vertices around them do.
  std::vector<double> change(velocity_.size());
  space.interpolate(after.data(), change.data(), 3);
  for (size_t i = 0; i < velocity_.size(); ++i) velocity_[i] += change[i];
  prepare_step(0, 0);
  system_.constraints().impose(fields_.prescribed_velocity.data(), velocity_.data());
  velocity_previous_ = velocity_;
  system_.to_vector(velocity_.data(), pressure_.data(), unknown_);
}

std::vector<Fluid::Scalar> Monolithic::scalars() const {
  std::vector<Scalar> result = Fluid::scalars();
  if (turbulence_) turbulence_->add_scalars(result);
  return result;
}

Turbulence::Flow Monolithic::turbulent_flow() const {
  return {velocity(),       density_field_, viscosity_field_,        load_.void_fraction,
          load_.turbulence, false,          load_.dissipation_factor};
}

}  // namespace silt
