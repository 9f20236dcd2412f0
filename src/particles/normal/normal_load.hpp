#pragma once

namespace silt {

/// What a normal law tells the other laws of the contact.
template <class Real>
struct NormalLoad {
  Real force;             ///< N, > 0 repulsive; with it the surfaces press on each other, so it limits friction
  Real damping;           ///< kg/s, coefficient of the approach speed
  Real contact_radius;    ///< m, a = sqrt(R_eff x) unless the law knows better
  Real stiffness;         ///< N/m, slope of the force over the overlap at constant approach
  Real pull_off;          ///< N, what it takes to pull the surfaces apart; 0 without adhesion (an adhesion sets it)
  Real jump = Real(0.0);  ///< N, makes good a jump of the force within the step (force_jump.hpp); limits no friction
};

/// Two bodies that meet, for estimates of durations.
struct Encounter {
  double mass;      ///< kg, effective
  double radius;    ///< m, effective
  double distance;  ///< m, R_i + R_j, at a wall R_i
  double speed;     ///< m/s, of approach
  double radius_i;  ///< m
};

}  // namespace silt
