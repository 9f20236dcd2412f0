#pragma once
#include <string>
#include <vector>

#include "fluid/transport/scalar_system.hpp"
#include "fluid/transport/transport_data.hpp"

namespace silt {

/// The linear system of one implicit step of a scalar that the flow carries: P1 or Q1 at the mesh nodes, streamline
/// stabilised (docs/theory/energy.md, E2 to E4).
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

  /// As ScalarSystem. Collective.
  int solve(const std::vector<char>& fixed, std::vector<double>& T) { return system_.solve(fixed, T); }
  std::vector<double> residual(const std::vector<double>& T) const { return system_.residual(T); }

 private:
  const Mesh& mesh_;
  int order_;
  NodalGraph graph_;
  ScalarSystem system_;
  TransportKernel kernel_;
  std::vector<double> cell_size_;
};

}  // namespace silt
