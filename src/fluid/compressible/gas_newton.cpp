#include "fluid/compressible/gas_newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/solver_defaults.hpp"

namespace silt {
namespace {

constexpr double largest_fall = 0.5, largest_rise = 2.0;

}  // namespace

GasNewton::GasNewton(const GasSystem& system) : system_(system), matrix_(system.create_matrix()) {
  residual_ = system.create_vector();
  SILT_PETSC(SNESCreate(PETSC_COMM_WORLD, snes_.out()));
  SILT_PETSC(SNESSetOptionsPrefix(snes_, "fluid_"));
  SILT_PETSC(SNESSetFunction(snes_, residual_, residual, this));
  SILT_PETSC(SNESSetJacobian(snes_, matrix_, matrix_, jacobian, this));
  SILT_PETSC(SNESMonitorSet(snes_, monitor, this, nullptr));
  SILT_PETSC(SNESSetTolerances(snes_, 1e-50, 1e-5, 0, most_iterations, 100000));
  SNESLineSearch line;
  SILT_PETSC(SNESGetLineSearch(snes_, &line));
  SILT_PETSC(SNESLineSearchSetType(line, SNESLINESEARCHSHELL));
  SILT_PETSC(SNESLineSearchShellSetUserFunc(line, search, this));
  KSP ksp;
  PC pc;
  SILT_PETSC(SNESGetKSP(snes_, &ksp));
  SILT_PETSC(KSPGetPC(ksp, &pc));
  SILT_PETSC(KSPSetType(ksp, KSPGMRES));
  SILT_PETSC(KSPSetPCSide(ksp, PC_RIGHT));
  SILT_PETSC(KSPGMRESSetRestart(ksp, 60));
  SILT_PETSC(KSPSetTolerances(ksp, 1e-3, 1e-50, PETSC_DEFAULT, 300));
  SILT_PETSC(PCSetType(pc, mpi_size() > 1 ? PCASM : PCBJACOBI));  // alone ASM would only copy the matrix
  default_solver_option("-fluid_sub_pc_type", "ilu");
  default_solver_option("-fluid_sub_pc_factor_levels", "1");
  SILT_PETSC(SNESSetFromOptions(snes_));
  PetscReal asked;
  SILT_PETSC(SNESGetTolerances(snes_, &asked, nullptr, nullptr, nullptr, nullptr));
  if (asked > 1e-50) least_residual_ = asked;
}

PetscErrorCode GasNewton::residual(SNES, Vec x, Vec r, void* self) {
  PetscFunctionBeginUser;
  const auto& solver = *static_cast<GasNewton*>(self);
  PetscCall(solver.system_.residual(*solver.step_, x, r));
  PetscFunctionReturn(0);
}

PetscErrorCode GasNewton::jacobian(SNES, Vec x, Mat, Mat matrix, void* self) {
  PetscFunctionBeginUser;
  const auto& solver = *static_cast<GasNewton*>(self);
  PetscCall(solver.system_.jacobian(*solver.step_, x, matrix));
  PetscFunctionReturn(0);
}

PetscErrorCode GasNewton::monitor(SNES, PetscInt, PetscReal norm, void* self) {
  static_cast<GasNewton*>(self)->norms_.push_back(norm);
  return 0;
}

PetscErrorCode GasNewton::bounded(Vec x, Vec update, double& factor) const {
  PetscFunctionBeginUser;
  const double *value, *change;
  PetscInt length;
  PetscCall(VecGetLocalSize(x, &length));
  PetscCall(VecGetArrayRead(x, &value));
  PetscCall(VecGetArrayRead(update, &change));
  double largest = 1;
  const int m = system_.size();
  for (PetscInt i = 0; i < length; i += m)
    for (const PetscInt k : {i, i + m - 1}) {
      const double d = -change[k];
      const double bound = d < 0 ? largest_fall * value[k] : largest_rise * value[k];
      if (std::abs(d) * largest > bound) largest = bound / std::abs(d);
    }
  PetscCall(VecRestoreArrayRead(x, &value));
  PetscCall(VecRestoreArrayRead(update, &change));
  PetscCallMPI(MPI_Allreduce(&largest, &factor, 1, MPI_DOUBLE, MPI_MIN, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}

PetscErrorCode GasNewton::search(SNESLineSearch line, void* self) {
  PetscFunctionBeginUser;
  const auto& solver = *static_cast<GasNewton*>(self);
  SNES snes;
  Vec x, f, y, w, g;
  PetscCall(SNESLineSearchGetSNES(line, &snes));
  PetscCall(SNESLineSearchGetVecs(line, &x, &f, &y, &w, &g));
  PetscReal before, after = 0, size, step;
  PetscCall(VecNorm(f, NORM_2, &before));
  double factor = 1;
  PetscCall(solver.bounded(x, y, factor));
  bool done = false;
  for (int halving = 0; halving <= 8 && !done; ++halving, factor *= done ? 1 : 0.5) {
    PetscCall(VecWAXPY(w, -factor, y, x));
    PetscCall(SNESComputeFunction(snes, w, g));
    PetscCall(VecNorm(g, NORM_2, &after));
    done = std::isfinite(after) && after < before * (1 - 1e-4 * factor);
    // A first step that positivity cut short may raise the residual a little.
    if (!done && halving == 0 && factor < 1 && std::isfinite(after) && after < 1.2 * before) done = true;
  }
  if (!done) {
    PetscCall(SNESLineSearchSetReason(line, SNES_LINESEARCH_FAILED_REDUCT));
    PetscFunctionReturn(0);
  }
  PetscCall(VecCopy(w, x));
  PetscCall(VecCopy(g, f));
  PetscCall(VecNorm(x, NORM_2, &size));
  PetscCall(VecNorm(y, NORM_2, &step));
  PetscCall(SNESLineSearchSetNorms(line, size, after, factor * step));
  PetscCall(SNESLineSearchSetReason(line, SNES_LINESEARCH_SUCCEEDED));
  PetscFunctionReturn(0);
}

GasNewton::Result GasNewton::solve(const GasStep& step, Vec x, double scale, double accepted) {
  step_ = &step;
  norms_.clear();
  SILT_PETSC(
      SNESSetTolerances(snes_, least_residual_ * scale, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  Result result;
  SNESConvergedReason reason = SNES_DIVERGED_LINEAR_SOLVE;
  try {
    SILT_PETSC(SNESSolve(snes_, nullptr, x));
    SILT_PETSC(SNESGetConvergedReason(snes_, &reason));
  } catch (const PetscFailure&) {
    // A preconditioner that breaks down raises an error instead of reporting divergence.
  }
  PetscInt newton, linear;
  SILT_PETSC(SNESGetIterationNumber(snes_, &newton));
  SILT_PETSC(SNESGetLinearSolveIterations(snes_, &linear));
  result.newton = static_cast<int>(newton);
  result.linear = static_cast<int>(linear);
  const bool fell = norms_.size() > 1 && norms_.back() < accepted * norms_.front();
  const bool rest = !norms_.empty() && norms_.back() < 1e-9 * scale;
  if (reason > 0 || ((reason == SNES_DIVERGED_MAX_IT || reason == SNES_DIVERGED_LINE_SEARCH) && fell) || rest)
    return result;
  throw SolveFailure(
      fmt::format("the gas's Newton iteration failed ({}) after {} iterations, residual {:.2e} from {:.2e}",
                  SNESConvergedReasons[reason], result.newton, norms_.empty() ? 0.0 : norms_.back(),
                  norms_.empty() ? 0.0 : norms_.front()));
}

}  // namespace silt
