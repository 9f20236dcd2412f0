// What particles do to a step of the pressure correction, and how its correction reaches them
// (docs/theory/coupling.md, C13 to C15).
#include <algorithm>

#include "fluid/pressure_correction/pressure_correction.hpp"

namespace silt {

void PressureCorrection::set_cell_forces(const double* weight) {
  if (!porous_) {
    loops_.cell_forces({nullptr, nullptr, weight}, cell_);
    return;
  }
  const int nv = mesh_.nodes_per_cell;
  double* share = scratch_[0];  // of each cell in the loads of its nodes
  for (std::size_t k = 0; k < loops_.padded_cells(); ++k)
    share[k] = cell_.drag[k] / cell_.void_fraction[k] + 1e-9 * density_ * bdf_.c0;
  std::vector<double> sums(mesh_.nodes, 0.0);
  for (int c = 0; c < mesh_.cells; ++c)
    for (int a = 0; a < nv; ++a)
      sums[mesh_.cell_nodes[static_cast<std::size_t>(c) * nv + a]] += share[c] * mesh_.cell_volumes[c];
  mesh_.sum_shared(sums.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i)
    for (int d = 0; d < 3; ++d)
      load_per_drag_[3 * i + d] =
          (load_.force[3 * i + d] - load_.response[i] * (convecting_[3 * i + d] - carrying_[3 * i + d])) / sums[i];
  loops_.cell_forces({load_per_drag_.data(), share, weight}, cell_);
}

void PressureCorrection::set_lent(double last_dt) {
  const int nv = mesh_.nodes_per_cell;
  std::fill(lent_, lent_ + loops_.padded_cells(), 0.0);
  if (!model_a_ || last_dt <= 0) return;
  const double share = last_dt / (bdf_dt_ * nv);
  for (int c = 0; c < mesh_.cells; ++c)
    for (int a = 0; a < nv; ++a) lent_[c] += share * following_[mesh_.cell_nodes[static_cast<std::size_t>(c) * nv + a]];
}

std::vector<double> PressureCorrection::pressure_coefficient() const {
  // The corrected velocity moves the fluid's share of the volume and that of the particles that follow it.
  const int nv = mesh_.nodes_per_cell;
  std::vector<double> moved(loops_.padded_cells());
  std::copy_n(cell_.void_fraction, moved.size(), moved.begin());
  for (int c = 0; porous_ && c < mesh_.cells; ++c)
    for (int a = 0; a < nv; ++a)
      moved[c] += load_.following[mesh_.cell_nodes[static_cast<std::size_t>(c) * nv + a]] / nv;
  for (std::size_t k = 0; k < moved.size(); ++k) moved[k] = moved[k] * cell_.mobility[k] + cell_.stabilisation[k];
  return moved;
}

void PressureCorrection::set_carrying_velocity(const std::vector<double>& phi) {
  carrying_ = solution_;
  if (!porous_) return;
  std::vector<double> share(loops_.padded_cells()), push(3 * static_cast<std::size_t>(mesh_.nodes), 0.0);
  for (std::size_t k = 0; k < share.size(); ++k) share[k] = cell_.pressure_share[k] + cell_.following[k];
  loops_.mean_gradient(phi.data(), share.data(), push.data());
  mesh_.sum_shared(push.data(), 3);
  for (int i = 0; i < mesh_.nodes; ++i)
    vec3(&push[3 * i]) /= mass_[i] * (load_.void_fraction[i] * density_ * bdf_.c0 + drag_now_[i]);
  boundaries_.project(push.data());  // what is prescribed stays
  for (std::size_t i = 0; i < push.size(); ++i) carrying_[i] -= push[i];
}

Vec3 PressureCorrection::lent_impulse() const {
  if (!porous_) return Vec3::Zero();
  std::vector<double> share(cell_.following, cell_.following + loops_.padded_cells()),
      sums(3 * static_cast<std::size_t>(mesh_.nodes), 0.0);
  loops_.mean_gradient(lent_pressure_.data(), share.data(), sums.data());
  double total[3] = {};
  for (std::size_t i = 0; i < sums.size(); ++i) total[i % 3] += bdf_dt_ * sums[i];
  MPI_Allreduce(MPI_IN_PLACE, total, 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return vec3(total);
}

}  // namespace silt
