#pragma once
#include <string>
#include <vector>

#include "base/nodal_matrix.hpp"
#include "fluid/transport/transport_data.hpp"

namespace silt {

/// The linear system of one implicit step of a scalar that the flow carries: P1 or Q1 at the mesh nodes, streamline
/// stabilised (docs/theory/energy.md, E2 to E4). The linear solver is BiCGStab with block Jacobi/ILU(0) unless
/// `-<prefix>ksp_...` says otherwise.
class ScalarTransport {
 public:
  /// `table_order`: 1 or 2, the quadrature (flow_table) at whose points the flux is given. Collective.
  ScalarTransport(const Mesh& mesh, const std::string& prefix, int table_order);

  /// [cells][points()][3]
  int points() const;
  /// Assembles the cell terms; table, mesh and cell sizes of `data` are set here. Collective.
  void assemble(TransportData data);
  /// After assemble(): adds to the row of a node what acts there, T coefficient and right side, consistent on shared
  /// nodes.
  void add_at_nodes(const std::vector<double>& coefficient, const std::vector<double>& right);

  /// Solves with T given at the nodes that are `fixed`; T holds those values and a guess elsewhere, consistent on
  /// shared nodes, and the solution afterwards. Returns the iterations; throws SolveFailure. Collective.
  int solve(const std::vector<char>& fixed, std::vector<double>& T);
  /// [nodes] matrix times T less the right side: at fixed nodes what has to be added to hold them. Collective.
  std::vector<double> residual(const std::vector<double>& T) const;

 private:
  const Mesh& mesh_;
  std::string prefix_;
  int order_;
  NodalGraph graph_;
  NodalMatrix matrix_, constrained_;
  TransportKernel kernel_;
  std::vector<double> cell_size_, right_;
  MatHandle petsc_;
  KspHandle ksp_;
  VecHandle unknown_, load_;
};

}  // namespace silt
