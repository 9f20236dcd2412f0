// The pressure gradient that drives a periodic flow through the pressure correction.
#include <cmath>

#include "base/error.hpp"
#include "fluid/pressure_correction/pressure_correction.hpp"

namespace silt {

void PressureCorrection::start_drive() {
  const int n = mesh_.nodes, nv = mesh_.nodes_per_cell;
  driven_ = true;
  last_drive_.assign(n, 0.0);
  drive_answer_.assign(3 * static_cast<std::size_t>(n), 0.0);
  drive_share_.assign(n, 0.0);
  for (int c = 0; c < mesh_.cells; ++c)
    for (int a = 0; a < nv; ++a)
      drive_share_[mesh_.cell_nodes[static_cast<std::size_t>(c) * nv + a]] += mesh_.cell_volumes[c] / nv;
  mesh_.sum_shared(drive_share_.data(), 1);
  for (int i = 0; i < n; ++i) drive_share_[i] /= mass_[i];
}

void PressureCorrection::choose_drive(double time) {
  if (!drive_->controlled()) {
    drive_gradient_ = drive_->gradient(time);
    return;
  }
  drive_gradient_ = mpi_max(mesh_.nodes ? last_drive_[0] : -infinity);  // a rank may have no nodes
  drive_target_ = drive_->velocity(time);
}

void PressureCorrection::add_drive() {
  drive_load_.assign(mesh_.nodes, 0.0);
  loops_.drive(terms_, drive_load_.data());
  mesh_.sum_shared(drive_load_.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i) right_[3 * i + drive_->direction()] += drive_gradient_ * drive_load_[i];
}

double PressureCorrection::mean_flow(const std::vector<double>& u) const {
  double sum = 0;
  for (int i = 0; i < mesh_.owned_nodes; ++i) sum += mass_[i] * load_.void_fraction[i] * u[3 * i + drive_->direction()];
  return mpi_sum(sum) / mesh_.volume;
}

int PressureCorrection::control_flow() {
  // The velocity equation is linear: what a gradient of 1 Pa/m adds is found once more each step, from the last answer.
  std::vector<double> load(3 * static_cast<std::size_t>(mesh_.nodes), 0.0);
  for (int i = 0; i < mesh_.nodes; ++i) load[3 * i + drive_->direction()] = drive_load_[i];
  const int iterations = velocity_solver_.solve(momentum_, momentum_.diagonal(), boundaries_, load, drive_answer_,
                                                scheme_.velocity_tolerance);
  const double answer = mean_flow(drive_answer_);
  const double more = (drive_target_ - mean_flow(solution_)) / answer;
  if (!std::isfinite(more)) throw SolveFailure("no pressure gradient gives the flow asked for (-fluid_drive_...)");
  for (std::size_t i = 0; i < load.size(); ++i) {
    solution_[i] += more * drive_answer_[i];
    right_[i] += more * load[i];
  }
  drive_gradient_ += more;
  return iterations;
}

void PressureCorrection::accept_drive() {
  const int d = drive_->direction();
  for (int i = 0; i < mesh_.nodes; ++i) {
    last_drive_[i] = drive_gradient_;
    pressure_gradient_[3 * i + d] -= drive_share_[i] * drive_gradient_;
  }
}

}  // namespace silt
