#pragma once
#include <vector>

#include "fluid/compressible/gas_system.hpp"

namespace silt {

/// Newton's method (SNES, prefix `fluid_`) for a step of the compressible equations: exact Jacobian, GMRES with
/// additive Schwarz and ILU(1). The step is shortened so that pressure and temperature fall by at most half and rise to
/// at most three times their value, then halved until the residual falls.
class GasNewton {
 public:
  explicit GasNewton(const GasSystem& system);
  GasNewton(const GasNewton&) = delete;
  GasNewton& operator=(const GasNewton&) = delete;

  static constexpr int most_iterations = 12;
  struct Result {
    int newton = 0, linear = 0;
  };
  /// Solves from the guess x; `scale` is the size of the terms that balance, below 1e-11 of which the residual counts
  /// as zero. A step that has not met the tolerance after the last iteration is accepted when its residual fell by the
  /// factor `accepted`; throws SolveFailure otherwise. Collective.
  Result solve(const GasStep& step, Vec x, double scale, double accepted);
  /// Residual norms of the last solve.
  const std::vector<double>& norms() const { return norms_; }

 private:
  static PetscErrorCode residual(SNES, Vec x, Vec r, void* self);
  static PetscErrorCode jacobian(SNES, Vec x, Mat, Mat matrix, void* self);
  static PetscErrorCode monitor(SNES, PetscInt iteration, PetscReal norm, void* self);
  static PetscErrorCode search(SNESLineSearch search, void* self);
  /// Largest factor of the update that keeps pressure and temperature in bounds. Collective.
  PetscErrorCode bounded(Vec x, Vec update, double& factor) const;

  const GasSystem& system_;
  const GasStep* step_ = nullptr;
  MatHandle matrix_;
  VecHandle residual_;
  SnesHandle snes_;
  /// Norm at which a residual counts as nothing but rounding, over that of the terms; `-fluid_snes_atol`.
  double least_residual_ = 1e-11;
  std::vector<double> norms_;
};

}  // namespace silt
