#pragma once
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// The graph of node pairs that share a local cell, with the place of each cell's entries: assembled once per mesh.
struct NodalGraph {
  explicit NodalGraph(const Mesh& mesh);
  const Mesh& mesh;
  std::vector<int> row_start;   ///< [nodes + 1]
  std::vector<int> column;      ///< [row_start[nodes]] local nodes, sorted within a row
  std::vector<int> diagonal;    ///< [nodes] place of the diagonal entry
  std::vector<int> cell_entry;  ///< [cells][nodes_per_cell][nodes_per_cell] place of a cell matrix entry
};

/// A scalar matrix over the mesh nodes, kept as this rank's cells contributed it (sub-assembled): the true matrix is
/// the sum over ranks. Cell loops add straight into `values` through NodalGraph::cell_entry; apply() sums shared rows
/// once.
class NodalMatrix {
 public:
  explicit NodalMatrix(const NodalGraph& nodes) : graph(nodes), values(nodes.column.size(), 0.0) {}
  const NodalGraph& graph;
  std::vector<double> values;

  void zero();
  /// y = A x for `components` interlaced vectors at once (1 to 4 unrolled); x consistent on shared nodes, y too.
  /// Collective.
  void apply(const double* x, double* y, int components) const;
  /// The diagonal, summed over ranks. Collective.
  std::vector<double> diagonal() const;
  /// A new PETSc AIJ matrix (rows = owned nodes, global numbering = Mesh::node_global), prepared for fill_petsc.
  MatHandle create_petsc() const;
  /// Sets the PETSc matrix to this one. Collective.
  void fill_petsc(Mat matrix) const;
};

/// Row sums of the mass matrix: the volume that belongs to each node, summed over ranks. [nodes] m3.
std::vector<double> lumped_mass(const Mesh& mesh);
/// Shortest edge of each local cell, m.
std::vector<double> shortest_edges(const Mesh& mesh);
/// Adds the stiffness matrix int grad N_a . grad N_b to `matrix`.
void add_stiffness(NodalMatrix& matrix, double factor = 1);

}  // namespace silt
