#pragma once
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "particles/walls/box_tree.hpp"
#include "particles/walls/surface.hpp"

namespace silt {

/// The space that particles may be put in: the inside of the mesh, away from its walls. Knows all of the mesh on every
/// rank, so that every rank finds the same answers.
class Room {
 public:
  Room(const Surface& surface, std::vector<bool> is_wall);

  const Surface& surface() const { return surface_; }
  /// Whether the point lies in the mesh.
  bool inside(const Vec3& point) const;
  /// Whether a sphere lies in the mesh with its centre, and no wall is nearer than its radius.
  bool holds(const Vec3& centre, double radius) const;
  /// Further walls: holds() asks how far a point is from them, negative behind one. m
  void add_walls(std::function<double(const Vec3&)> clearance) { clearance_ = std::move(clearance); }
  double clearance(const Vec3& point) const { return clearance_ ? clearance_(point) : 1e150; }
  /// Distance from the boundary, negative outside; 1e150 without any boundary. m
  double depth(const Vec3& point) const { return signed_distance(point); }
  /// Distance to the nearest wall, or `limit` when none is nearer. m
  double wall_distance(const Vec3& point, double limit) const;
  /// The point moved by whole periods into the mesh's box.
  Vec3 wrapped(Vec3 point) const;

 private:
  struct Nearest {
    double squared = 1e300;  ///< m2
    double side = 0;         ///< > 0 inside
  };
  Nearest nearest(const BoxTree& tree, const std::vector<int>& facets, const Vec3& point, double limit) const;
  double side(int facet, const Vec3& from_nearest, int edge, int vertex) const;
  /// Distance from the boundary, negative outside; 1e150 without any boundary.
  double signed_distance(const Vec3& point) const;

  const Surface& surface_;
  std::vector<bool> is_wall_;
  std::vector<Vec3> shifts_;
  std::function<double(const Vec3&)> clearance_;
  std::vector<int> all_, walls_;
  BoxTree tree_, wall_tree_;
  double bin_ = 0;  ///< m, edge of the bins for which the signed distance of the centre is remembered
  mutable std::unordered_map<std::uint64_t, double> known_;
};

}  // namespace silt
