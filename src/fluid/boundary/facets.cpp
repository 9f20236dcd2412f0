#include "fluid/boundary/facets.hpp"

#include "base/element.hpp"

namespace silt {
namespace {

/// Linear (2 or 3 nodes) or bilinear (4, ordered around) shape functions and their derivatives on the reference facet.
void facet_shape(int nodes, const double* xi, std::array<double, 4>& N, double (&dN)[4][2]) {
  const double x = xi[0], y = xi[1];
  if (nodes == 2) {
    N = {1 - x, x, 0, 0};
    dN[0][0] = -1, dN[1][0] = 1;
  } else if (nodes == 3) {
    N = {1 - x - y, x, y, 0};
    dN[0][0] = dN[0][1] = -1, dN[1][0] = 1, dN[1][1] = 0, dN[2][0] = 0, dN[2][1] = 1;
  } else {
    N = {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
    dN[0][0] = y - 1, dN[0][1] = x - 1, dN[1][0] = 1 - y, dN[1][1] = -x;
    dN[2][0] = y, dN[2][1] = x, dN[3][0] = -y, dN[3][1] = 1 - x;
  }
}

}  // namespace

std::vector<FacetRule> facet_rules(const Mesh& mesh) {
  const int count = facet_nodes(mesh.cell);
  const auto rule = facet_quadrature(mesh.cell, mesh.cell == Cell::tetrahedron ? 4 : 3);
  std::vector<FacetRule> result;
  result.reserve(mesh.facets.size());
  for (const auto& facet : mesh.facets) {
    FacetRule f;
    f.boundary = facet.boundary, f.cell = facet.cell, f.nodes = count, f.points = rule.points;
    const auto& local = facet_node_list(mesh.cell, facet.facet);
    for (int a = 0; a < count; a++) f.node[a] = mesh.cell_nodes[facet.cell * mesh.nodes_per_cell + local[a]];
    const auto corners = mesh.facet_corners(facet);
    for (int q = 0; q < rule.points; q++) {
      auto& point = f.point[q];
      double dN[4][2] = {};
      facet_shape(count, rule.point[q].data(), point.shape, dN);
      Vec3 tangent[2] = {Vec3::Zero(), Vec3::Zero()};
      point.x.setZero();
      for (int a = 0; a < count; a++) {
        point.x += point.shape[a] * corners[a];
        for (int d = 0; d < 2; d++) tangent[d] += dN[a][d] * corners[a];
      }
      // In 2D the outward normal is the tangent turned right.
      const Vec3 normal = count == 2 ? Vec3(tangent[0].y(), -tangent[0].x(), 0) : Vec3(tangent[0].cross(tangent[1]));
      point.area = rule.weight[q] * normal;
    }
    result.push_back(f);
  }
  return result;
}

}  // namespace silt
