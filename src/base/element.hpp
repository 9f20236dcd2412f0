#pragma once
#include <array>
#include <string>

namespace silt {

/// The four cells a mesh may consist of (one kind a mesh). Node order: simplices as vertices of the unit simplex;
/// tensor cells lexicographic, node a at bits (x = a & 1, y = a >> 1 & 1, z = a >> 2) of the reference square or cube
/// [0,1]^d.
enum class Cell { triangle, quadrilateral, tetrahedron, hexahedron };

constexpr int cell_dimension(Cell cell) { return cell == Cell::triangle || cell == Cell::quadrilateral ? 2 : 3; }
constexpr int cell_nodes(Cell cell) { return cell == Cell::triangle ? 3 : cell == Cell::hexahedron ? 8 : 4; }
constexpr int cell_facets(Cell cell) { return cell == Cell::triangle ? 3 : cell == Cell::hexahedron ? 6 : 4; }
constexpr int facet_nodes(Cell cell) { return cell_dimension(cell) == 2 ? 2 : cell == Cell::tetrahedron ? 3 : 4; }

/// Local nodes of facet f of a cell, ordered so that the normal (right-hand rule; in 2D the tangent turned right)
/// points out. Quadrilateral facets are ordered around. Unused entries are -1.
const std::array<int, 4>& facet_node_list(Cell cell, int facet);

std::string name(Cell cell);

/// Linear (P1) or multilinear (Q1) shape functions and their reference gradients at xi; N has cell_nodes, dN 3 per
/// node.
void shape(Cell cell, const double* xi, double* N, double (*dN)[3]);

/// A quadrature rule on the reference cell; weights sum to its volume (1/2, 1, 1/6, 1).
struct Quadrature {
  int points = 0;
  std::array<std::array<double, 3>, 27> point{};
  std::array<double, 27> weight{};
};
/// Rule exact for polynomials of the given degree (a coordinate, on tensor cells): 1 to 5.
Quadrature quadrature(Cell cell, int degree);
/// Same on the reference facet (segment [0,1], unit triangle, unit square), as used with facet shape functions.
Quadrature facet_quadrature(Cell cell, int degree);

}  // namespace silt
