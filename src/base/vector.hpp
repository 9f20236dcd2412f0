#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace silt {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Eigen::Map;

/// The three doubles at p as a vector (no copy).
inline Map<Vec3> vec3(double* p) { return Map<Vec3>(p); }
inline Map<const Vec3> vec3(const double* p) { return Map<const Vec3>(p); }

}  // namespace silt
