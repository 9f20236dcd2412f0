#pragma once
#include <memory>
#include <string>
#include <vector>

#include "fluid/assembly/flow_system.hpp"
#include "fluid/pressure_stage.hpp"

namespace silt {

/// Newton's method (SNES, option prefix `fluid_`) for the steps of a FlowSystem.
///
/// Linear solver unless options say otherwise: equal order GMRES (right) with additive Schwarz, overlap 1, ILU(1), on
/// hexahedra, whose rows are long, ILU(0), in large systems followed by a PressureStage; Taylor-Hood MUMPS in the
/// plane, in space and for large systems FGMRES with an upper Schur complement (selfp), block ILU for the velocity and
/// BoomerAMG for the pressure. Iterative solvers stop where Newton's method gains no more (Eisenstat & Walker 1996,
/// their first choice, at most 1e-2) unless `-fluid_ksp_rtol` or `-fluid_snes_ksp_ew` is given. Inexact like that,
/// Newton's method goes on with the Jacobian of its second iteration while that brings the residual down as far as the
/// linear solve allows (a step of moderate Courant number is nearly linear), unless `-fluid_snes_lag_jacobian` says
/// when to renew it; and with a PressureStage the factors serve for several steps while the iterations do not grow, and
/// the Jacobian for the first iteration of the next. When Newton fails and the system is small the step is tried once
/// more with MUMPS.
class NewtonSolver {
 public:
  /// `pressure_stage` yes, no or auto (large systems).
  explicit NewtonSolver(const FlowSystem& system, const std::string& pressure_stage = "auto");
  ~NewtonSolver();
  NewtonSolver(const NewtonSolver&) = delete;
  NewtonSolver& operator=(const NewtonSolver&) = delete;

  struct Result {
    int newton = 0, linear = 0;
  };
  /// Solves from the guess x; `scale` is the size of the terms that balance in the residual, below 1e-10 of which it
  /// counts as zero. Throws SolveFailure with the reason; x is then undefined. Collective.
  Result solve(const StepFields& fields, Vec x, double scale);
  /// Solves J(x) y = b with the Jacobian of the step at x. Throws SolveFailure. Collective.
  void linear_answer(const StepFields& fields, Vec x, Vec b, Vec y);
  /// Forgets what preconditioners keep between steps, so that a run goes on from a checkpoint with the bits of one that
  /// is restarted from it.
  void renew() {
    if (stage_) stage_->renew();
  }
  /// Residual norms of the last solve.
  const std::vector<double>& norms() const { return norms_; }
  Mat matrix() const { return matrix_; }

 private:
  void create(SNES* snes, const char* prefix, bool direct);
  SNESConvergedReason run(SNES snes, Vec x, Result& result);
  static PetscErrorCode residual(SNES, Vec x, Vec r, void* self);
  static PetscErrorCode jacobian(SNES, Vec x, Mat, Mat matrix, void* self);
  /// y = J x with rounded_, the product of GMRES inside Newton's method.
  static PetscErrorCode rounded_product(Mat, Vec x, Vec y);
  static PetscErrorCode monitor(SNES, PetscInt iteration, PetscReal norm, void* self);

  const FlowSystem& system_;
  const StepFields* fields_ = nullptr;
  MatHandle matrix_;
  MatHandle rounded_matrix_;  ///< shell of rounded_, where linear solves are inexact and the stage in single precision
  BlockProduct rounded_;
  bool rounded_fits_ = false;  ///< rounded_ holds what matrix_ does
  VecHandle residual_, start_;
  std::unique_ptr<PressureStage> stage_;  // before the solver that uses it
  SnesHandle snes_, direct_;
  PetscInt rows_ = 0;
  bool tolerance_given_ = false, linear_floor_given_ = false;
  bool may_keep_ = false;         ///< the Jacobian may serve for several iterations
  int factor_age_ = 0;            ///< solves since the factors were made
  int fresh_linear_ = 0;          ///< linear iterations of the solve that made them
  bool factors_serve_ = false;    ///< from the last solve for this one
  bool jacobian_serves_ = false;  ///< too, for the first iteration
  double linear_tolerance_ = 0;   ///< of linear_answer()
  std::vector<double> norms_;
};

}  // namespace silt
