#pragma once
#include <cmath>
#include <numbers>

#include "base/options.hpp"
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

/// What an explicit step must resolve of a dashpot: pi m / gamma, as of an overdamped contact. s
inline double damping_duration(double mass, double damping) {
  return damping > 0 ? std::numbers::pi * mass / damping : infinity;
}

}  // namespace silt
