#include "fluid/turbulence/wall_layer.hpp"

#include <cmath>

namespace silt {

WallLayer::WallLayer(const Mesh& mesh, const BoundaryConditions& boundaries, const std::vector<double>& distance)
    : mesh_(mesh), kind_(mesh.nodes, interior), height_(mesh.nodes, 0.0) {
  const std::size_t n = mesh.nodes_per_cell;
  std::vector<double> touch(mesh.nodes, 0.0);
  for (const auto& facet : boundaries.facets())
    if (boundaries.type(facet.boundary) == BoundaryType::no_slip)
      for (int a = 0; a < facet.nodes; ++a) touch[facet.node[a]] = 1;
  mesh.sum_shared(touch.data(), 1);
  for (int i = 0; i < mesh.nodes; ++i)
    if (touch[i] > 0) kind_[i] = wall;
  std::fill(touch.begin(), touch.end(), 0.0);
  for (int c = 0; c < mesh.cells; ++c) {
    const int* node = &mesh.cell_nodes[n * c];
    double sum = 0;
    int walls = 0;
    for (std::size_t a = 0; a < n; ++a) kind_[node[a]] == wall ? void(++walls) : void(sum += distance[node[a]]);
    if (walls == 0) continue;
    for (std::size_t a = 0; a < n; ++a) touch[node[a]] = 1;
    if (walls < static_cast<int>(n)) cells_.push_back({c, sum / (n - walls)});
  }
  mesh.sum_shared(touch.data(), 1);
  for (int i = 0; i < mesh.nodes; ++i)
    if (touch[i] > 0 && kind_[i] == interior) kind_[i] = near;
  for (int i = 0; i < mesh.nodes; ++i)
    if (kind_[i] == near) height_[i] = distance[i];
  extend(height_);

  std::vector<double> finite = distance;
  for (double& d : finite) d = std::min(d, 1e30);
  VertexRule(mesh, false).gradient(finite, 1, normal_);
  for (int i = 0; i < mesh.nodes; ++i) {
    auto direction = vec3(&normal_[3 * static_cast<std::size_t>(i)]);
    const double length = direction.norm();
    if (length > 0) direction /= length;
  }
}

double WallLayer::mean(int cell, std::span<const double> field) const {
  const int* node = &mesh_.cell_nodes[static_cast<std::size_t>(cell) * mesh_.nodes_per_cell];
  double sum = 0;
  int count = 0;
  for (int a = 0; a < mesh_.nodes_per_cell; ++a)
    if (kind_[node[a]] == near) sum += field[node[a]], ++count;
  return sum / count;
}

void WallLayer::extend(std::vector<double>& field) const {
  std::vector<double> sums(2 * static_cast<std::size_t>(mesh_.nodes), 0.0);
  for (const auto& at : cells_) {
    const int* node = &mesh_.cell_nodes[static_cast<std::size_t>(at.cell) * mesh_.nodes_per_cell];
    const double value = mean(at.cell, field);
    for (int a = 0; a < mesh_.nodes_per_cell; ++a)
      if (kind_[node[a]] == wall) {
        sums[2 * static_cast<std::size_t>(node[a])] += value;
        sums[2 * static_cast<std::size_t>(node[a]) + 1] += 1;
      }
  }
  mesh_.sum_shared(sums.data(), 2);
  for (int i = 0; i < mesh_.nodes; ++i)
    if (kind_[i] == wall && sums[2 * static_cast<std::size_t>(i) + 1] > 0)
      field[i] = sums[2 * static_cast<std::size_t>(i)] / sums[2 * static_cast<std::size_t>(i) + 1];
}

std::vector<double> WallLayer::speed(std::span<const double> velocity) const {
  std::vector<double> sums(4 * static_cast<std::size_t>(mesh_.nodes), 0.0), result(mesh_.nodes, 0.0);
  for (const auto& at : cells_) {
    const int* node = &mesh_.cell_nodes[static_cast<std::size_t>(at.cell) * mesh_.nodes_per_cell];
    Vec3 on = Vec3::Zero();
    int walls = 0;
    for (int a = 0; a < mesh_.nodes_per_cell; ++a)
      if (kind_[node[a]] == wall) on += vec3(&velocity[3 * static_cast<std::size_t>(node[a])]), ++walls;
    for (int a = 0; a < mesh_.nodes_per_cell; ++a) {
      if (kind_[node[a]] != near) continue;
      double* s = &sums[4 * static_cast<std::size_t>(node[a])];
      for (int d = 0; d < 3; ++d) s[d] += on[d] / walls;
      s[3] += 1;
    }
  }
  mesh_.sum_shared(sums.data(), 4);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (kind_[i] != near || sums[4 * i + 3] == 0) continue;
    const Vec3 relative = vec3(&velocity[3 * i]) - vec3(&sums[4 * i]) / sums[4 * i + 3];
    const Vec3 normal = vec3(&normal_[3 * i]);
    result[i] = (relative - normal * normal.dot(relative)).norm();
  }
  extend(result);
  return result;
}

}  // namespace silt
