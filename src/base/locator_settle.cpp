#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/locator.hpp"

namespace silt {
namespace {

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double along = std::clamp((x - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (x - a - along * edge).norm();
}

double distance_to_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const bool above = (b - a).cross(x - a).dot(normal) >= 0 && (c - b).cross(x - b).dot(normal) >= 0 &&
                     (a - c).cross(x - c).dot(normal) >= 0;
  if (above) return std::abs((x - a).dot(normal)) / normal.norm();
  return std::min({distance_to_segment(x, a, b), distance_to_segment(x, b, c), distance_to_segment(x, c, a)});
}

double distance_to_facet(const Mesh& mesh, const BoundaryFacet& facet, const Vec3& x) {
  const auto corner = mesh.facet_corners(facet);
  if (mesh.dimension == 2) return distance_to_segment(Vec3(x[0], x[1], 0), corner[0], corner[1]);
  double distance = distance_to_triangle(x, corner[0], corner[1], corner[2]);
  if (facet_nodes(mesh.cell) == 4)
    distance = std::min(distance, distance_to_triangle(x, corner[0], corner[2], corner[3]));
  return distance;
}

}  // namespace

std::vector<Place> Locator::settle(std::span<const Vec3> points) const {
  const int size = mpi_size(), own = mpi_rank();
  std::vector<int> counts(size), starts(size + 1, 0);
  const int mine = 3 * static_cast<int>(points.size());
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (int r = 0; r < size; ++r) starts[r + 1] = starts[r] + counts[r];
  if (starts[size] == 0) return {};
  std::vector<Vec3> everyone(starts[size] / 3);
  std::vector<double> own_points(mine);
  for (std::size_t k = 0; k < points.size(); ++k) vec3(&own_points[3 * k]) = points[k];
  MPI_Allgatherv(own_points.data(), mine, MPI_DOUBLE, everyone.data()->data(), counts.data(), starts.data(), MPI_DOUBLE,
                 PETSC_COMM_WORLD);
  std::vector<Place> places = claim(everyone);

  // Points that nobody holds have left the domain: through the boundary nearest to them.
  struct Nearest {
    double distance;
    int boundary;
  };
  std::vector<Nearest> nearest(everyone.size(), {std::numeric_limits<double>::max(), -1});
  for (std::size_t k = 0; k < everyone.size(); ++k) {
    if (places[k].inside() || places[k].rank >= 0) continue;
    Vec3 x = everyone[k];
    std::array<int, 3> wrap{0, 0, 0};
    to_box(x.data(), wrap);
    for (const auto& facet : mesh_.facets) {
      const double distance = distance_to_facet(mesh_, facet, x);
      if (distance < nearest[k].distance) nearest[k] = {distance, facet.boundary};
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, nearest.data(), static_cast<int>(nearest.size()), MPI_DOUBLE_INT, MPI_MINLOC,
                PETSC_COMM_WORLD);
  std::vector<Place> result(points.size());
  for (std::size_t k = 0; k < everyone.size(); ++k) {
    Place& place = places[k];
    // A rank that holds the point says so itself; the others learn it from claim().
    if (!place.inside() && place.rank >= 0) place.state = Place::State::remote;
    if (place.state == Place::State::missing) {
      if (nearest[k].boundary < 0)
        throw RunError("a point lies in no cell and the mesh has no boundary to have left through");
      place.state = Place::State::boundary;
      place.boundary = nearest[k].boundary;
    }
    const std::size_t first = starts[own] / 3;
    if (k >= first && k < first + points.size()) result[k - first] = place;
  }
  return result;
}

}  // namespace silt
