#include "particles/walls/surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "particles/walls/point_index.hpp"

namespace silt {
namespace {

bool before(const Vec3& a, const Vec3& b) { return std::tie(a[0], a[1], a[2]) < std::tie(b[0], b[1], b[2]); }

/// Starts the polygon at its lowest corner, so that a facet looks the same from whichever rank it came.
void start_at_lowest(SurfaceFacet& facet) {
  const auto first = facet.corner.begin(), last = first + facet.corners;
  std::rotate(first, std::min_element(first, last, before), last);
}

Vec3 polygon_normal(const SurfaceFacet& facet) {
  Vec3 sum = Vec3::Zero();
  for (int k = 1; k + 1 < facet.corners; ++k)
    sum += (facet.corner[k] - facet.corner[0]).cross(facet.corner[k + 1] - facet.corner[0]);
  return -sum;  // corners are ordered outwards
}

SurfaceFacet triangle(const SurfaceFacet& quad, int a, int b, int c) {
  SurfaceFacet facet = quad;
  facet.corners = 3;
  facet.corner[0] = quad.corner[a];
  facet.corner[1] = quad.corner[b];
  facet.corner[2] = quad.corner[c];
  return facet;
}

/// All facets' corners and boundaries on every rank.
std::vector<SurfaceFacet> all_facets(const Mesh& mesh) {
  const int corners = facet_nodes(mesh.cell), stride = 3 * corners + 1;
  std::vector<double> mine;
  for (const auto& facet : mesh.facets) {
    const auto corner = mesh.facet_corners(facet);
    for (int a = 0; a < corners; ++a) mine.insert(mine.end(), corner[a].data(), corner[a].data() + 3);
    mine.push_back(facet.boundary);
  }
  const int ranks = mpi_size(), count = static_cast<int>(mine.size());
  std::vector<int> counts(ranks), starts(ranks + 1, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (int r = 0; r < ranks; ++r) starts[r + 1] = starts[r] + counts[r];
  std::vector<double> all(starts[ranks]);
  MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE,
                 PETSC_COMM_WORLD);
  std::vector<SurfaceFacet> facets(all.size() / stride);
  for (size_t f = 0; f < facets.size(); ++f) {
    facets[f].corners = corners;
    facets[f].boundary = static_cast<int>(all[f * stride + 3 * corners]);
    for (int a = 0; a < corners; ++a) facets[f].corner[a] = vec3(&all[f * stride + 3 * a]);
  }
  return facets;
}

}  // namespace

Surface::Surface(const Mesh& mesh)
    : dimension(mesh.dimension), lower(mesh.lower), upper(mesh.upper), periodic(mesh.periodic) {
  tolerance = std::max(1e-8 * mesh.smallest_edge, 1e-14 * (upper - lower).norm());
  gather(mesh);
  connect();
  grow_patches();
}

Surface::Surface(std::vector<SurfaceFacet> given, const Vec3& low, const Vec3& high,
                 const std::array<bool, 3>& is_periodic, double round_off)
    : dimension(3), lower(low), upper(high), periodic(is_periodic), facets(std::move(given)) {
  double shortest = 1e300, furthest = 0;
  for (auto& facet : facets) {
    facet.normal = polygon_normal(facet).normalized();
    for (int k = 0; k < facet.corners; ++k) {
      shortest = std::min(shortest, (facet.end(k) - facet.start(k)).norm());
      furthest = std::max(furthest, facet.corner[k].cwiseAbs().maxCoeff());
    }
  }
  tolerance = std::max({1e-8 * shortest, 1e-14 * (upper - lower).norm(), round_off * furthest});
  connect();
  grow_patches();
}

void Surface::gather(const Mesh& mesh) {
  const double far = 2 * (upper - lower).norm();
  for (auto& facet : all_facets(mesh)) {
    if (dimension == 2) {
      const Vec3 p = facet.corner[0], q = facet.corner[1], z(0, 0, far);
      facet.corners = 4;
      facet.corner = {Vec3(p - z), Vec3(q - z), Vec3(q + z), Vec3(p + z)};
      facets.push_back(facet);
      continue;
    }
    start_at_lowest(facet);
    if (facet.corners == 4) {
      const Vec3 normal = polygon_normal(facet).normalized();
      double warp = 0;
      for (int k = 1; k < 4; ++k) warp = std::max(warp, std::abs(normal.dot(facet.corner[k] - facet.corner[0])));
      if (warp > tolerance) {
        const bool other = (facet.corner[1] - facet.corner[3]).norm() < (facet.corner[2] - facet.corner[0]).norm();
        facets.push_back(other ? triangle(facet, 0, 1, 3) : triangle(facet, 0, 1, 2));
        facets.push_back(other ? triangle(facet, 1, 2, 3) : triangle(facet, 0, 2, 3));
        start_at_lowest(facets[facets.size() - 2]);
        start_at_lowest(facets.back());
        continue;
      }
    }
    facets.push_back(facet);
  }
  std::sort(facets.begin(), facets.end(), [](const SurfaceFacet& a, const SurfaceFacet& b) {
    if (a.boundary != b.boundary) return a.boundary < b.boundary;
    for (int k = 0; k < std::min(a.corners, b.corners); ++k)
      if (a.corner[k] != b.corner[k]) return before(a.corner[k], b.corner[k]);
    return a.corners < b.corners;
  });
  for (auto& facet : facets) facet.normal = polygon_normal(facet).normalized();
}

void Surface::connect() {
  // An edge is known by its midpoint, both edges and vertices by their place within one period, so that facets on the
  // two sides of a periodic domain are neighbours.
  const auto within_period = [&](Vec3 x) {
    for (int d = 0; d < 3; ++d)
      if (periodic[d]) {
        const double length = upper[d] - lower[d];
        x[d] -= length * std::floor((x[d] - lower[d] + 4 * tolerance) / length);
      }
    return x;
  };
  PointIndex edges(4 * tolerance), vertices(4 * tolerance);
  for (int f = 0; f < static_cast<int>(facets.size()); ++f) {
    auto& facet = facets[f];
    facet.edge.fill(-1);
    facet.vertex.fill(-1);
    for (int k = 0; k < facet.corners; ++k) {
      const bool far_end = dimension == 2 && k % 2 == 0;
      if (!far_end) facet.edge[k] = edges(within_period(0.5 * (facet.start(k) + facet.end(k))));
      if (dimension == 3) facet.vertex[k] = vertices(within_period(facet.corner[k]));
    }
  }
  edge_facets.resize(edges.size());
  vertex_facets.resize(vertices.size());
  for (int f = 0; f < static_cast<int>(facets.size()); ++f)
    for (int k = 0; k < facets[f].corners; ++k) {
      if (facets[f].edge[k] >= 0) edge_facets[facets[f].edge[k]].push_back({f, k});
      if (facets[f].vertex[k] >= 0) vertex_facets[facets[f].vertex[k]].push_back({f, k});
    }
  split_edges();
}

void Surface::split_edges() {
  const size_t count = edge_facets.size();
  for (size_t e = 0; e < count; ++e) {
    auto left = edge_facets[e];
    if (left.size() <= 2) continue;
    edge_facets[e].clear();
    for (bool first = true; !left.empty(); first = false) {
      // Turning about the edge from facet a through the domain, the next facet that faces the other way.
      const auto a = left[0];
      const Vec3 up = facets[a[0]].normal;
      const auto into = [&](const std::array<int, 2>& use) -> Vec3 {
        const auto& facet = facets[use[0]];
        return (facet.end(use[1]) - facet.start(use[1])).cross(facet.normal).normalized();
      };
      const Vec3 along = into(a);
      size_t best = 0;
      double least = 1e300;
      for (size_t k = 1; k < left.size(); ++k) {
        const Vec3 other = into(left[k]);
        double angle = std::atan2(other.dot(up), other.dot(along));
        if (angle < 1e-7) angle += 2 * std::numbers::pi;
        const Vec3 onward = std::cos(angle) * up - std::sin(angle) * along;
        if (facets[left[k][0]].normal.dot(onward) < 0 && angle < least) {
          least = angle;
          best = k;
        }
      }
      std::vector<std::array<int, 2>> wedge = {a};
      if (best > 0) wedge.push_back(left[best]);
      const int edge = first ? static_cast<int>(e) : static_cast<int>(edge_facets.size());
      for (const auto& [f, k] : wedge) facets[f].edge[k] = edge;
      if (best > 0) left.erase(left.begin() + static_cast<long>(best));
      left.erase(left.begin());
      if (first)
        edge_facets[e] = std::move(wedge);
      else
        edge_facets.push_back(std::move(wedge));
    }
  }
}

void Surface::grow_patches() {
  // Facets join a patch when their corners lie in the plane of its first facet: no drift along a curved surface.
  const double thickness = 100 * tolerance;
  for (int seed = 0; seed < static_cast<int>(facets.size()); ++seed) {
    if (facets[seed].patch >= 0) continue;
    const int number = static_cast<int>(patches.size());
    Patch patch{facets[seed].normal, facets[seed].normal.dot(facets[seed].corner[0]), {seed}};
    facets[seed].patch = number;
    for (size_t next = 0; next < patch.facets.size(); ++next) {
      const int f = patch.facets[next];
      for (int k = 0; k < facets[f].corners; ++k) {
        if (facets[f].edge[k] < 0 || edge_facets[facets[f].edge[k]].size() != 2) continue;
        for (const auto& [g, m] : edge_facets[facets[f].edge[k]]) {
          auto& other = facets[g];
          if (other.patch >= 0 || other.boundary != facets[f].boundary) continue;
          const bool across_period = (facets[f].start(k) - other.end(m)).norm() > 16 * tolerance;
          if (across_period || other.normal.dot(patch.normal) < 0.9999) continue;
          bool coplanar = true;
          for (int a = 0; a < other.corners; ++a)
            coplanar = coplanar && std::abs(patch.normal.dot(other.corner[a]) - patch.offset) < thickness;
          if (!coplanar) continue;
          other.patch = number;
          patch.facets.push_back(g);
        }
      }
    }
    // The plane is that of all its facets together, not of the one that happened to come first.
    Vec3 normal = Vec3::Zero(), centre = Vec3::Zero();
    double corners = 0;
    for (int f : patch.facets) {
      normal += polygon_normal(facets[f]);
      for (int a = 0; a < facets[f].corners; ++a, ++corners) centre += facets[f].corner[a];
    }
    patch.normal = normal.normalized();
    patch.offset = patch.normal.dot(centre / corners);
    patches.push_back(std::move(patch));
  }
}

Vec3 Surface::into_facet(int facet, int k) const {
  const auto& f = facets[facet];
  return (f.end(k) - f.start(k)).cross(patches[f.patch].normal).normalized();
}

std::vector<Vec3> Surface::shifts() const {
  std::vector<Vec3> result;
  for (int i : {0, -1, 1})
    for (int j : {0, -1, 1})
      for (int k : {0, -1, 1})
        if ((i == 0 || periodic[0]) && (j == 0 || periodic[1]) && (k == 0 || periodic[2]))
          result.push_back(Vec3(i, j, k).cwiseProduct(upper - lower));
  return result;
}

}  // namespace silt
