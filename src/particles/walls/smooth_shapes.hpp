// Walls given by a formula: plane, sphere, and surfaces of revolution (cylinder, cone).
#pragma once
#include <vector>

#include "base/vector.hpp"
#include "particles/contact.hpp"

namespace silt {

/// On which side of a wall particles can be; on the other one they do not feel it.
enum class WallSideChoice { inside, outside, both };

/// The unbounded plane through `point`, towards `normal`; felt from there only, or from both sides.
struct PlaneShape {
  Vec3 point, normal;
  bool both = false;
  void touch(const Vec3& centre, double radius, std::vector<WallPoint>& points) const;
  /// Distance from the wall, negative behind it. m
  double clearance(const Vec3& x) const;
};

struct SphereShape {
  Vec3 centre;
  double radius;
  WallSideChoice side;
  void touch(const Vec3& at, double size, std::vector<WallPoint>& points) const;
  double clearance(const Vec3& x) const;
};

/// The surface that a line of straight pieces makes as it turns about an axis. `profile` are its corners, {distance
/// along the axis from `start`, distance from the axis}; the particles of side `inside` are to the right of the line
/// (towards the axis where it runs along the axis). It touches a sphere inside its pieces and on their convex corners
/// (rims), as the faceted walls do.
struct RevolutionShape {
  struct Corner {
    double along, out;
  };
  Vec3 start, axis;  ///< unit vector
  std::vector<Corner> profile;
  WallSideChoice side;
  void touch(const Vec3& centre, double radius, std::vector<WallPoint>& points) const;
  double clearance(const Vec3& x) const;
};

}  // namespace silt
