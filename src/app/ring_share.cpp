#include "app/ring_share.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace silt {
namespace {

/// Area that two circles of radii a and b have in common, their centres being this far apart.
double common_area(double apart, double a, double b) {
  const double smaller = std::min(a, b);
  if (smaller <= 0 || apart >= a + b) return 0;
  if (apart <= std::abs(a - b)) return std::numbers::pi * smaller * smaller;
  const double along_a = (apart * apart + a * a - b * b) / (2 * apart), along_b = apart - along_a;
  const auto segment = [](double r, double along) {
    const double share = std::clamp(along / r, -1.0, 1.0);
    return r * r * (std::acos(share) - share * std::sqrt(1 - share * share));
  };
  return segment(a, along_a) + segment(b, along_b);
}

}  // namespace

double Ring::volume() const { return std::numbers::pi * (outer * outer - inner * inner) * (high - low); }

double volume_in_ring(double distance, double height, double radius, const Ring& ring) {
  if (distance - radius >= ring.outer || distance + radius <= ring.inner) return 0;
  const double from = std::max(ring.low - height, -radius), to = std::min(ring.high - height, radius);
  if (from >= to) return 0;
  // Slices across the axis at heights R sin(t), circles of radius R cos(t): midpoints in t.
  constexpr int slices = 48;
  const double first = std::asin(from / radius), step = (std::asin(to / radius) - first) / slices;
  double sum = 0;
  for (int k = 0; k < slices; ++k) {
    const double across = radius * std::cos(first + (k + 0.5) * step);
    sum += across * (common_area(distance, across, ring.outer) - common_area(distance, across, ring.inner));
  }
  return sum * step;
}

}  // namespace silt
