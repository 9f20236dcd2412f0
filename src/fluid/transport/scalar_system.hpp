#pragma once
#include <string>
#include <vector>

#include "base/nodal_matrix.hpp"

namespace silt {

/// A linear system for one scalar at the mesh nodes: assembled by cells, solved by BiCGStab with block Jacobi/ILU(0)
/// unless `-<prefix>ksp_...` says otherwise.
class ScalarSystem {
 public:
  ScalarSystem(const NodalGraph& graph, const std::string& prefix);

  NodalMatrix& matrix() { return matrix_; }
  /// [nodes]; consistent on shared nodes when the system is solved.
  std::vector<double>& right() { return right_; }
  void zero();

  /// Solves with T given at the nodes that are `fixed`; T holds those values and a guess elsewhere, consistent on
  /// shared nodes, and the solution afterwards. Returns the iterations; throws SolveFailure. Collective.
  int solve(const std::vector<char>& fixed, std::vector<double>& T);
  /// [nodes] matrix times T less the right side: at fixed nodes what has to be added to hold them. Collective.
  std::vector<double> residual(const std::vector<double>& T) const;

 private:
  const NodalGraph& graph_;
  const Mesh& mesh_;
  std::string prefix_;
  NodalMatrix matrix_, constrained_;
  std::vector<double> right_;
  MatHandle petsc_;
  KspHandle ksp_;
  VecHandle unknown_, load_;
};

}  // namespace silt
