#include "particles/insertion/room.hpp"

#include <cmath>

namespace silt {
namespace {

std::vector<Box> boxes_of(const Surface& surface, const std::vector<int>& facets) {
  std::vector<Box> boxes;
  for (int f : facets) {
    Box box;
    for (int k = 0; k < surface.facets[f].corners; ++k) box.add(surface.facets[f].corner[k]);
    boxes.push_back(box);
  }
  return boxes;
}

/// The nearest point of a facet, and which edge (from corner k) or corner it lies on; -1: neither.
struct OnFacet {
  Vec3 point;
  int edge = -1, corner = -1;
};

OnFacet nearest_on_facet(const SurfaceFacet& facet, const Vec3& x) {
  OnFacet best;
  bool within = true;
  double least = 1e300;
  for (int k = 0; k < facet.corners; ++k) {
    const Vec3 along = facet.end(k) - facet.start(k);
    if (along.cross(facet.normal).dot(x - facet.start(k)) >= 0) continue;
    within = false;
    const double s = along.dot(x - facet.start(k)) / along.squaredNorm();
    const Vec3 point = facet.start(k) + std::clamp(s, 0.0, 1.0) * along;
    const double squared = (x - point).squaredNorm();
    if (squared >= least) continue;
    least = squared;
    best.point = point;
    best.edge = s > 0 && s < 1 ? k : -1;
    best.corner = s <= 0 ? k : s >= 1 ? (k + 1) % facet.corners : -1;
  }
  if (within) best.point = x - facet.normal.dot(x - facet.corner[0]) * facet.normal;
  return best;
}

}  // namespace

Room::Room(const Surface& surface, std::vector<bool> is_wall)
    : surface_(surface), is_wall_(std::move(is_wall)), shifts_(surface.shifts()) {
  for (int f = 0; f < static_cast<int>(surface.facets.size()); ++f) {
    all_.push_back(f);
    if (is_wall_[surface.facets[f].boundary]) walls_.push_back(f);
  }
  tree_ = BoxTree(boxes_of(surface, all_));
  wall_tree_ = BoxTree(boxes_of(surface, walls_));
  bin_ = (surface.upper - surface.lower).maxCoeff() / 64;
}

/// Which side of the boundary a point is on, seen from its nearest boundary point: by the mean normal of the facets
/// that meet there, weighted by their angles (Baerentzen & Aanaes 2005).
double Room::side(int facet, const Vec3& from_nearest, int edge, int vertex) const {
  Vec3 normal = Vec3::Zero();
  if (edge >= 0) {
    for (const auto& use : surface_.edge_facets[edge]) normal += surface_.facets[use[0]].normal;
  } else if (vertex >= 0) {
    for (const auto& [f, k] : surface_.vertex_facets[vertex]) {
      const auto& other = surface_.facets[f];
      const Vec3 next = (other.end(k) - other.start(k)).normalized();
      const int before = k == 0 ? other.corners - 1 : k - 1;
      const Vec3 last = (other.start(before) - other.end(before)).normalized();
      normal += std::acos(std::clamp(next.dot(last), -1.0, 1.0)) * other.normal;
    }
  }
  if (normal.norm() < 1e-9) normal = surface_.facets[facet].normal;
  return from_nearest.dot(normal);
}

Room::Nearest Room::nearest(const BoxTree& tree, const std::vector<int>& facets, const Vec3& point,
                            double limit) const {
  Nearest best;
  best.squared = limit * limit;
  for (const Vec3& shift : shifts_) {
    const Vec3 x = point - shift;
    tree.nearest(x, best.squared, [&](int item, double& squared_limit) {
      const int f = facets[item];
      const auto& facet = surface_.facets[f];
      const OnFacet on = nearest_on_facet(facet, x);
      const double squared = (x - on.point).squaredNorm();
      const double round_off = 1e-12 * squared + surface_.tolerance * surface_.tolerance;
      if (squared > best.squared + round_off) return;
      const double found =
          side(f, x - on.point, on.edge < 0 ? -1 : facet.edge[on.edge], on.corner < 0 ? -1 : facet.vertex[on.corner]);
      // The two sides of a wall without thickness are equally near: a point is inside if it is for either.
      const bool tie = squared > best.squared - round_off;
      best.side = tie ? std::max(best.side, found) : found;
      best.squared = std::min(best.squared, squared);
      squared_limit = best.squared * (1 + 1e-12) + surface_.tolerance * surface_.tolerance;
    });
  }
  return best;
}

double Room::signed_distance(const Vec3& point) const {
  const Nearest found = nearest(tree_, all_, point, 1e150);
  const double distance = std::sqrt(found.squared);
  return found.side < 0 ? -distance : distance;
}

bool Room::inside(const Vec3& point) const {
  const double slack = 4 * surface_.tolerance;
  for (int d = 0; d < surface_.dimension; ++d)
    if (!surface_.periodic[d] && (point[d] < surface_.lower[d] - slack || point[d] > surface_.upper[d] + slack))
      return false;
  if (all_.empty()) return true;
  // Deep inside, the distance at the centre of the bin around the point settles it.
  std::uint64_t key = 0;
  Vec3 centre;
  for (int d = 0; d < 3; ++d) {
    const double index = std::floor((point[d] - surface_.lower[d]) / bin_);
    centre[d] = surface_.lower[d] + (index + 0.5) * bin_;
    key = key << 21 | (static_cast<std::uint64_t>(static_cast<std::int64_t>(index)) & 0x1FFFFF);
  }
  auto known = known_.find(key);
  if (known == known_.end()) known = known_.emplace(key, signed_distance(centre)).first;
  if (std::abs(known->second) > (point - centre).norm() + slack) return known->second > 0;
  return signed_distance(point) >= -slack;
}

bool Room::holds(const Vec3& centre, double radius) const {
  const double slack = 4 * surface_.tolerance;
  return inside(centre) && wall_distance(centre, radius) >= radius - slack && clearance(centre) >= radius - slack;
}

double Room::wall_distance(const Vec3& point, double limit) const {
  return std::sqrt(nearest(wall_tree_, walls_, point, limit).squared);
}

Vec3 Room::wrapped(Vec3 point) const {
  for (int d = 0; d < 3; ++d)
    if (surface_.periodic[d]) {
      const double length = surface_.upper[d] - surface_.lower[d];
      point[d] -= length * std::floor((point[d] - surface_.lower[d]) / length);
    }
  return point;
}

}  // namespace silt
