#pragma once
#include <vector>

#include "particles/walls/box_tree.hpp"
#include "particles/walls/surface.hpp"

namespace silt {

/// A half-plane of a convex face: the face is where inward . x >= offset.
struct WallSide {
  Vec3 inward;
  double offset;
};

/// A convex planar piece of wall: a whole patch where that is convex, else parts of it. It touches a sphere whose
/// centre projects into it.
struct WallFace {
  Vec3 normal;    ///< towards the particles
  double offset;  ///< normal . x on the plane, m
  int first_side, sides;
  int boundary;
  int group;  ///< faces joined by flat or smooth edges have the same group
  Box box;
};

/// A convex edge of the wall, or (length 0) a convex vertex. It touches a sphere when its nearest point p to the centre
/// c is a local minimum of the distance to the wall: (c - p) . ray <= 0 for every direction in which the wall goes on.
/// Flat and concave edges never are, so they do not occur; every edge and vertex occurs once.
struct WallEdge {
  Vec3 start, direction;
  double length;
  Vec3 outside;  ///< the centre must lie on this side; zero: no condition
  int first_ray, rays;
  int boundary;
  int group;                            ///< -1 between faces of different groups
  std::array<int, 2> vertices{-1, -1};  ///< of the surface, at its ends
  Box box;
};

/// The parts of the walls that spheres can touch, all of the domain on every rank.
struct WallShape {
  std::vector<WallFace> faces;
  std::vector<WallSide> sides;
  std::vector<WallEdge> edges;
  std::vector<Vec3> rays;
  double tolerance = 0;

  WallShape() = default;
  /// `is_wall[b]`: boundary b is a wall; edges where the normals turn by less than `smooth_angle` (rad) join groups.
  WallShape(const Surface& surface, const std::vector<bool>& is_wall, double smooth_angle);
  /// Appends those faces and edges of `all`, moved by each of `shifts`, that meet the box.
  void add_near(const WallShape& all, const std::vector<Vec3>& shifts, const Box& box);

 private:
  void add_faces(const Surface& surface, const Patch& patch, int group);
  void add_face(const std::vector<Vec3>& outline, const Patch& patch, int boundary, int group);
  void add_edges(const Surface& surface, const std::vector<bool>& is_wall, const std::vector<int>& group);
  void add_vertices(const Surface& surface, const std::vector<bool>& is_wall, const std::vector<int>& group);
  void join_straight_edges();
};

}  // namespace silt
