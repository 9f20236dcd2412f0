#pragma once
#include <vector>

#include "base/nodal_matrix.hpp"
#include "fluid/boundary/boundary_conditions.hpp"

namespace silt {

/// BiCGStab with Jacobi (van der Vorst 1992) for the velocity components, which share one scalar matrix.
///
/// Fixed directions are removed from residuals and corrections (BoundaryConditions::project) instead of from the
/// matrix, so slip planes of any orientation keep the three components on one matrix.
class VelocitySolver {
 public:
  explicit VelocitySolver(const Mesh& mesh) : mesh_(mesh) {}

  /// Solves A u = b from the u given, which holds the prescribed values, to `tolerance` relative to the larger of b and
  /// the first residual, and at least to a hundredth of the first residual: b holds the whole flow, and what the step
  /// changes may be less than its tolerance. b and u [nodes][3], consistent on shared nodes. Returns the iterations;
  /// throws SolveFailure. Collective.
  int solve(const NodalMatrix& matrix, const std::vector<double>& diagonal, const BoundaryConditions& boundaries,
            const std::vector<double>& right, std::vector<double>& u, double tolerance);

 private:
  const Mesh& mesh_;
  std::vector<double> r_, shadow_, p_, v_, t_, y_;
};

}  // namespace silt
