#pragma once

namespace silt {

/// Part of space between two radii about an axis and between two heights along it.
struct Ring {
  double inner = 0, outer = 0;  ///< m
  double low = 0, high = 0;     ///< m, along the axis
  double volume() const;
};

/// Volume of the part of a sphere in a ring, to 1e-4 of the sphere's. `distance`, `height`: of its centre from and
/// along the axis. m3
double volume_in_ring(double distance, double height, double radius, const Ring& ring);

}  // namespace silt
