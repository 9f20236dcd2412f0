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

/// Spring k and dashpot gamma of a contact, N/m and kg/s.
template <class Real>
struct SpringLaw {
  Real stiffness, damping;
};

/// Spring and dashpot with the Coulomb limit (7.33), in two parts that run over many contacts each, one loop after the
/// other: in a single loop a processor waits for one quotient after another, for it has no room for the next contacts.
/// First part: `spring`, the tangential displacement zeta since the contact was made, in the tangent plane of the step
/// before and as it is at that step's end, m, is turned into the present plane and grows by the slip up to where it is
/// read. Returns what is then left of the step, s.
template <class Real>
SILT_INLINE Real grow_spring(const Contact<Real>& contact, Real stiffness, Real least_share, Real dt, Real* spring) {
  const Real one(1.0), least(1e-200);
  const Real along = dot(spring, contact.normal), square = larger(dot(spring, spring), least);
  const Real inverse = one / (square * contact.effective_mass);  // one division serves both
  keep_length(spring, contact.normal, along, along * along * contact.effective_mass * inverse);
  const Real read = dt * share_of_step(least_share, Real(3.5) * stiffness * dt * dt * square * inverse);
  for (int d = 0; d < 3; ++d) spring[d] = spring[d] + read * contact.slip[d];
  return dt - read;
}

/// Second part: force = -(k zeta + gamma V_t), N, cut to mu |F_n| in length; at the limit the spring is cut back to
/// what the limited force leaves for it, so that it starts to unload at once on reversal, but not beyond nothing: where
/// the dashpot alone is above the limit (the first touch of a fast slip) a spring the other way round would be wound
/// up, and push the slip on when k has grown. Then it grows by the `rest` (s) of the step.
template <class Real>
SILT_INLINE void limit_spring(const Contact<Real>& contact, Real normal_force, Real friction,
                              const SpringLaw<Real>& law, Real rest, Real* spring, Real* force) {
  const Real zero(0.0), one(1.0), least(1e-100);
  Real trial[3];
  for (int d = 0; d < 3; ++d) trial[d] = law.stiffness * spring[d] + law.damping * contact.slip[d];
  const Real length = sqrt(dot(trial, trial)), stiff = larger(law.stiffness, least);
  const Real limit = friction * larger(normal_force, zero - normal_force);
  const Real over = one / (larger(length, least) * stiff);  // here too
  const Real kept = select(length > limit, limit * stiff * over, one);
  const Real borne = law.stiffness * dot(spring, trial) * stiff * over;  // N, by the spring along the trial force
  const Real cut = select(length > limit, smaller(length - limit, larger(borne, zero)) * over, zero);
  for (int d = 0; d < 3; ++d) {
    force[d] = zero - kept * trial[d];
    spring[d] = spring[d] - cut * trial[d] + rest * contact.slip[d];
  }
}

}  // namespace silt
