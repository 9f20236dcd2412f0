#pragma once
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// Continuous Lagrange functions of order 1 (P1, Q1) or 2 (P2, Q2) on a mesh, numbered over all ranks.
///
/// Local nodes 0..mesh.nodes-1 are the vertices in the mesh's numbering; order 2 adds the middles of edges, faces and
/// cells. A middle is known across ranks by the global numbers of its parents (the vertices it is the mean of) and
/// belongs to the lowest rank that has it. Globally every rank's own nodes are consecutive, vertices first.
class LagrangeSpace {
 public:
  /// Collective. `order` is 1 or 2.
  LagrangeSpace(const Mesh& mesh, int order);

  const Mesh& mesh;
  const int order;
  int nodes_per_cell = 0;
  int nodes = 0, owned_nodes = 0;
  std::vector<int> cell_nodes;             ///< [cells][nodes_per_cell]
  std::vector<char> owned;                 ///< [nodes]
  std::vector<PetscInt> node_global;       ///< [nodes]
  std::vector<double> node_coordinates;    ///< [nodes][3] m, one of the places of a periodic node
  std::vector<int> parent_start, parents;  ///< parents of node i: parents[parent_start[i]..parent_start[i+1]-1]

  /// Values of the vertex field (order 1) at all nodes: [mesh.nodes][components] -> [nodes][components].
  void interpolate(const double* vertices, double* values, int components) const;
  /// Adds up the contributions of all ranks to shared nodes; every rank then holds the sum. Collective.
  void sum_shared(double* values, int components) const;

 private:
  void add_middles();
  void number_globally();
  std::vector<int> rank_of_;  ///< [nodes] owner
  SfHandle exchange_;
};

}  // namespace silt
