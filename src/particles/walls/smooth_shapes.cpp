#include "particles/walls/smooth_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace silt {
namespace {

void add(double distance, const Vec3& normal, std::vector<WallPoint>& points) {
  WallPoint point{};
  point.distance = distance;
  vec3(point.normal) = normal;
  points.push_back(point);
}

/// A point in the plane through the axis: along it, and away from it.
struct Meridian {
  double along, out;
  Meridian operator-(const Meridian& other) const { return {along - other.along, out - other.out}; }
  double dot(const Meridian& other) const { return along * other.along + out * other.out; }
  double norm() const { return std::hypot(along, out); }
};

/// A straight piece of the profile.
struct Piece {
  Meridian start, tangent, inward;
  double length;
};

Piece piece(const RevolutionShape& shape, size_t k) {
  const Meridian a{shape.profile[k].along, shape.profile[k].out};
  const Meridian b{shape.profile[k + 1].along, shape.profile[k + 1].out};
  const double length = (b - a).norm();
  const Meridian t{(b.along - a.along) / length, (b.out - a.out) / length};
  const double sign = shape.side == WallSideChoice::outside ? -1 : 1;
  return {a, t, {sign * t.out, -sign * t.along}, length};
}

/// Whether a corner of the profile is nearest to a point at `arm` from it: that lies beyond all its pieces, and in
/// front of them.
bool corner_is_nearest(const RevolutionShape& shape, size_t k, const Meridian& arm) {
  const size_t last = shape.profile.size() - 1;
  const bool on_axis = shape.profile[k].out == 0;
  Meridian front{0, 0};
  if (k > 0) {
    const Piece before = piece(shape, k - 1);
    if (arm.dot(before.tangent) <= 0) return false;
    front = before.inward;
  }
  if (k < last) {
    const Piece after = piece(shape, k);
    if (arm.dot(after.tangent) >= 0) return false;
    front = {front.along + after.inward.along, front.out + after.inward.out};
  }
  const bool rim = (k == 0 || k == last) && !on_axis;  // felt from all around
  return rim || shape.side == WallSideChoice::both || arm.dot(front) >= 0;
}

}  // namespace

void PlaneShape::touch(const Vec3& centre, double radius, std::vector<WallPoint>& points) const {
  const double gap = normal.dot(centre - point);
  if (gap >= 0 && gap < radius) add(gap, normal, points);
  if (gap < 0 && both && -gap < radius) add(-gap, -normal, points);
}

double PlaneShape::clearance(const Vec3& x) const {
  const double gap = normal.dot(x - point);
  return both ? std::abs(gap) : gap;
}

void SphereShape::touch(const Vec3& at, double size, std::vector<WallPoint>& points) const {
  const Vec3 arm = at - centre;
  const double distance = arm.norm(), gap = distance - radius;
  if (std::abs(gap) >= size || distance == 0) return;
  if (gap >= 0 && side != WallSideChoice::inside) add(gap, arm / distance, points);
  if (gap <= 0 && side != WallSideChoice::outside && (gap < 0 || side == WallSideChoice::inside))
    add(-gap, -arm / distance, points);
}

double SphereShape::clearance(const Vec3& x) const {
  const double gap = (x - centre).norm() - radius;
  return side == WallSideChoice::both ? std::abs(gap) : side == WallSideChoice::inside ? -gap : gap;
}

void RevolutionShape::touch(const Vec3& centre, double radius, std::vector<WallPoint>& points) const {
  const Vec3 from_start = centre - start;
  const double along = axis.dot(from_start);
  const Vec3 radial = from_start - along * axis;
  const Meridian at{along, radial.norm()};
  // On the axis itself every direction is as good.
  const Vec3 out = at.out > 1e-12 * (radius + std::abs(along)) ? Vec3(radial / at.out) : Vec3(axis.unitOrthogonal());
  const auto space = [&](const Meridian& m) -> Vec3 { return m.along * axis + m.out * out; };
  const size_t first = points.size();
  for (size_t k = 0; k < profile.size(); ++k) {
    const Meridian arm = at - Meridian{profile[k].along, profile[k].out};
    if (k + 1 < profile.size()) {
      const Piece p = piece(*this, k);
      const double foot = arm.dot(p.tangent);
      if (foot >= 0 && foot <= p.length) {
        const double gap = arm.dot(p.inward);
        // Where two pieces meet the foot may end both: one contact.
        const bool same = foot == 0 && points.size() > first && points.back().distance == std::abs(gap);
        if (!same && gap >= 0 && gap < radius) add(gap, space(p.inward), points);
        if (!same && gap < 0 && -gap < radius && side == WallSideChoice::both) add(-gap, -space(p.inward), points);
      }
    }
    const double distance = arm.norm();
    if (distance < radius && distance > 0 && corner_is_nearest(*this, k, arm))
      add(distance, space({arm.along / distance, arm.out / distance}), points);
  }
}

double RevolutionShape::clearance(const Vec3& x) const {
  const Vec3 from_start = x - start;
  const double along = axis.dot(from_start);
  const Meridian at{along, (from_start - along * axis).norm()};
  double nearest = 1e300, result = 0;
  for (size_t k = 0; k < profile.size(); ++k) {
    const Meridian arm = at - Meridian{profile[k].along, profile[k].out};
    if (k + 1 < profile.size()) {
      const Piece p = piece(*this, k);
      const double foot = arm.dot(p.tangent), gap = arm.dot(p.inward);
      if (foot >= 0 && foot <= p.length && std::abs(gap) < nearest) {
        nearest = std::abs(gap);
        result = side == WallSideChoice::both ? nearest : gap;
      }
    }
    if (arm.norm() < nearest) {
      nearest = arm.norm();
      const bool rim = (k == 0 || k + 1 == profile.size()) && profile[k].out > 0;
      bool behind = !rim && side != WallSideChoice::both;
      if (behind) {
        Meridian front{0, 0};
        for (size_t m : {k, k + 1})
          if (m > 0 && m < profile.size()) {
            const Meridian n = piece(*this, m - 1).inward;
            front = {front.along + n.along, front.out + n.out};
          }
        behind = arm.dot(front) < 0;
      }
      result = behind ? -nearest : nearest;
    }
  }
  return result;
}

}  // namespace silt
