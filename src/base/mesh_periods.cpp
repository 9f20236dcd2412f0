#include "base/mesh_periods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/mesh.hpp"

namespace silt {
namespace {

void refuse(bool other_sides, const std::string& file) {
  if (other_sides)
    throw UserError(fmt::format(
        "option -mesh_file: the periodic sides of '{}' must be the whole opposite ends of the mesh along x, y or z",
        file));
}

}  // namespace

void find_periods(Mesh& mesh, const std::string& file) {
  std::vector<double> place = mesh.node_coordinates;
  mesh.copy_from_owner(place.data(), 3);
  const double slack = 1e-6 * mesh.smallest_edge;
  double widest[3] = {0, 0, 0};
  bool found[3] = {false, false, false}, elsewhere = false;
  for (int c = 0; c < mesh.cells; ++c)
    for (int d = 0; d < mesh.dimension; ++d) {
      double low = infinity, high = -infinity;
      for (int a = 0; a < mesh.nodes_per_cell; ++a) {
        const size_t corner = static_cast<size_t>(c) * mesh.nodes_per_cell + a;
        const double x = mesh.cell_coordinates[3 * corner + d];
        const double apart = std::abs(x - place[3 * static_cast<size_t>(mesh.cell_nodes[corner]) + d]);
        if (apart > slack) (std::abs(apart - (mesh.upper[d] - mesh.lower[d])) < slack ? found[d] : elsewhere) = true;
        low = std::min(low, x), high = std::max(high, x);
      }
      widest[d] = std::max(widest[d], high - low);
    }
  for (int d = 0; d < mesh.dimension; ++d) mesh.periodic[d] = mpi_any(found[d]);
  refuse(mpi_any(elsewhere), file);
  for (int d = 0; d < mesh.dimension; ++d) {
    if (mesh.periodic[d] && mpi_max(widest[d]) > 0.5 * (mesh.upper[d] - mesh.lower[d]) - slack)
      throw UserError(
          fmt::format("option -mesh_file: '{}' is periodic along {}, where it needs at least 3 cells", file, "xyz"[d]));
  }
}

void check_periodic_ends(const Mesh& mesh, const std::string& file) {
  const double slack = 1e-6 * mesh.smallest_edge;
  bool elsewhere = false;
  for (const auto& facet : mesh.facets) {
    const auto corners = mesh.facet_corners(facet);
    for (int d = 0; d < mesh.dimension; ++d)
      for (const double end : {mesh.lower[d], mesh.upper[d]})
        elsewhere =
            elsewhere || (mesh.periodic[d] && std::all_of(corners.begin(), corners.begin() + facet_nodes(mesh.cell),
                                                          [&](const Vec3& x) { return std::abs(x[d] - end) < slack; }));
  }
  refuse(mpi_any(elsewhere), file);
}

}  // namespace silt
