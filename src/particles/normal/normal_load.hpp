#pragma once

namespace silt {

/// What a normal law tells the other laws of the contact.
template <class Real>
struct NormalLoad {
  Real force;           ///< N, > 0 repulsive
  Real damping;         ///< kg/s, coefficient of the approach speed
  Real contact_radius;  ///< m, a = sqrt(R_eff x) unless the law knows better
};

}  // namespace silt
