#pragma once
#include "particles/contact.hpp"

namespace silt {

/// The share of a step of dt that has passed since surfaces that move with `speed` passed a place that is `past`
/// behind.
template <class Real>
SILT_INLINE Real step_share(Real past, Real speed, Real dt) {
  return smaller(larger(past, Real(0.0)) / larger(speed * dt, Real(1e-300)), Real(1.0));
}

/// A force that jumps where two surfaces pass a place (a dashpot's where they meet, a neck's where it breaks) acts for
/// a part of the step only in which they pass it. The integrator gives every reading of a force half of the step before
/// and half of the step after it; so, after a jump J the time t before the reading, a step h long lacks (t/h - 1/2) J
/// of what it should have got, an error of first order. This is what makes it good (N, to be added to the one reading
/// that follows the jump): the work is then right to second order. `past` (m): how far beyond the place the surfaces
/// are, `speed` (m/s): how fast they went.
template <class Real>
SILT_INLINE Real made_good(Real jump, Real past, Real speed, Real dt) {
  return select(dt > Real(0.0), jump * (step_share(past, speed, dt) - Real(0.5)), Real(0.0));
}

/// History of a law whose force jumps where the surfaces meet and where they part.
template <class Real>
struct Meeting {
  Real together;  ///< 1 from the first reading in which the law acts to the last
};

/// What makes good the jump of a force that is `force` (N) just inside the place and nothing outside; `depth` (m), how
/// deep inside the surfaces are, grows with their approach.
template <class Real>
SILT_INLINE Real jump_at_meeting(const Contact<Real>& contact, Real depth, Real force, Meeting<Real>& history) {
  const Real now = select(depth > Real(0.0), Real(1.0), Real(0.0));
  const Real change = now - history.together;  // 1: they have met, -1: they have parted
  history.together = now;
  return made_good(change * force, magnitude(depth), magnitude(contact.approach), contact.dt);
}

}  // namespace silt
