#include "fluid/newton_solver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/solver_defaults.hpp"

namespace silt {
namespace {

/// Largest system that the direct solver may rescue.
constexpr PetscInt direct_rows = 120000;
/// Largest plane Taylor-Hood system solved directly from the start: a sparse factor in the plane is cheap, and the
/// Schur complement converges slowly in steady flow.
constexpr PetscInt plane_rows = 200000;
/// Smallest equal-order system to which a multigrid cycle for the pressure is worth its while.
constexpr PetscInt stage_rows = 50000;

/// Loosest relative tolerance of a linear solve inside Newton's method.
constexpr double loosest = 1e-2;
/// A Jacobian stays, and factors serve for a new one, when the last iteration left at most this share of the residual.
constexpr double kept = 2 * loosest;
/// A step begins with the Jacobian of the last one while the first iteration leaves at most this share: to make another
/// takes as long as ten linear iterations, which bring more than it would.
constexpr double served = 5 * loosest;
/// Solves after which factors are made anew, and the growth of the linear iterations that tells of too old ones.
constexpr int longest_factor_age = 10;
constexpr double most_growth = 1.3;

}  // namespace

NewtonSolver::NewtonSolver(const FlowSystem& system, const std::string& pressure_stage)
    : system_(system), matrix_(system.create_matrix()) {
  residual_ = system.create_vector();
  start_ = system.create_vector();
  SILT_PETSC(VecGetSize(start_, &rows_));
  tolerance_given_ = solver_option_given("-fluid_snes_atol");
  linear_floor_given_ = solver_option_given("-fluid_ksp_atol");
  if (system.equal_order() && (pressure_stage == "yes" || (pressure_stage == "auto" && rows_ >= stage_rows)))
    stage_ = std::make_unique<PressureStage>(system);
  create(snes_.out(), "fluid_", false);
}

NewtonSolver::~NewtonSolver() = default;

void NewtonSolver::create(SNES* snes, const char* prefix, bool direct) {
  SILT_PETSC(SNESCreate(PETSC_COMM_WORLD, snes));
  SILT_PETSC(SNESSetOptionsPrefix(*snes, prefix));
  SILT_PETSC(SNESSetFunction(*snes, residual_, residual, this));
  SILT_PETSC(SNESSetJacobian(*snes, matrix_, matrix_, jacobian, this));
  SILT_PETSC(SNESMonitorSet(*snes, monitor, this, nullptr));
  SILT_PETSC(SNESSetTolerances(*snes, PETSC_DEFAULT, 1e-8, 0, 30, 10000));
  KSP ksp;
  PC pc;
  SILT_PETSC(SNESGetKSP(*snes, &ksp));
  SILT_PETSC(KSPGetPC(ksp, &pc));
  const std::string options = std::string("-") + prefix;
  const bool plane = system_.space().mesh.dimension == 2;
  if (direct || (plane && !system_.equal_order() && rows_ <= plane_rows)) {
    SILT_PETSC(KSPSetType(ksp, KSPPREONLY));
    SILT_PETSC(PCSetType(pc, PCLU));
  } else if (system_.equal_order()) {
    SILT_PETSC(KSPSetType(ksp, KSPGMRES));
    SILT_PETSC(KSPSetPCSide(ksp, PC_RIGHT));
    SILT_PETSC(PCSetType(pc, stage_ ? PCSHELL : PCASM));
    default_solver_option(options + "sub_pc_type", "ilu");
    default_solver_option(options + "sub_pc_factor_levels", std::to_string(fill_levels(system_.space().mesh.cell)));
    if (stage_) stage_->attach(pc, prefix);
  } else {
    SILT_PETSC(KSPSetType(ksp, KSPFGMRES));
    SILT_PETSC(PCSetType(pc, PCFIELDSPLIT));
    SILT_PETSC(PCFieldSplitSetType(pc, PC_COMPOSITE_SCHUR));
    SILT_PETSC(PCFieldSplitSetSchurFactType(pc, PC_FIELDSPLIT_SCHUR_FACT_UPPER));
    SILT_PETSC(PCFieldSplitSetSchurPre(pc, PC_FIELDSPLIT_SCHUR_PRE_SELFP, nullptr));
    SILT_PETSC(PCFieldSplitSetIS(pc, "velocity", system_.velocity_rows()));
    SILT_PETSC(PCFieldSplitSetIS(pc, "pressure", system_.pressure_rows()));
    default_solver_option(options + "fieldsplit_velocity_ksp_type", "preonly");
    default_solver_option(options + "fieldsplit_velocity_pc_type", "bjacobi");
    default_solver_option(options + "fieldsplit_pressure_ksp_type", "preonly");
    default_solver_option(options + "fieldsplit_pressure_pc_type", "hypre");
  }
  SILT_PETSC(KSPGMRESSetRestart(ksp, 100));
  SILT_PETSC(KSPSetTolerances(ksp, 1e-4, PETSC_DEFAULT, PETSC_DEFAULT, 400));
  SILT_PETSC(SNESSetFromOptions(*snes));
  SILT_PETSC(KSPGetTolerances(ksp, &linear_tolerance_, nullptr, nullptr, nullptr));
  PetscBool exact = PETSC_FALSE;
  SILT_PETSC(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(ksp), KSPPREONLY, &exact));
  if (!exact && !solver_option_given(options + "ksp_rtol") && !solver_option_given(options + "snes_ksp_ew")) {
    may_keep_ = !solver_option_given(options + "snes_lag_jacobian");
    SILT_PETSC(SNESKSPSetUseEW(*snes, PETSC_TRUE));
    SILT_PETSC(
        SNESKSPSetParametersEW(*snes, 1, loosest, loosest, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  }
  PCType type;
  SILT_PETSC(PCGetType(pc, &type));
  if (!direct && may_keep_ && stage_ && stage_->single_precision() && std::string(type) == PCSHELL) {
    PetscInt own;
    SILT_PETSC(VecGetLocalSize(start_, &own));
    SILT_PETSC(MatCreateShell(PETSC_COMM_WORLD, own, own, rows_, rows_, this, rounded_matrix_.out()));
    SILT_PETSC(MatShellSetOperation(rounded_matrix_, MATOP_MULT, reinterpret_cast<void (*)()>(rounded_product)));
    SILT_PETSC(SNESSetJacobian(*snes, rounded_matrix_, matrix_, jacobian, this));
  }
  if (std::string(type) == PCLU && !solver_option_given(options + "pc_factor_mat_solver_type")) {
    SILT_PETSC(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
    // PETSc's own ordering, handed over by default, makes fronts many times larger than MUMPS's.
    if (!solver_option_given(options + "pc_factor_mat_ordering_type"))
      SILT_PETSC(PCFactorSetMatOrderingType(pc, MATORDERINGEXTERNAL));
    // A closed domain leaves one zero pivot; more room than estimated avoids a second factorisation.
    default_solver_option(options + "mat_mumps_icntl_24", "1");
    default_solver_option(options + "mat_mumps_icntl_14", "60");
  }
}

PetscErrorCode NewtonSolver::residual(SNES, Vec x, Vec r, void* self) {
  PetscFunctionBeginUser;
  const auto& solver = *static_cast<NewtonSolver*>(self);
  PetscCall(solver.system_.residual(*solver.fields_, x, r));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonSolver::jacobian(SNES snes, Vec x, Mat, Mat matrix, void* self) {
  PetscFunctionBeginUser;
  auto& solver = *static_cast<NewtonSolver*>(self);
  const auto& norms = solver.norms_;
  const bool first = norms.size() < 2, own = snes == solver.snes_;
  const bool close = !first && norms.back() <= kept * norms[norms.size() - 2];
  if (solver.stage_ && own) solver.stage_->keep_factors(first ? solver.factors_serve_ : close);
  // The second Jacobian is the first that is made near the solution; it also begins the next step.
  const bool stays = first ? solver.factors_serve_ && solver.jacobian_serves_ : close && norms.size() > 2;
  if (!(solver.may_keep_ && own && stays)) {
    PetscCall(solver.system_.jacobian(*solver.fields_, x, matrix));
    solver.rounded_fits_ = own && solver.rounded_matrix_ && solver.rounded_.copy(matrix);
  }
  if (!solver.norms_.empty() && !solver.linear_floor_given_) {
    // A linear residual well below what ends Newton's method is lost labour.
    PetscReal absolute, relative;
    PetscCall(SNESGetTolerances(snes, &absolute, &relative, nullptr, nullptr, nullptr));
    KSP ksp;
    PetscCall(SNESGetKSP(snes, &ksp));
    PetscCall(KSPSetTolerances(ksp, PETSC_DEFAULT, 0.3 * std::max(absolute, relative * solver.norms_.front()),
                               PETSC_DEFAULT, PETSC_DEFAULT));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonSolver::rounded_product(Mat shell, Vec x, Vec y) {
  PetscFunctionBeginUser;
  NewtonSolver* solver;
  PetscCall(MatShellGetContext(shell, static_cast<void*>(&solver)));
  if (!solver->rounded_fits_) {
    PetscCall(MatMult(solver->matrix_, x, y));
    PetscFunctionReturn(0);
  }
  const double* from;
  double* to;
  PetscCall(VecGetArrayRead(x, &from));
  PetscCall(VecGetArrayWrite(y, &to));
  solver->rounded_.multiply(from, to);
  PetscCall(VecRestoreArrayWrite(y, &to));
  PetscCall(VecRestoreArrayRead(x, &from));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonSolver::monitor(SNES, PetscInt, PetscReal norm, void* self) {
  static_cast<NewtonSolver*>(self)->norms_.push_back(norm);
  return 0;
}

SNESConvergedReason NewtonSolver::run(SNES snes, Vec x, Result& result) {
  norms_.clear();
  try {
    SILT_PETSC(SNESSolve(snes, nullptr, x));
  } catch (const PetscFailure&) {
    // A preconditioner that breaks down raises an error instead of reporting divergence.
    return SNES_DIVERGED_LINEAR_SOLVE;
  }
  SNESConvergedReason reason;
  PetscInt newton, linear;
  SILT_PETSC(SNESGetConvergedReason(snes, &reason));
  SILT_PETSC(SNESGetIterationNumber(snes, &newton));
  SILT_PETSC(SNESGetLinearSolveIterations(snes, &linear));
  result.newton += static_cast<int>(newton);
  result.linear += static_cast<int>(linear);
  return reason;
}

void NewtonSolver::linear_answer(const StepFields& fields, Vec x, Vec b, Vec y) {
  fields_ = &fields;
  if (stage_) {
    stage_->prepare(fields);
    stage_->keep_factors(false);
  }
  SILT_PETSC(system_.jacobian(fields, x, matrix_));
  rounded_fits_ = false;
  KSP ksp;
  SILT_PETSC(SNESGetKSP(snes_, &ksp));
  SILT_PETSC(KSPSetOperators(ksp, matrix_, matrix_));
  // Newton's method leaves its own tolerance behind.
  SILT_PETSC(KSPSetTolerances(ksp, linear_tolerance_, 1e-50, PETSC_DEFAULT, PETSC_DEFAULT));
  KSPConvergedReason reason;
  SILT_PETSC(KSPSolve(ksp, b, y));
  SILT_PETSC(KSPGetConvergedReason(ksp, &reason));
  if (reason < 0)
    throw SolveFailure(fmt::format("the flow's linear equations were not solved ({})", KSPConvergedReasons[reason]));
}

NewtonSolver::Result NewtonSolver::solve(const StepFields& fields, Vec x, double scale) {
  fields_ = &fields;
  if (stage_) stage_->prepare(fields);
  scale = std::max(scale, 1e-290);  // a fluid at rest has converged
  Result result;
  SILT_PETSC(VecCopy(x, start_));
  if (!tolerance_given_)
    SILT_PETSC(SNESSetTolerances(snes_, 1e-10 * scale, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  factors_serve_ = stage_ && stage_->factored() && factor_age_ < longest_factor_age;
  SNESConvergedReason reason = run(snes_, x, result);
  if (reason <= 0 && factors_serve_) {
    stage_->renew();
    stage_->prepare(fields);
    factors_serve_ = false;
    SILT_PETSC(VecCopy(start_, x));
    reason = run(snes_, x, result);
  }
  jacobian_serves_ = !factors_serve_ || (jacobian_serves_ && norms_.size() > 1 && norms_[1] <= served * norms_[0]);
  if (!factors_serve_) factor_age_ = 0, fresh_linear_ = result.linear;
  ++factor_age_;
  if (result.linear > most_growth * fresh_linear_ + 3) factor_age_ = longest_factor_age;
  if (reason > 0) return result;
  if (rows_ <= direct_rows) {
    if (!direct_) create(direct_.out(), "fluid_direct_", true);
    SILT_PETSC(SNESSetTolerances(direct_, 1e-10 * scale, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
    SILT_PETSC(VecCopy(start_, x));
    if (run(direct_, x, result) > 0) return result;
  }
  throw SolveFailure(
      fmt::format("the flow's Newton iteration failed ({}) after {} iterations, residual {:.2e} from {:.2e}",
                  SNESConvergedReasons[reason], result.newton, norms_.empty() ? 0.0 : norms_.back(),
                  norms_.empty() ? 0.0 : norms_.front()));
}

}  // namespace silt
