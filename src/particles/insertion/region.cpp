#include "particles/insertion/region.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace silt {

double space_of(double radius, int dimension) {
  return dimension == 2 ? std::numbers::pi * radius * radius : 4.0 / 3 * std::numbers::pi * radius * radius * radius;
}

Region::Region(const Room& room, const Box& box, const std::string& cylinder_axis) : room_(room), box_(box) {
  const Surface& surface = room.surface();
  for (int d = 0; d < surface.dimension; ++d) {
    box_.lower[d] = std::max(box_.lower[d], surface.lower[d]);
    box_.upper[d] = std::min(box_.upper[d], surface.upper[d]);
    spans_[d] = surface.periodic[d] && box_.upper[d] - box_.lower[d] > 0.999999 * (surface.upper[d] - surface.lower[d]);
  }
  if (surface.dimension == 2) box_.lower[2] = box_.upper[2] = 0;
  if (!cylinder_axis.empty()) axis_ = cylinder_axis[0] - 'x';
}

double Region::volume() const {
  const Vec3 size = box_.upper - box_.lower;
  double volume = 1;
  if (axis_ >= 0) {
    double radius = 1e300;
    for (int d = 0; d < 3; ++d)
      if (d != axis_) radius = std::min(radius, 0.5 * size[d]);
    return std::numbers::pi * radius * radius * size[axis_];
  }
  for (int d = 0; d < dimension(); ++d) volume *= size[d];
  return volume;
}

Box Region::centres(double radius) const {
  Box box = box_;
  for (int d = 0; d < dimension(); ++d)
    if (!spans_[d]) {
      box.lower[d] += radius;
      box.upper[d] -= radius;
    }
  return box;
}

Vec3 Region::clamped(Vec3 centre, double radius) const {
  const Box box = centres(radius);
  for (int d = 0; d < dimension(); ++d) {
    const double length = box.upper[d] - box.lower[d];
    if (spans_[d])
      centre[d] -= length * std::floor((centre[d] - box.lower[d]) / length);
    else
      centre[d] = std::clamp(centre[d], box.lower[d], box.upper[d]);
  }
  if (axis_ < 0) return centre;
  double limit = -radius;
  for (int d = 0, first = 1; d < 3; ++d)
    if (d != axis_) {
      const double half = 0.5 * (box_.upper[d] - box_.lower[d]) - radius;
      limit = first ? half : std::min(limit, half);
      first = 0;
    }
  const Vec3 middle = 0.5 * (box_.lower + box_.upper);
  Vec3 off = centre - middle;
  off[axis_] = 0;
  if (const double out = off.norm(); out > limit) centre -= (1 - limit / out) * off;
  return centre;
}

bool Region::holds(const Vec3& centre, double radius) const {
  const double slack = 4 * room_.surface().tolerance;
  const Box box = centres(radius);
  for (int d = 0; d < dimension(); ++d)
    if (centre[d] < box.lower[d] - slack || centre[d] > box.upper[d] + slack) return false;
  if (axis_ >= 0) {
    Vec3 off = centre - 0.5 * (box_.lower + box_.upper);
    off[axis_] = 0;
    double limit = 1e300;
    for (int d = 0; d < 3; ++d)
      if (d != axis_) limit = std::min(limit, 0.5 * (box_.upper[d] - box_.lower[d]));
    if (off.norm() > limit - radius + slack) return false;
  }
  return room_.holds(centre, radius);
}

}  // namespace silt
