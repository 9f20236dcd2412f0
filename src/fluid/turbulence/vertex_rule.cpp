#include "fluid/turbulence/vertex_rule.hpp"

namespace silt {

VertexRule::VertexRule(const Mesh& mesh, bool axisymmetric)
    : mesh_(mesh), axisymmetric_(axisymmetric), reference_{}, volume_(mesh.nodes, 0.0) {
  const bool simplex = mesh.cell == Cell::triangle || mesh.cell == Cell::tetrahedron;
  const int n = mesh.nodes_per_cell, dim = mesh.dimension;
  corner_weight_ = simplex ? (dim == 2 ? 1.0 / 6 : 1.0 / 24) : 1.0 / n;
  for (int v = 0; v < n; ++v) {
    double xi[3] = {}, N[8];
    for (int d = 0; d < dim; ++d) xi[d] = simplex ? v == d + 1 : v >> d & 1;
    shape(mesh.cell, xi, N, reference_[v]);
  }
  for_each_cell([&](const At& at) {
    for (int v = 0; v < n; ++v) volume_[at.node[v]] += at.weight[v];
  });
  mesh_.sum_shared(volume_.data(), 1);
}

void VertexRule::set(int cell, At& at) const {
  const int n = mesh_.nodes_per_cell;
  const bool simplex = mesh_.cell == Cell::triangle || mesh_.cell == Cell::tetrahedron;
  at.cell = cell;
  at.node = &mesh_.cell_nodes[static_cast<std::size_t>(cell) * n];
  at.x = &mesh_.cell_coordinates[3 * static_cast<std::size_t>(cell) * n];
  for (int v = 0; v < n; ++v) {
    if (simplex && v > 0) {
      at.weight[v] = at.weight[0];
      for (int a = 0; a < n; ++a) at.slope[v][a] = at.slope[0][a];
      continue;
    }
    Mat3 J = Mat3::Zero();
    for (int a = 0; a < n; ++a) J += vec3(at.x + 3 * a) * vec3(reference_[v][a]).transpose();
    if (mesh_.dimension == 2) J(2, 2) = 1;
    const Mat3 inverse = J.inverse().transpose();
    at.weight[v] = corner_weight_ * J.determinant();
    for (int a = 0; a < n; ++a) at.slope[v][a] = inverse * vec3(reference_[v][a]);
  }
  if (!axisymmetric_) return;
  double mean = 0;
  for (int a = 0; a < n; ++a) mean += at.x[3 * a + 1] / n;
  const double own = simplex ? 0.25 : 1.0 / 3;  // int N_v y / int N_v on a triangle, a rectangle
  for (int v = 0; v < n; ++v) at.weight[v] *= mean + own * (at.x[3 * v + 1] - mean);
}

void VertexRule::gradient(std::span<const double> field, int components, std::vector<double>& gradient) const {
  const int n = mesh_.nodes_per_cell, width = 3 * components;
  gradient.assign(static_cast<std::size_t>(mesh_.nodes) * width, 0.0);
  for_each_cell([&](const At& at) {
    for (int v = 0; v < n; ++v) {
      double* g = &gradient[static_cast<std::size_t>(at.node[v]) * width];
      for (int a = 0; a < n; ++a) {
        const Vec3 slope = at.weight[v] * at.slope[v][a];
        const double* f = &field[static_cast<std::size_t>(at.node[a]) * components];
        for (int k = 0; k < components; ++k)
          for (int d = 0; d < 3; ++d) g[3 * k + d] += f[k] * slope[d];
      }
    }
  });
  mesh_.sum_shared(gradient.data(), width);
  for (int i = 0; i < mesh_.nodes; ++i)
    for (int k = 0; k < width; ++k) gradient[static_cast<std::size_t>(i) * width + k] /= volume_[i];
}

}  // namespace silt
