#pragma once
#include "particles/contact.hpp"

namespace silt {

/// Relative rolling rate: w_i - w_j less its part along the normal. rad/s
template <class Real>
SILT_INLINE void rolling_rate(const Contact<Real>& contact, Real* rate) {
  const Real twist = dot(contact.spin, contact.normal);
  for (int d = 0; d < 3; ++d) rate[d] = contact.spin[d] - twist * contact.normal[d];
}

/// The torque that stops the relative rolling within the step (inertia 2/5 m_eff R_eff^2, a lower bound): a limit for
/// torques against the rate, so that a resting contact is not shaken by one that changes sign every step. N m
template <class Real>
SILT_INLINE Real stopping_torque(const Contact<Real>& contact, Real rate, Real dt) {
  return Real(0.4) * contact.effective_mass * contact.effective_radius * contact.effective_radius * rate /
         larger(dt, Real(1e-300));
}

}  // namespace silt
