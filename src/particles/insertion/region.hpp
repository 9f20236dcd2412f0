#pragma once
#include <string>

#include "particles/insertion/room.hpp"

namespace silt {

/// Part of the mesh that an insertion fills: a box, or the upright cylinder that fits into it.
class Region {
 public:
  /// `cylinder_axis` is x, y or z, or empty for the box. `box` reaches the whole mesh in directions not bounded.
  Region(const Room& room, const Box& box, const std::string& cylinder_axis);

  /// m3 (m2 in 2D).
  double volume() const;
  /// The box that centres of spheres of this radius may lie in; empty when upper < lower somewhere.
  Box centres(double radius) const;
  /// Whether a whole sphere lies in the region, in the mesh and off its walls.
  bool holds(const Vec3& centre, double radius) const;
  /// The place nearest to a point where a sphere of this radius lies in the region's box or cylinder.
  Vec3 clamped(Vec3 centre, double radius) const;
  /// Whether the region spans a whole period in direction d.
  bool spans_period(int d) const { return spans_[d]; }
  int dimension() const { return room_.surface().dimension; }

 private:
  const Room& room_;
  Box box_;
  int axis_ = -1;
  bool spans_[3] = {false, false, false};
};

/// Volume of a sphere (area of a disc in 2D), to compare with Region::volume.
double space_of(double radius, int dimension);

}  // namespace silt
