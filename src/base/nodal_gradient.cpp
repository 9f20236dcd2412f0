#include "base/nodal_gradient.hpp"

namespace silt {

NodalGradient::NodalGradient(const Mesh& mesh, const std::vector<double>& mass) : mesh_(mesh), mass_(mass) {}

void NodalGradient::apply(std::span<const double> field, int components, std::vector<double>& gradient) const {
  const int n = mesh_.nodes_per_cell, width = 3 * components;
  gradient.assign(static_cast<std::size_t>(mesh_.nodes) * width, 0.0);
  const Quadrature rule = quadrature(mesh_.cell, 3);
  double N[27][8], dN[27][8][3];
  for (int q = 0; q < rule.points; ++q) shape(mesh_.cell, rule.point[q].data(), N[q], dN[q]);
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * static_cast<std::size_t>(c) * n];
    const int* node = &mesh_.cell_nodes[static_cast<std::size_t>(c) * n];
    for (int q = 0; q < rule.points; ++q) {
      Mat3 J = Mat3::Zero();
      for (int a = 0; a < n; ++a) J += vec3(x + 3 * a) * vec3(dN[q][a]).transpose();
      if (mesh_.dimension == 2) J(2, 2) = 1;
      const Mat3 inverse = J.inverse().transpose();
      const double weight = rule.weight[q] * J.determinant();
      double local[27] = {};
      for (int a = 0; a < n; ++a) {
        const Vec3 slope = inverse * vec3(dN[q][a]);
        const double* f = &field[static_cast<std::size_t>(node[a]) * components];
        for (int k = 0; k < components; ++k)
          for (int d = 0; d < 3; ++d) local[3 * k + d] += f[k] * slope[d];
      }
      for (int a = 0; a < n; ++a) {
        double* g = &gradient[static_cast<std::size_t>(node[a]) * width];
        for (int k = 0; k < width; ++k) g[k] += weight * N[q][a] * local[k];
      }
    }
  }
  mesh_.sum_shared(gradient.data(), width);
  for (int i = 0; i < mesh_.nodes; ++i)
    for (int k = 0; k < width; ++k) gradient[static_cast<std::size_t>(i) * width + k] /= mass_[i];
}

}  // namespace silt
