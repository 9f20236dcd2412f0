#pragma once
#include "particles/contact.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Takes the normal part `along` of a displacement away and gives it its length back, to fourth order in the small
/// angle turned in a step; `share` is the square of that part over the square of the whole.
template <class Real>
SILT_INLINE void keep_length(Real* spring, const Real* normal, Real along, Real share) {
  const Real stretch = Real(1.0) + share * (Real(0.5) + Real(0.375) * share);
  for (int d = 0; d < 3; ++d) spring[d] = stretch * (spring[d] - along * normal[d]);
}

/// Turns an accumulated displacement into the present tangent plane.
template <class Real>
SILT_INLINE void turn_into_plane(Real* spring, const Real* normal) {
  const Real along = dot(spring, normal);
  keep_length(spring, normal, along, along * along / larger(dot(spring, spring), Real(1e-300)));
}

/// Where within a step of dt the spring is read: the velocity of a contact is that predicted for the step's end, so a
/// spring grown by all of dt V_t is ahead by half a step and damps the oscillation by w dt/4 a radian, one grown by
/// half is read at the right place (second order) but gains (w dt)^3/8 a radian by the predictor. With w^2 = 7/2
/// k/m_eff the share 1/2 + (w dt)^2/4 would be neutral; twice that excess leaves a damping of third order, also where
/// several contacts hold a particle. With semi-implicit Euler the velocity is the one that moved the particle over the
/// whole step, and so is the spring's: `least` is 1 then, else 1/2.
template <class Real>
SILT_INLINE Real share_of_step(Real least, Real square) {  // of w dt
  return smaller(least + Real(0.5) * square, Real(1.0));
}
template <class Real>
SILT_INLINE Real share_of_step(Real least, Real stiffness, Real mass, Real dt) {
  return share_of_step(least, Real(3.5) * stiffness * dt * dt / mass);
}

/// Spring k and dashpot gamma with the Coulomb limit (7.33): force = -(k zeta + gamma V_t), cut to mu |F_n| in length;
/// at the limit the spring is cut back to what the limited force leaves for it, so that it starts to unload at once on
/// reversal. `spring` is history: the tangential displacement zeta since the contact was made, in the present tangent
/// plane, as it will be when the rest of the step (see share_of_step) has passed.
template <class Real>
SILT_INLINE void limited_spring_dashpot(const Contact<Real>& contact, Real normal_force, Real friction, Real stiffness,
                                        Real damping, Real least_share, Real dt, Real* spring, Real* force) {
  // Two divisions serve all: the loop over contacts waits for the divider, and for nothing else.
  const Real zero(0.0), one(1.0), least(1e-100);
  const Real along = dot(spring, contact.normal), square = larger(dot(spring, spring), least * least);
  const Real inverse = one / (square * contact.effective_mass);
  keep_length(spring, contact.normal, along, along * along * contact.effective_mass * inverse);
  const Real turning = Real(3.5) * stiffness * dt * dt * square * inverse;
  const Real read = dt * share_of_step(least_share, turning), rest = dt - read;
  Real trial[3];
  for (int d = 0; d < 3; ++d) {
    spring[d] = spring[d] + read * contact.slip[d];
    trial[d] = stiffness * spring[d] + damping * contact.slip[d];
  }
  const Real length = sqrt(dot(trial, trial)), stiff = larger(stiffness, least);
  const Real limit = friction * larger(normal_force, zero - normal_force);
  const Real over = one / (larger(length, least) * stiff);
  const Real kept = select(length > limit, limit * stiff * over, one);
  const Real cut = select(length > limit, (length - limit) * over, zero);
  for (int d = 0; d < 3; ++d) {
    force[d] = zero - kept * trial[d];
    spring[d] = spring[d] - cut * trial[d] + rest * contact.slip[d];
  }
}

}  // namespace silt
