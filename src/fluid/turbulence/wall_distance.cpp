#include "fluid/turbulence/wall_distance.hpp"

#include <algorithm>

#include "fluid/turbulence/facet_tree.hpp"

namespace silt {
namespace {

/// [facets][9] corners of the walls' segments and triangles, of all ranks.
std::vector<double> gather_walls(const Mesh& mesh, const std::vector<char>& wall) {
  std::vector<double> own;
  const int corners = facet_nodes(mesh.cell);
  for (const auto& facet : mesh.facets) {
    if (!wall[facet.boundary]) continue;
    const auto x = mesh.facet_corners(facet);
    const auto add = [&](int a, int b, int c) {
      for (int k : {a, b, c}) own.insert(own.end(), x[k].data(), x[k].data() + 3);
    };
    add(0, 1, corners == 2 ? 1 : 2);
    if (corners == 4) add(0, 2, 3);
  }
  const int count = static_cast<int>(own.size());
  std::vector<int> counts(mpi_size()), starts(mpi_size(), 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (int r = 1; r < mpi_size(); ++r) starts[r] = starts[r - 1] + counts[r - 1];
  std::vector<double> all(starts.back() + counts.back());
  MPI_Allgatherv(own.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, PETSC_COMM_WORLD);
  return all;
}

}  // namespace

std::vector<double> wall_distance(const Mesh& mesh, const std::vector<char>& wall) {
  const std::vector<double> corners = gather_walls(mesh, wall);
  std::vector<FacetTree::Facet> facets(corners.size() / 9);
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (int k = 0; k < 3; ++k) facets[f][k] = vec3(&corners[9 * f + 3 * k]);
  const FacetTree tree(std::move(facets));

  std::vector<Vec3> shifts;  // the place itself first
  for (int i : {0, -1, 1})
    for (int j : {0, -1, 1})
      for (int k : {0, -1, 1}) {
        if ((i && !mesh.periodic[0]) || (j && !mesh.periodic[1]) || (k && !mesh.periodic[2])) continue;
        shifts.push_back(Vec3(i, j, k).cwiseProduct(mesh.upper - mesh.lower));
      }
  std::vector<double> distance(mesh.nodes, infinity);
  if (!tree.empty())
    for (int n = 0; n < mesh.nodes; ++n)
      for (const Vec3& shift : shifts)
        distance[n] = tree.distance(vec3(&mesh.node_coordinates[3 * static_cast<std::size_t>(n)]) + shift, distance[n]);
  mesh.copy_from_owner(distance.data(), 1);
  return distance;
}

}  // namespace silt
