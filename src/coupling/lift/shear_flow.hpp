#pragma once
#include "base/vector.hpp"

namespace silt {

/// What lift and torque need to know of the flow around one particle.
struct ShearFlow {
  double diameter, density, viscosity;  ///< m; kg/m3 and Pa s of the fluid
  Vec3 slip;                            ///< m/s, u - v
  Vec3 vorticity;                       ///< 1/s, curl u
  Vec3 spin;                            ///< rad/s, w of the particle

  double reynolds() const { return density * diameter * slip.norm() / viscosity; }
  /// rad/s, of the fluid relative to the particle: curl u / 2 - w.
  Vec3 relative_spin() const { return 0.5 * vorticity - spin; }
};

}  // namespace silt
