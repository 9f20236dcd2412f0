#include "base/element.hpp"

#include <cmath>

namespace silt {
namespace {

using Facet = std::array<int, 4>;
constexpr Facet triangle_facets[3] = {{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}};
// Lexicographic nodes: 0 (0,0), 1 (1,0), 2 (0,1), 3 (1,1).
constexpr Facet quadrilateral_facets[4] = {{0, 1, -1, -1}, {1, 3, -1, -1}, {3, 2, -1, -1}, {2, 0, -1, -1}};
constexpr Facet tetrahedron_facets[4] = {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}};
constexpr Facet hexahedron_facets[6] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

struct Gauss {
  int points;
  double x[3], w[3];
};

/// Gauss-Legendre on [0,1], exact for polynomials of the given degree.
Gauss gauss(int degree) {
  if (degree <= 1) return {1, {0.5}, {1.0}};
  if (degree <= 3) {
    const double d = 0.5 / std::sqrt(3.0);
    return {2, {0.5 - d, 0.5 + d}, {0.5, 0.5}};
  }
  const double d = 0.5 * std::sqrt(0.6);
  return {3, {0.5 - d, 0.5, 0.5 + d}, {5.0 / 18, 8.0 / 18, 5.0 / 18}};
}

Quadrature tensor(int dimension, int degree) {
  const Gauss g = gauss(degree);
  Quadrature q;
  for (int k = 0; k < (dimension > 2 ? g.points : 1); ++k)
    for (int j = 0; j < (dimension > 1 ? g.points : 1); ++j)
      for (int i = 0; i < g.points; ++i) {
        q.point[q.points] = {g.x[i], dimension > 1 ? g.x[j] : 0.0, dimension > 2 ? g.x[k] : 0.0};
        q.weight[q.points++] = g.w[i] * (dimension > 1 ? g.w[j] : 1.0) * (dimension > 2 ? g.w[k] : 1.0);
      }
  return q;
}

Quadrature triangle(int degree) {
  Quadrature q;
  const auto add = [&q](double x, double y, double w) {
    q.point[q.points] = {x, y, 0};
    q.weight[q.points++] = 0.5 * w;
  };
  const auto orbit = [&add](double a, double w) {
    add(a, a, w);
    add(1 - 2 * a, a, w);
    add(a, 1 - 2 * a, w);
  };
  if (degree <= 1) {
    add(1.0 / 3, 1.0 / 3, 1);
  } else if (degree <= 2) {
    orbit(1.0 / 6, 1.0 / 3);
  } else if (degree <= 4) {  // Dunavant 1985, 6 points
    orbit(0.445948490915965, 0.223381589678011);
    orbit(0.091576213509771, 0.109951743655322);
  } else {  // Radon 1948, 7 points, in closed form
    const double s = std::sqrt(15.0);
    add(1.0 / 3, 1.0 / 3, 9.0 / 40);
    orbit((6 - s) / 21, (155 - s) / 1200);
    orbit((6 + s) / 21, (155 + s) / 1200);
  }
  return q;
}

Quadrature tetrahedron(int degree) {
  Quadrature q;
  const auto add = [&q](double x, double y, double z, double w) {
    q.point[q.points] = {x, y, z};
    q.weight[q.points++] = w / 6;
  };
  const auto vertices = [&add](double a, double w) {  // (a, a, a, 1 - 3a) and permutations
    const double b = 1 - 3 * a;
    add(a, a, a, w);
    add(b, a, a, w);
    add(a, b, a, w);
    add(a, a, b, w);
  };
  const auto edges = [&add](double a, double w) {  // (a, a, b, b) with b = 1/2 - a, and permutations
    const double b = 0.5 - a;
    add(a, a, b, w);
    add(a, b, a, w);
    add(b, a, a, w);
    add(b, b, a, w);
    add(b, a, b, w);
    add(a, b, b, w);
  };
  if (degree <= 1) {
    add(0.25, 0.25, 0.25, 1);
  } else if (degree <= 2) {
    vertices((5 - std::sqrt(5.0)) / 20, 0.25);
  } else {  // Walkington 2000, 14 points, degree 5
    vertices(0.31088591926330060980, 6 * 0.018781320953002641800);
    vertices(0.092735250310891226402, 6 * 0.012248840519393658257);
    edges(0.045503704125649649492, 6 * 0.0070910034628469110730);
  }
  return q;
}

}  // namespace

const std::array<int, 4>& facet_node_list(Cell cell, int facet) {
  switch (cell) {
    case Cell::triangle:
      return triangle_facets[facet];
    case Cell::quadrilateral:
      return quadrilateral_facets[facet];
    case Cell::tetrahedron:
      return tetrahedron_facets[facet];
    default:
      return hexahedron_facets[facet];
  }
}

std::string name(Cell cell) {
  switch (cell) {
    case Cell::triangle:
      return "triangle";
    case Cell::quadrilateral:
      return "quadrilateral";
    case Cell::tetrahedron:
      return "tetrahedron";
    default:
      return "hexahedron";
  }
}

void shape(Cell cell, const double* xi, double* N, double (*dN)[3]) {
  const int dimension = cell_dimension(cell);
  if (cell == Cell::triangle || cell == Cell::tetrahedron) {
    N[0] = 1;
    for (int d = 0; d < 3; ++d) dN[0][d] = d < dimension ? -1 : 0;
    for (int a = 1; a <= dimension; ++a) {
      N[a] = xi[a - 1];
      N[0] -= xi[a - 1];
      for (int d = 0; d < 3; ++d) dN[a][d] = d == a - 1;
    }
    return;
  }
  for (int a = 0; a < cell_nodes(cell); ++a) {
    double f[3], g[3];
    for (int d = 0; d < 3; ++d) {
      const bool high = a >> d & 1;
      f[d] = d >= dimension ? 1 : high ? xi[d] : 1 - xi[d];
      g[d] = d >= dimension ? 0 : high ? 1 : -1;
    }
    N[a] = f[0] * f[1] * f[2];
    dN[a][0] = g[0] * f[1] * f[2];
    dN[a][1] = f[0] * g[1] * f[2];
    dN[a][2] = f[0] * f[1] * g[2];
  }
}

Quadrature quadrature(Cell cell, int degree) {
  switch (cell) {
    case Cell::triangle:
      return triangle(degree);
    case Cell::quadrilateral:
      return tensor(2, degree);
    case Cell::tetrahedron:
      return tetrahedron(degree);
    default:
      return tensor(3, degree);
  }
}

Quadrature facet_quadrature(Cell cell, int degree) {
  if (cell_dimension(cell) == 2) return tensor(1, degree);
  return cell == Cell::tetrahedron ? triangle(degree) : tensor(2, degree);
}

}  // namespace silt
