#pragma once
#include "particles/real.hpp"

namespace silt {

/// Turns a unit quaternion q (w, x, y, z; from the particle's axes to those of space) by the rotation vector (x, y, z)
/// (rad) about the axes of space: exactly, q <- (cos |r|/2, sin |r|/2 r/|r|) q, and back to unit length.
SILT_INLINE void turn_by(double* q, double x, double y, double z) {
  const double square = x * x + y * y + z * z, angle = __builtin_sqrt(square);
  const double c = __builtin_cos(0.5 * angle);
  const double s = angle > 1e-8 ? __builtin_sin(0.5 * angle) / angle : 0.5 - square / 48;
  const double rx = s * x, ry = s * y, rz = s * z;
  const double turned[4] = {c * q[0] - rx * q[1] - ry * q[2] - rz * q[3], c * q[1] + rx * q[0] + ry * q[3] - rz * q[2],
                            c * q[2] + ry * q[0] + rz * q[1] - rx * q[3], c * q[3] + rz * q[0] + rx * q[2] - ry * q[1]};
  const double norm = turned[0] * turned[0] + turned[1] * turned[1] + turned[2] * turned[2] + turned[3] * turned[3];
  const double length = 1 / __builtin_sqrt(norm);
  for (int k = 0; k < 4; ++k) q[k] = length * turned[k];
}

}  // namespace silt
