#include "particles/walls/wall_shape.hpp"

#include <cmath>
#include <numeric>
#include <unordered_map>

#include "particles/walls/convex_parts.hpp"

namespace silt {
namespace {

/// Groups of patches joined by smooth edges; -1 for patches that are no wall.
std::vector<int> smooth_groups(const Surface& surface, const std::vector<bool>& is_wall, double smooth_angle) {
  std::vector<int> parent(surface.patches.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int p) {
    while (parent[p] != p) p = parent[p] = parent[parent[p]];
    return p;
  };
  for (const auto& around : surface.edge_facets) {
    if (around.size() != 2) continue;
    const auto &a = surface.facets[around[0][0]], &b = surface.facets[around[1][0]];
    if (!is_wall[a.boundary] || !is_wall[b.boundary]) continue;
    if (surface.patches[a.patch].normal.dot(surface.patches[b.patch].normal) < std::cos(smooth_angle + 1e-6)) continue;
    const int ra = root(a.patch), rb = root(b.patch);
    parent[std::max(ra, rb)] = std::min(ra, rb);
  }
  for (size_t p = 0; p < parent.size(); ++p) {
    const bool wall = is_wall[surface.facets[surface.patches[p].facets[0]].boundary];
    parent[p] = wall ? root(static_cast<int>(p)) : -1;
  }
  return parent;
}

}  // namespace

WallShape::WallShape(const Surface& surface, const std::vector<bool>& is_wall, double smooth_angle)
    : tolerance(surface.tolerance) {
  const auto group = smooth_groups(surface, is_wall, smooth_angle);
  for (size_t p = 0; p < surface.patches.size(); ++p)
    if (group[p] >= 0) add_faces(surface, surface.patches[p], group[p]);
  add_edges(surface, is_wall, group);
  if (surface.dimension == 3) add_vertices(surface, is_wall, group);
  join_straight_edges();
}

void WallShape::add_faces(const Surface& surface, const Patch& patch, int group) {
  const int boundary = surface.facets[patch.facets[0]].boundary;
  for (const auto& outline : convex_parts(surface, patch)) add_face(outline, patch, boundary, group);
}

void WallShape::add_face(const std::vector<Vec3>& outline, const Patch& patch, int boundary, int group) {
  WallFace face{patch.normal,
                patch.offset,
                static_cast<int>(sides.size()),
                static_cast<int>(outline.size()),
                boundary,
                group,
                {}};
  for (size_t k = 0; k < outline.size(); ++k) {
    const Vec3& a = outline[k];
    const Vec3 inward = (outline[(k + 1) % outline.size()] - a).cross(patch.normal).normalized();
    sides.push_back({inward, inward.dot(a)});
    face.box.add(a);
  }
  face.box.grow(100 * tolerance);
  faces.push_back(face);
}

void WallShape::add_edges(const Surface& surface, const std::vector<bool>& is_wall, const std::vector<int>& group) {
  constexpr double flat = 1e-9;
  const auto plane = [&](int f) -> const Patch& { return surface.patches[surface.facets[f].patch]; };
  for (const auto& around : surface.edge_facets) {
    std::vector<std::array<int, 2>> walls, others;
    for (const auto& use : around) (is_wall[surface.facets[use[0]].boundary] ? walls : others).push_back(use);
    if (walls.empty()) continue;
    const auto [f, k] = walls[0];
    Vec3 outside = Vec3::Zero();
    if (around.size() == 2) {
      const auto [g, m] = around[0] == walls[0] ? around[1] : around[0];
      const double rise = surface.into_facet(g, m).dot(plane(f).normal);
      const bool folded = surface.into_facet(g, m).dot(surface.into_facet(f, k)) > 0;
      // The rim of a wall that goes on as a flat opening has to be felt, a flat or concave edge of walls cannot be.
      if (walls.size() == 2 ? rise > (folded ? flat : -flat) : rise > flat) continue;
      outside = plane(f).normal;
      if (walls.size() == 2) outside += plane(g).normal;
    }
    const auto& facet = surface.facets[f];
    const Vec3 along = facet.end(k) - facet.start(k);
    WallEdge edge;
    edge.start = facet.start(k);
    edge.length = along.norm();
    edge.direction = along / edge.length;
    edge.outside = outside;
    edge.first_ray = static_cast<int>(rays.size());
    edge.rays = static_cast<int>(walls.size());
    edge.boundary = facet.boundary;
    edge.group = walls.size() == 2 ? group[facet.patch] : -1;
    for (const auto& [g, m] : walls) {
      rays.push_back(surface.into_facet(g, m));
      if (group[surface.facets[g].patch] != edge.group) edge.group = -1;
    }
    edge.box.add(facet.start(k));
    edge.box.add(facet.end(k));
    edge.vertices = {facet.vertex[k], facet.vertex[k + 1 == facet.corners ? 0 : k + 1]};
    edges.push_back(edge);
  }
}

void WallShape::add_vertices(const Surface& surface, const std::vector<bool>& is_wall, const std::vector<int>& group) {
  // Directions of the convex edges at every vertex: a vertex can touch only where two of them meet at an angle.
  std::vector<std::vector<Vec3>> at_vertex(surface.vertex_facets.size());
  for (const auto& edge : edges) {
    at_vertex[edge.vertices[0]].push_back(edge.direction);
    at_vertex[edge.vertices[1]].push_back(-edge.direction);
  }
  for (size_t v = 0; v < at_vertex.size(); ++v) {
    const auto& directions = at_vertex[v];
    bool bent = false;
    for (size_t a = 1; a < directions.size(); ++a)
      bent = bent || directions[a].cross(directions[0]).norm() > 1e-7 || directions[a].dot(directions[0]) > 0;
    if (!bent) continue;
    WallEdge corner;
    corner.direction = corner.outside = Vec3::Zero();
    corner.length = 0;
    corner.first_ray = static_cast<int>(rays.size());
    corner.boundary = corner.group = -1;
    for (const auto& [f, k] : surface.vertex_facets[v]) {
      const auto& facet = surface.facets[f];
      if (!is_wall[facet.boundary]) continue;
      if (corner.boundary < 0) {
        corner.start = facet.corner[k];
        corner.boundary = facet.boundary;
        corner.group = group[facet.patch];
      }
      if (group[facet.patch] != corner.group) corner.group = -1;
      const int before = k == 0 ? facet.corners - 1 : k - 1;
      for (const Vec3& ray : {Vec3(facet.end(k) - facet.start(k)), Vec3(facet.start(before) - facet.end(before))}) {
        const Vec3 unit = ray.normalized();
        bool known = false;
        for (size_t r = corner.first_ray; r < rays.size(); ++r) known = known || (rays[r] - unit).norm() < 1e-9;
        if (!known) rays.push_back(unit);
      }
    }
    corner.rays = static_cast<int>(rays.size()) - corner.first_ray;
    corner.box.add(corner.start);
    edges.push_back(corner);
  }
}

void WallShape::join_straight_edges() {
  // Lines of edges that lie in the same two faces become one: a large sphere then meets few of them.
  const auto alike = [&](const WallEdge& a, const WallEdge& b) {
    if (a.rays != b.rays || a.boundary != b.boundary || a.group != b.group) return false;
    if (std::abs(a.direction.dot(b.direction)) < 1 - 1e-13 || (a.outside - b.outside).norm() > 1e-9) return false;
    bool same = true, swapped = a.rays == 2;
    for (int r = 0; r < a.rays; ++r) {
      same = same && (rays[a.first_ray + r] - rays[b.first_ray + r]).norm() < 1e-9;
      swapped = swapped && (rays[a.first_ray + r] - rays[b.first_ray + 1 - r]).norm() < 1e-9;
    }
    return same || swapped;
  };
  std::unordered_map<int, std::vector<int>> at_vertex;
  for (int e = 0; e < static_cast<int>(edges.size()); ++e)
    if (edges[e].length > 0)
      for (int v : edges[e].vertices)
        if (v >= 0) at_vertex[v].push_back(e);
  std::vector<WallEdge> joined;
  std::vector<bool> used(edges.size(), false);
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    if (used[e]) continue;
    used[e] = true;
    WallEdge whole = edges[e];
    for (int end : {0, 1})
      for (bool grown = whole.length > 0; grown;) {
        grown = false;
        const auto found = at_vertex.find(whole.vertices[end]);
        if (found == at_vertex.end()) break;
        const Vec3 tip = whole.start + (end ? whole.length : 0) * whole.direction;
        for (int other : found->second) {
          const WallEdge& next = edges[other];
          if (used[other] || !alike(edges[e], next)) continue;
          const Vec3 next_end = next.start + next.length * next.direction;
          const bool from_start = (next.start - tip).norm() < 16 * tolerance;
          // Neighbours across a period are not joined.
          if (!from_start && (next_end - tip).norm() >= 16 * tolerance) continue;
          used[other] = grown = true;
          whole.vertices[end] = next.vertices[from_start ? 1 : 0];
          if (end == 0) whole.start = from_start ? next_end : next.start;
          whole.length += next.length;
          whole.box.add(next.box);
          break;
        }
      }
    joined.push_back(whole);
  }
  edges = std::move(joined);
}

void WallShape::add_near(const WallShape& all, const std::vector<Vec3>& shifts, const Box& box) {
  tolerance = all.tolerance;
  rays = all.rays;
  const auto moved = [](Box b, const Vec3& shift) {
    b.lower += shift;
    b.upper += shift;
    return b;
  };
  for (const Vec3& shift : shifts) {
    for (const auto& original : all.faces) {
      WallFace face = original;
      face.box = moved(face.box, shift);
      if (!face.box.meets(box)) continue;
      face.offset += face.normal.dot(shift);
      face.first_side = static_cast<int>(sides.size());
      for (int s = 0; s < face.sides; ++s) {
        const WallSide& side = all.sides[original.first_side + s];
        sides.push_back({side.inward, side.offset + side.inward.dot(shift)});
      }
      faces.push_back(face);
    }
    for (const auto& original : all.edges) {
      WallEdge edge = original;
      edge.box = moved(edge.box, shift);
      if (!edge.box.meets(box)) continue;
      edge.start += shift;
      edges.push_back(edge);
    }
  }
}

}  // namespace silt
