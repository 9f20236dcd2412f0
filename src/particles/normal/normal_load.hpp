#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/options.hpp"

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
  double mass;             ///< kg, effective
  double radius;           ///< m, effective
  double distance;         ///< m, R_i + R_j, at a wall R_i
  double speed;            ///< m/s, of approach
  double radius_i;         ///< m
  double rolling_inertia;  ///< kg m2, as of Contact
};

/// A sphere of mass m_i and radius R_i and another one, or a wall of infinite mass and radius.
inline Encounter meeting(double mass_i, double radius_i, double mass_j, double radius_j, double speed) {
  const auto half = [](double i, double j) { return j < infinity ? i * j / (i + j) : i; };
  return {half(mass_i, mass_j),
          half(radius_i, radius_j),
          radius_j < infinity ? radius_i + radius_j : radius_i,
          speed,
          radius_i,
          half(1.4 * mass_i * radius_i * radius_i, 1.4 * mass_j * radius_j * radius_j)};
}

/// Half a swing of a spring on an inertia, or what an explicit step must resolve of a dashpot: the shorter. What
/// neither holds takes for ever. kg or kg m2; N/m or N m; kg/s or N m s; s
inline double swing_duration(double inertia, double stiffness, double damping) {
  const double spring = stiffness > 0 ? std::numbers::pi * std::sqrt(inertia / stiffness) : infinity;
  return damping > 0 ? std::min(spring, std::numbers::pi * inertia / damping) : spring;
}

}  // namespace silt
