#pragma once
#include <Eigen/Geometry>

#include "base/vector.hpp"

namespace silt {

/// Turns vectors that are fixed in the particles ([count][3]) by the rotation vectors of a step (rad).
inline void turn_vectors(double* vectors, const double (*turned)[4], int count) {
  for (int p = 0; p < count; ++p) {
    const Vec3 way = vec3(turned[p]);
    const double angle = way.norm();
    if (angle == 0) continue;
    const Vec3 before = vec3(&vectors[3 * static_cast<std::size_t>(p)]);
    vec3(&vectors[3 * static_cast<std::size_t>(p)]) = Eigen::AngleAxisd(angle, way / angle) * before;
  }
}

}  // namespace silt
