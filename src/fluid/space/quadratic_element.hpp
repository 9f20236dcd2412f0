#pragma once
#include <vector>

#include "base/element.hpp"

namespace silt {

/// Quadratic Lagrange elements (P2, Q2) on the cells of the mesh. Nodes: the vertices in the mesh's order, then the
/// middles of edges, of quadrilateral faces and of tensor cells. Each node is the mean of some vertices, its parents;
/// the parents name the node across cells and ranks.
int quadratic_nodes(Cell cell);
/// Local vertices whose mean is node a: 1 (vertex), 2 (edge), 4 (face), 4 or 8 (cell).
const std::vector<int>& quadratic_parents(Cell cell, int node);
/// Shape functions N[quadratic_nodes] and reference gradients at xi.
void quadratic_shape(Cell cell, const double* xi, double* N, double (*dN)[3]);

}  // namespace silt
