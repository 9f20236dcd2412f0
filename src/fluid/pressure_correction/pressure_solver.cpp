#include "fluid/pressure_correction/pressure_solver.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "base/error.hpp"

namespace silt {

PressureSolver::PressureSolver(const NodalGraph& graph, const std::vector<int>& fixed_boundary, bool singular)
    : graph_(graph), singular_(singular), matrix_(graph) {
  const Mesh& mesh = graph.mesh;
  fixed_.resize(mesh.nodes);
  for (int i = 0; i < mesh.nodes; ++i) fixed_[i] = fixed_boundary[i] >= 0;
  for (int i = 0; i < mesh.nodes; ++i)
    for (int k = graph.row_start[i]; k < graph.row_start[i + 1]; ++k)
      if (fixed_[i] || fixed_[graph.column[k]]) aside_.push_back({k, i, graph.column[k]});

  petsc_ = matrix_.create_petsc();
  SILT_PETSC(MatCreateVecs(petsc_, solution_.out(), right_.out()));
  create_solver();
  if (singular && !direct_) {
    MatNullSpace constants;
    SILT_PETSC(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_TRUE, 0, nullptr, &constants));
    SILT_PETSC(MatSetNullSpace(petsc_, constants));
    SILT_PETSC(MatNullSpaceDestroy(&constants));
  }
}

void PressureSolver::create_solver() {
  SILT_PETSC(KSPCreate(PETSC_COMM_WORLD, ksp_.out()));
  SILT_PETSC(KSPSetOptionsPrefix(ksp_, "fluid_pressure_"));
  SILT_PETSC(KSPSetType(ksp_, KSPCG));
  SILT_PETSC(KSPSetNormType(ksp_, KSP_NORM_UNPRECONDITIONED));
  SILT_PETSC(KSPSetTolerances(ksp_, 1e-3, 1e-50, 1e5, 200));
  PC pc;
  SILT_PETSC(KSPGetPC(ksp_, &pc));
  SILT_PETSC(PCSetType(pc, PCGAMG));
  SILT_PETSC(KSPSetFromOptions(ksp_));
  PetscBool same = PETSC_FALSE;
  SILT_PETSC(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp_.get()), KSPPREONLY, &same));
  direct_ = same;
  SILT_PETSC(KSPSetInitialGuessNonzero(ksp_, direct_ ? PETSC_FALSE : PETSC_TRUE));
  if (direct_) SILT_PETSC(KSPSetNormType(ksp_, KSP_NORM_NONE));
}

void PressureSolver::update(bool renew) {
  for (auto& entry : aside_) {
    entry.value = matrix_.values[entry.place];
    if (entry.row != entry.column) matrix_.values[entry.place] = 0;
  }
  // A direct solver needs a regular matrix: a spring at one node of a closed domain does not change a solvable
  // equation's solution but for its constant.
  if (singular_ && direct_ && graph_.mesh.owned_nodes > 0 && graph_.mesh.first_node == 0)
    matrix_.values[graph_.diagonal[0]] *= 2;
  matrix_.fill_petsc(petsc_);
  // Every assembly but the first forgets these.
  SILT_PETSC(MatSetOption(petsc_, MAT_SYMMETRIC, PETSC_TRUE));
  if (!singular_) SILT_PETSC(MatSetOption(petsc_, MAT_SPD, PETSC_TRUE));
  if (!renew) return;
  // A new object, not only a new set-up: the random vectors of its eigenvalue estimates start over, so that a run goes
  // on from a checkpoint with the same bits as one that is restarted from it.
  create_solver();
  reference_iterations_ = -1;
}

void PressureSolver::lift(const std::vector<double>& phi, std::vector<double>& right) const {
  std::vector<double> known(phi.size(), 0.0);
  for (const auto& entry : aside_)
    if (fixed_[entry.column] && !fixed_[entry.row]) known[entry.row] += entry.value * phi[entry.column];
  graph_.mesh.sum_shared(known.data(), 1);
  const std::vector<double> diagonal = matrix_.diagonal();
  for (std::size_t i = 0; i < phi.size(); ++i) right[i] = fixed_[i] ? diagonal[i] * phi[i] : right[i] - known[i];
}

std::vector<double> PressureSolver::fixed_rows(const std::vector<double>& phi) const {
  std::vector<double> result(phi.size(), 0.0);
  for (const auto& entry : aside_)
    if (fixed_[entry.row]) result[entry.row] += entry.value * phi[entry.column];
  graph_.mesh.sum_shared(result.data(), 1);
  return result;
}

bool PressureSolver::attempt(int& iterations) {
  SILT_PETSC(KSPSetOperators(ksp_, petsc_, petsc_));
  SILT_PETSC(KSPSetReusePreconditioner(ksp_, !direct_ && reference_iterations_ >= 0 ? PETSC_TRUE : PETSC_FALSE));
  // GAMG estimates eigenvalues from drand48, whose state would otherwise make a set-up depend on those before.
  if (reference_iterations_ < 0) srand48(1);
  SILT_PETSC(KSPSolve(ksp_, right_, solution_));
  KSPConvergedReason reason;
  PetscInt count;
  SILT_PETSC(KSPGetConvergedReason(ksp_, &reason));
  SILT_PETSC(KSPGetIterationNumber(ksp_, &count));
  iterations += static_cast<int>(count);
  if (reason <= 0) return false;
  if (reference_iterations_ < 0)
    reference_iterations_ = static_cast<int>(count);
  else if (count > 1.5 * reference_iterations_ + 2)
    reference_iterations_ = -1;  // the next solve renews
  return true;
}

int PressureSolver::solve(std::vector<double> right, std::vector<double>& phi) {
  const Mesh& mesh = graph_.mesh;
  const std::size_t bytes = sizeof(double) * mesh.owned_nodes;
  lift(phi, right);
  const auto fill = [&](Vec vector, const double* values) {
    PetscScalar* array;
    SILT_PETSC(VecGetArrayWrite(vector, &array));
    if (bytes) std::memcpy(array, values, bytes);
    SILT_PETSC(VecRestoreArrayWrite(vector, &array));
  };
  fill(right_, right.data());
  fill(solution_, phi.data());
  int iterations = 0;
  const bool kept = reference_iterations_ >= 0;
  bool converged = attempt(iterations);
  if (!converged && kept && !direct_) {  // the kept hierarchy may no longer fit the matrix
    reference_iterations_ = -1;
    fill(solution_, phi.data());
    converged = attempt(iterations);
  }
  if (!converged) {
    reference_iterations_ = -1;
    KSPConvergedReason reason;
    SILT_PETSC(KSPGetConvergedReason(ksp_, &reason));
    throw SolveFailure(fmt::format("the pressure equation did not converge after {} iterations ({})", iterations,
                                   KSPConvergedReasons[reason]));
  }
  if (singular_) {
    PetscScalar mean;
    SILT_PETSC(VecSum(solution_, &mean));
    SILT_PETSC(VecShift(solution_, -mean / static_cast<double>(mesh.total_nodes)));
  }
  const PetscScalar* array;
  SILT_PETSC(VecGetArrayRead(solution_, &array));
  for (int i = 0; i < mesh.owned_nodes; ++i)
    if (!fixed_[i]) phi[i] = array[i];
  SILT_PETSC(VecRestoreArrayRead(solution_, &array));
  mesh.copy_from_owner(phi.data(), 1);
  return iterations;
}

}  // namespace silt
