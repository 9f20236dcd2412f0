#include "fluid/transport/scalar_system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace silt {

ScalarSystem::ScalarSystem(const NodalGraph& graph, const std::string& prefix)
    : graph_(graph),
      mesh_(graph.mesh),
      prefix_(prefix),
      matrix_(graph_),
      constrained_(graph_),
      right_(mesh_.nodes, 0.0),
      petsc_(matrix_.create_petsc()) {
  SILT_PETSC(VecCreateMPI(PETSC_COMM_WORLD, mesh_.owned_nodes, PETSC_DETERMINE, unknown_.out()));
  SILT_PETSC(VecDuplicate(unknown_, load_.out()));
  SILT_PETSC(KSPCreate(PETSC_COMM_WORLD, ksp_.out()));
  SILT_PETSC(KSPSetOptionsPrefix(ksp_, prefix.c_str()));
  SILT_PETSC(KSPSetType(ksp_, KSPBCGS));
  PC pc;
  SILT_PETSC(KSPGetPC(ksp_, &pc));
  SILT_PETSC(PCSetType(pc, PCBJACOBI));
  SILT_PETSC(KSPSetOperators(ksp_, petsc_, petsc_));
}

void ScalarSystem::zero() {
  matrix_.zero();
  std::fill(right_.begin(), right_.end(), 0.0);
}

int ScalarSystem::solve(const std::vector<char>& fixed, std::vector<double>& T) {
  // Solved for the change, so that a large mean value does not hide it from the tolerance.
  std::vector<double> rest = residual(T);
  constrained_.values = matrix_.values;
  for (int i = 0; i < mesh_.nodes; ++i) {
    if (!fixed[i]) continue;
    for (int k = graph_.row_start[i]; k < graph_.row_start[i + 1]; ++k) constrained_.values[k] = 0;
    constrained_.values[graph_.diagonal[i]] = i < mesh_.owned_nodes ? 1 : 0;
    rest[i] = 0;
  }
  constrained_.fill_petsc(petsc_);
  double* array;
  SILT_PETSC(VecGetArrayWrite(load_, &array));
  double scale = 0;
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    array[i] = -rest[i];
    if (!fixed[i]) scale += right_[i] * right_[i];
  }
  SILT_PETSC(VecRestoreArrayWrite(load_, &array));
  scale = std::sqrt(mpi_sum(scale));
  if (!std::isfinite(scale)) throw SolveFailure(prefix_ + " equation holds non-finite values");
  SILT_PETSC(KSPSetTolerances(ksp_, 1e-7, std::max(1e-13 * scale, 1e-290), PETSC_DEFAULT, 1000));
  SILT_PETSC(KSPSetFromOptions(ksp_));
  SILT_PETSC(VecSet(unknown_, 0));
  KSPConvergedReason reason = KSP_DIVERGED_BREAKDOWN;
  PetscInt iterations = 0;
  const PetscErrorCode code = KSPSolve(ksp_, load_, unknown_);
  if (!code) {
    SILT_PETSC(KSPGetConvergedReason(ksp_, &reason));
    SILT_PETSC(KSPGetIterationNumber(ksp_, &iterations));
  }
  if (mpi_any(code || reason < 0))
    throw SolveFailure(fmt::format("the equation {} did not converge ({}) in {} iterations", prefix_,
                                   KSPConvergedReasons[reason], iterations));
  const double* change;
  std::vector<double> delta(mesh_.nodes, 0.0);
  SILT_PETSC(VecGetArrayRead(unknown_, &change));
  std::copy(change, change + mesh_.owned_nodes, delta.begin());
  SILT_PETSC(VecRestoreArrayRead(unknown_, &change));
  mesh_.copy_from_owner(delta.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i) T[i] += delta[i];
  return static_cast<int>(iterations);
}

std::vector<double> ScalarSystem::residual(const std::vector<double>& T) const {
  std::vector<double> r(mesh_.nodes);
  matrix_.apply(T.data(), r.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i) r[i] -= right_[i];
  return r;
}

}  // namespace silt
