#include "fluid/space/quadratic_element.hpp"

#include <cmath>

namespace silt {
namespace {

using Parents = std::vector<std::vector<int>>;

Parents simplex_parents(int vertices) {
  Parents result;
  for (int a = 0; a < vertices; ++a) result.push_back({a});
  for (int a = 0; a < vertices; ++a)
    for (int b = a + 1; b < vertices; ++b) result.push_back({a, b});
  return result;
}

/// Lattice places (0, 1, 2 in each direction) of the nodes of a tensor element: vertices first.
std::vector<std::array<int, 3>> tensor_places(int dimension) {
  std::vector<std::array<int, 3>> result;
  result.reserve(dimension > 2 ? 27 : 9);
  for (int a = 0; a < 1 << dimension; ++a) result.push_back({2 * (a & 1), 2 * (a >> 1 & 1), 2 * (a >> 2)});
  for (int k = 0; k < (dimension > 2 ? 3 : 1); ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i)
        if (i == 1 || j == 1 || k == 1) result.push_back({i, j, k});
  return result;
}
const std::vector<std::array<int, 3>>& places(int dimension) {
  static const auto square = tensor_places(2), cube = tensor_places(3);
  return dimension == 2 ? square : cube;
}

Parents tensor_parents(int dimension) {
  Parents result;
  for (const auto& place : places(dimension)) {
    std::vector<int> parents;
    for (int a = 0; a < 1 << dimension; ++a) {
      bool near = true;
      for (int d = 0; d < dimension; ++d) near = near && (place[d] == 1 || place[d] == 2 * (a >> d & 1));
      if (near) parents.push_back(a);
    }
    result.push_back(parents);
  }
  return result;
}

bool simplex(Cell cell) { return cell == Cell::triangle || cell == Cell::tetrahedron; }

const Parents& parents_of(Cell cell) {
  static const Parents triangle = simplex_parents(3), tetrahedron = simplex_parents(4), square = tensor_parents(2),
                       cube = tensor_parents(3);
  switch (cell) {
    case Cell::triangle:
      return triangle;
    case Cell::tetrahedron:
      return tetrahedron;
    case Cell::quadrilateral:
      return square;
    default:
      return cube;
  }
}

}  // namespace

int quadratic_nodes(Cell cell) { return static_cast<int>(parents_of(cell).size()); }
const std::vector<int>& quadratic_parents(Cell cell, int node) { return parents_of(cell)[node]; }

void quadratic_shape(Cell cell, const double* xi, double* N, double (*dN)[3]) {
  if (simplex(cell)) {
    double L[8], dL[8][3];
    shape(cell, xi, L, dL);
    const auto& parents = parents_of(cell);
    for (size_t n = 0; n < parents.size(); ++n) {
      const int a = parents[n][0], b = parents[n].back();
      const bool vertex = parents[n].size() == 1;
      N[n] = vertex ? L[a] * (2 * L[a] - 1) : 4 * L[a] * L[b];
      for (int d = 0; d < 3; ++d)
        dN[n][d] = vertex ? (4 * L[a] - 1) * dL[a][d] : 4 * (L[a] * dL[b][d] + L[b] * dL[a][d]);
    }
    return;
  }
  const int dimension = cell_dimension(cell);
  double f[3][3], g[3][3];
  for (int d = 0; d < 3; ++d) {
    const double x = d < dimension ? xi[d] : 0;
    const double values[3] = {(1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1)};
    const double slopes[3] = {4 * x - 3, 4 - 8 * x, 4 * x - 1};
    for (int i = 0; i < 3; ++i) {
      f[d][i] = d < dimension ? values[i] : 1;
      g[d][i] = d < dimension ? slopes[i] : 0;
    }
  }
  const auto& lattice = places(dimension);
  for (size_t n = 0; n < lattice.size(); ++n) {
    const auto [i, j, k] = lattice[n];
    N[n] = f[0][i] * f[1][j] * f[2][k];
    dN[n][0] = g[0][i] * f[1][j] * f[2][k];
    dN[n][1] = f[0][i] * g[1][j] * f[2][k];
    dN[n][2] = f[0][i] * f[1][j] * g[2][k];
  }
}

}  // namespace silt
