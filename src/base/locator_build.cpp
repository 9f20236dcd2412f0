#include <algorithm>
#include <cmath>
#include <limits>

#include "base/facet_table.hpp"
#include "base/locator.hpp"

namespace silt {

Locator::Locator(const Mesh& mesh) : mesh_(mesh) {
  for (int d = 0; d < mesh.dimension; ++d) {
    if (!mesh.periodic[d]) continue;
    period_[d] = mesh.upper[d] - mesh.lower[d];
    periodic_ = true;
  }
  switch (mesh.cell) {
    case Cell::triangle:
      build_maps<Cell::triangle>();
      break;
    case Cell::quadrilateral:
      build_maps<Cell::quadrilateral>();
      break;
    case Cell::tetrahedron:
      build_maps<Cell::tetrahedron>();
      break;
    case Cell::hexahedron:
      build_maps<Cell::hexahedron>();
      break;
  }
  build_bins();
  if (periodic_) build_wraps();
}

template <Cell kind>
void Locator::build_maps() {
  constexpr int corners = silt::cell_nodes(kind), dimension = cell_dimension(kind);
  constexpr bool simplex = FacetTable<kind>::simplex;
  maps_.resize(mesh_.cells);
  affine_.resize(mesh_.cells);
  boxes_.resize(6 * static_cast<std::size_t>(mesh_.cells));
  const double middle[3] = {0.5, 0.5, dimension == 3 ? 0.5 : 0.0}, corner[3] = {0, 0, 0};
  double N[corners], dN[corners][3];
  shape(kind, simplex ? corner : middle, N, dN);
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* X = &mesh_.cell_coordinates[3 * static_cast<std::size_t>(corners) * c];
    Mat3 jacobian = Mat3::Zero();
    Vec3 at = Vec3::Zero();
    double* box = &boxes_[6 * static_cast<std::size_t>(c)];
    std::copy(X, X + 3, box);
    std::copy(X, X + 3, box + 3);
    for (int a = 0; a < corners; ++a) {
      at += N[a] * vec3(X + 3 * a);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < dimension; ++j) jacobian(i, j) += X[3 * a + i] * dN[a][j];
        box[i] = std::min(box[i], X[3 * a + i]);
        box[3 + i] = std::max(box[3 + i], X[3 * a + i]);
      }
    }
    if (dimension == 2) jacobian(2, 2) = 1;
    const Vec3 origin = at - jacobian * (simplex ? vec3(corner) : vec3(middle));
    Mat3 inverse = jacobian.inverse();
    if (dimension == 2) inverse.row(2).setZero();
    InverseMap& map = maps_[c];
    double size = 0;
    for (int i = 0; i < 3; ++i) {
      map.origin[i] = origin[i];
      size = std::max(size, box[3 + i] - box[i]);
      for (int j = 0; j < 3; ++j) map.inverse[i][j] = inverse(i, j);
    }
    bool affine = true;
    if constexpr (!simplex) {
      for (int a = 0; a < corners; ++a) {
        const Vec3 xi(a & 1, a >> 1 & 1, a >> 2);
        affine = affine && (inverse * (vec3(X + 3 * a) - origin) - xi).cwiseAbs().maxCoeff() < tie_tolerance;
      }
    }
    affine_[c] = affine;
    for (int i = 0; i < 3; ++i) {
      box[i] -= 1e-9 * size;
      box[3 + i] += 1e-9 * size;
    }
  }
}

void Locator::build_bins() {
  if (mesh_.cells == 0) return;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
  for (int c = 0; c < mesh_.cells; ++c) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], boxes_[6 * c + i]);
      high[i] = std::max(high[i], boxes_[6 * c + 3 + i]);
    }
  }
  double space = 1;
  for (int i = 0; i < mesh_.dimension; ++i) space *= high[i] - low[i];
  const double size = std::pow(space / mesh_.cells, 1.0 / mesh_.dimension);
  for (int i = 0; i < 3; ++i) {
    const double width = high[i] - low[i];
    bins_[i] = i < mesh_.dimension ? std::max(1, static_cast<int>(width / size)) : 1;
    bin_lower_[i] = low[i];
    bin_inverse_[i] = i < mesh_.dimension ? bins_[i] / width : 0;
  }
  const auto each_bin = [&](int c, auto&& visit) {
    int first[3], last[3];
    for (int i = 0; i < 3; ++i) {
      first[i] = std::clamp(static_cast<int>((boxes_[6 * c + i] - bin_lower_[i]) * bin_inverse_[i]), 0, bins_[i] - 1);
      last[i] =
          std::clamp(static_cast<int>((boxes_[6 * c + 3 + i] - bin_lower_[i]) * bin_inverse_[i]), 0, bins_[i] - 1);
    }
    for (int k = first[2]; k <= last[2]; ++k) {
      for (int j = first[1]; j <= last[1]; ++j) {
        for (int i = first[0]; i <= last[0]; ++i) visit((k * bins_[1] + j) * bins_[0] + i);
      }
    }
  };
  bin_start_.assign(static_cast<std::size_t>(bins_[0]) * bins_[1] * bins_[2] + 1, 0);
  for (int c = 0; c < mesh_.cells; ++c) each_bin(c, [&](int bin) { ++bin_start_[bin + 1]; });
  for (std::size_t b = 1; b < bin_start_.size(); ++b) bin_start_[b] += bin_start_[b - 1];
  bin_cells_.resize(bin_start_.back());
  std::vector<int> next(bin_start_.begin(), bin_start_.end() - 1);
  for (int c = 0; c < mesh_.cells; ++c) each_bin(c, [&](int bin) { bin_cells_[next[bin]++] = c; });
}

void Locator::build_wraps() {
  facet_wraps_.assign(static_cast<std::size_t>(mesh_.cells) * mesh_.facets_per_cell, 0);
  const int corners = facet_nodes(mesh_.cell);
  for (int c = 0; c < mesh_.cells; ++c) {
    for (int f = 0; f < mesh_.facets_per_cell; ++f) {
      const auto& nodes = facet_node_list(mesh_.cell, f);
      for (int d = 0; d < mesh_.dimension; ++d) {
        if (!mesh_.periodic[d]) continue;
        bool low = true, high = true;
        for (int k = 0; k < corners; ++k) {
          const double x =
              mesh_.cell_coordinates[3 * (static_cast<std::size_t>(c) * mesh_.nodes_per_cell + nodes[k]) + d];
          low = low && std::abs(x - mesh_.lower[d]) < 1e-6 * mesh_.smallest_edge;
          high = high && std::abs(x - mesh_.upper[d]) < 1e-6 * mesh_.smallest_edge;
        }
        signed char& wrap = facet_wraps_[static_cast<std::size_t>(c) * mesh_.facets_per_cell + f];
        if (low) wrap = static_cast<signed char>(d + 1);
        if (high) wrap = static_cast<signed char>(-(d + 1));
      }
    }
  }
}

}  // namespace silt
