#pragma once
#include <vector>

#include "base/nodal_matrix.hpp"
#include "base/petsc.hpp"

namespace silt {

/// The symmetric pressure equation L phi = r, solved by PETSc under the prefix `fluid_pressure_`.
///
/// Default: conjugate gradients to 1e-3 of the right side with algebraic multigrid (GAMG), whose hierarchy is kept
/// while the matrix changes slowly and renewed when the iterations exceed 1.5 times those after the last renewal. A
/// direct solver
/// (`-fluid_pressure_ksp_type preonly`) factors every new matrix.
class PressureSolver {
 public:
  /// `fixed` [nodes]: non-zero where phi is prescribed; none on any rank makes the equation singular (constants).
  PressureSolver(const NodalGraph& graph, const std::vector<int>& fixed_boundary, bool singular);

  /// Where the caller adds the cell contributions, after matrix().zero().
  NodalMatrix& matrix() { return matrix_; }
  /// Takes the matrix over: sets the rows and columns of fixed nodes aside and hands the rest to PETSc. `renew`: build
  /// the preconditioner afresh. Collective.
  void update(bool renew);
  /// Solves with phi prescribed at fixed nodes by the phi given, elsewhere the guess; right [nodes] consistent on
  /// shared nodes. Returns the iterations; throws SolveFailure. Collective.
  int solve(std::vector<double> right, std::vector<double>& phi);
  /// [nodes], non-zero at fixed nodes only: (L phi)_i with the rows set aside. Collective.
  std::vector<double> fixed_rows(const std::vector<double>& phi) const;

 private:
  void create_solver();
  bool attempt(int& iterations);
  void lift(const std::vector<double>& phi, std::vector<double>& right) const;

  const NodalGraph& graph_;
  const bool singular_;
  bool direct_ = false;
  std::vector<char> fixed_;
  NodalMatrix matrix_;
  struct Entry {
    int place, row, column;
    double value = 0;
  };
  std::vector<Entry> aside_;  ///< off-diagonal entries with a fixed row or column, and diagonal ones of fixed rows
  MatHandle petsc_;
  KspHandle ksp_;
  VecHandle right_, solution_;
  int reference_iterations_ = -1;  ///< of the first solve after the last renewal
};

}  // namespace silt
