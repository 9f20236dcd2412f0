#pragma once
#include <cmath>
#include <numbers>

#include "base/options.hpp"
#include "particles/contact.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Largest overlap of an elastic Hertz collision, (5 m_eff v^2 / (4 k))^(2/5), k in N/m^1.5. m
inline double hertz_overlap(double k, double mass, double speed) {
  return std::pow(1.25 * mass * speed * speed / k, 0.4);
}

/// Duration of an elastic Hertz collision, 2.943 x_max / v, k in N/m^1.5. s
inline double hertz_duration(double k, double mass, double speed) {
  return speed > 0 ? 2.943275 * hertz_overlap(k, mass, speed) / speed : infinity;
}

/// Hertz spring (N) with `stiffness` = 4/3 E_eff (Pa), as a reading at the end of a step; `overlap` is not negative,
/// contact_radius = sqrt(R_eff overlap).
///
/// The force begins and ends like t^1.5 somewhere within a step, so the sum of its readings is off its integral by
/// k (|v| h)^1.5 zeta(-1.5, s) h, s h from the meeting to the first reading (Navot 1961), and the same at the parting:
/// every collision would gain or lose energy by chance. The two readings next to that instant, s h and (1 + s) h away,
/// take the error off, with the shares s and 1 - s, so that the force stays continuous.
template <class Real>
SILT_INLINE Real hertz_reading(const Contact<Real>& contact, Real stiffness, Real overlap, Real contact_radius) {
  const Real force = stiffness * contact_radius * overlap, way = magnitude(contact.approach) * contact.dt;
  const auto next_to_end = overlap < way + way;
  if (!any_lane(next_to_end)) return force;
  const Real one(1.0), steps = smaller(overlap / larger(way, Real(1e-300)), Real(2.0));
  const Real s = select(steps < one, steps, steps - one), share = one - magnitude(steps - one);
  // -zeta(-1.5, 1 + s) for s from 0 to 1, to 2e-6.
  const Real zeta = Real(0.0254869) +
                    s * (Real(0.3117564) +
                         s * (Real(0.5484106) + s * (Real(0.1598428) + s * (Real(-0.0238279) + s * Real(0.0038177)))));
  const Real lacking = stiffness * sqrt(contact.effective_radius * way) * way * (zeta - s * sqrt(s));
  return force + select(next_to_end, share * lacking, Real(0.0));
}

/// What an explicit step must resolve of a dashpot: pi m / gamma, as of an overdamped contact. s
inline double damping_duration(double mass, double damping) {
  return damping > 0 ? std::numbers::pi * mass / damping : infinity;
}

}  // namespace silt
