#pragma once
#include <Eigen/Geometry>

#include "base/vector.hpp"
#include "particles/store.hpp"

namespace silt {

/// Turns vectors that are fixed in the particles by their spin over the last step dt: by the spin in its middle, which
/// is half a step of the old torque behind the present one.
inline void turn_with_particles(const Store& store, double dt, double* vectors) {
  if (dt == 0) return;
  for (int p = 0; p < store.owned; ++p) {
    const Motion& motion = store.motion[p];
    const double inverse_inertia = 2.5 * motion.inverse_mass / (motion.radius * motion.radius);
    const Vec3 spin = vec3(store.rotation[p].spin) - 0.5 * dt * inverse_inertia * vec3(store.previous[p].torque);
    const double rate = spin.norm();
    if (rate == 0) continue;
    const Vec3 before = vec3(&vectors[3 * p]);
    vec3(&vectors[3 * p]) = Eigen::AngleAxisd(rate * dt, spin / rate) * before;
  }
}

}  // namespace silt
