#include "fluid/pressure_correction/velocity_solver.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/error.hpp"

namespace silt {
namespace {

constexpr int most_iterations = 200;
/// Least gain on the first residual: a force too weak to show beside b would be lost anew in every step.
constexpr double least_gain = 1e-2;
constexpr double least_residual = 1e-10;  ///< of b; below that nothing more is gained for its own sake

template <std::size_t count>
std::array<double, count> sum_ranks(std::array<double, count> local) {
  MPI_Allreduce(MPI_IN_PLACE, local.data(), count, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return local;
}

}  // namespace

int VelocitySolver::solve(const NodalMatrix& matrix, const std::vector<double>& diagonal,
                          const BoundaryConditions& boundaries, const std::vector<double>& right,
                          std::vector<double>& u, double tolerance) {
  const std::size_t size = u.size(), owned = 3 * static_cast<std::size_t>(mesh_.owned_nodes), nodes = diagonal.size();
  for (auto* vector : {&r_, &shadow_, &p_, &v_, &t_, &y_}) vector->resize(size);

  matrix.apply(u.data(), v_.data(), 3);
  for (std::size_t i = 0; i < size; ++i) r_[i] = right[i] - v_[i];
  boundaries.project(r_.data());
  t_ = right;
  boundaries.project(t_.data());
  std::array<double, 2> norms{};
  for (std::size_t i = 0; i < owned; ++i) norms[0] += r_[i] * r_[i], norms[1] += t_[i] * t_[i];
  norms = sum_ranks(norms);
  double residual = norms[0];
  const double gained = std::max(least_gain * least_gain * norms[0], least_residual * least_residual * norms[1]);
  const double goal = std::min(tolerance * tolerance * std::max(norms[0], norms[1]), gained);
  if (!std::isfinite(goal)) throw SolveFailure("the velocity equation holds non-finite values");

  double rho = 1, step = 1, omega = 1;
  bool restart = true;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    if (residual <= goal) return iteration;
    if (restart) {
      shadow_ = r_;
      p_ = r_;
      rho = residual;
      restart = false;
    }
    // y = D^-1 p, v = A y
    for (std::size_t i = 0; i < nodes; ++i)
      for (int d = 0; d < 3; ++d) y_[3 * i + d] = p_[3 * i + d] / diagonal[i];
    boundaries.project(y_.data());
    matrix.apply(y_.data(), v_.data(), 3);
    boundaries.project(v_.data());
    std::array<double, 1> shadow_v{};
    for (std::size_t i = 0; i < owned; ++i) shadow_v[0] += shadow_[i] * v_[i];
    step = rho / sum_ranks(shadow_v)[0];
    for (std::size_t i = 0; i < size; ++i) u[i] += step * y_[i], r_[i] -= step * v_[i];
    // y = D^-1 s, t = A y
    for (std::size_t i = 0; i < nodes; ++i)
      for (int d = 0; d < 3; ++d) y_[3 * i + d] = r_[3 * i + d] / diagonal[i];
    boundaries.project(y_.data());
    matrix.apply(y_.data(), t_.data(), 3);
    boundaries.project(t_.data());
    std::array<double, 2> ts{};
    for (std::size_t i = 0; i < owned; ++i) ts[0] += t_[i] * r_[i], ts[1] += t_[i] * t_[i];
    ts = sum_ranks(ts);
    omega = ts[1] > 0 ? ts[0] / ts[1] : 0;
    for (std::size_t i = 0; i < size; ++i) u[i] += omega * y_[i], r_[i] -= omega * t_[i];
    std::array<double, 2> next{};
    for (std::size_t i = 0; i < owned; ++i) next[0] += r_[i] * r_[i], next[1] += shadow_[i] * r_[i];
    next = sum_ranks(next);
    residual = next[0];
    if (!std::isfinite(residual)) break;
    const double beta = next[1] / rho * step / omega;
    // The shadow residual has become orthogonal to r (or omega vanished): go on from r as from the start.
    restart = !std::isfinite(beta) || std::abs(next[1]) < 1e-12 * std::sqrt(residual * rho) || omega == 0;
    rho = next[1];
    if (!restart)
      for (std::size_t i = 0; i < size; ++i) p_[i] = r_[i] + beta * (p_[i] - omega * v_[i]);
  }
  if (residual <= goal) return most_iterations;
  throw SolveFailure(fmt::format("the velocity equation did not converge in {} iterations (residual {:.1e} of {:.1e})",
                                 most_iterations, std::sqrt(residual), std::sqrt(goal)));
}

}  // namespace silt
