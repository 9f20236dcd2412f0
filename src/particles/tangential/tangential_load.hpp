#pragma once
#include "particles/contact.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Turns an accumulated displacement into the present tangent plane: its normal part is taken away and its length kept
/// (to fourth order in the small angle turned in a step).
template <class Real>
SILT_INLINE void turn_into_plane(Real* spring, const Real* normal) {
  const Real along = dot(spring, normal);
  const Real square = dot(spring, spring);
  const Real share = along * along / larger(square, Real(1e-300));
  const Real stretch = Real(1.0) + share * (Real(0.5) + Real(0.375) * share);
  for (int d = 0; d < 3; ++d) spring[d] = stretch * (spring[d] - along * normal[d]);
}

/// Spring k and dashpot gamma with the Coulomb limit (7.33): force = -(k zeta + gamma V_t), cut to mu |F_n| in length;
/// at the limit the spring is cut back to what the limited force leaves for it, so that it starts to unload at once on
/// reversal. zeta is history: the tangential displacement since the contact was made, in the present tangent plane.
template <class Real>
SILT_INLINE void limited_spring_dashpot(const Contact<Real>& contact, Real normal_force, Real friction, Real stiffness,
                                        Real damping, Real dt, Real* spring, Real* force) {
  turn_into_plane(spring, contact.normal);
  Real trial[3];
  for (int d = 0; d < 3; ++d) {
    spring[d] = spring[d] + dt * contact.slip[d];
    trial[d] = stiffness * spring[d] + damping * contact.slip[d];
  }
  const Real zero(0.0), one(1.0), least(1e-300);
  const Real length = sqrt(dot(trial, trial));
  const Real limit = friction * larger(normal_force, zero - normal_force);
  const Real kept = select(length > limit, limit / larger(length, least), one);
  const Real cut = select(length > limit, (one - kept) / larger(stiffness, least), zero);
  for (int d = 0; d < 3; ++d) {
    force[d] = zero - kept * trial[d];
    spring[d] = spring[d] - cut * trial[d];
  }
}

}  // namespace silt
