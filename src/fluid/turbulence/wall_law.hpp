#pragma once
#include <algorithm>
#include <cmath>

namespace silt {

/// The logarithmic law of the wall (docs/theory/turbulence.md, T16).
namespace wall_law {

inline constexpr double C_mu = 0.09;
inline constexpr double kappa = 0.41, E = 8.432;  ///< u+ = ln(E y+)/kappa = ln(y+)/0.41 + 5.2
inline constexpr double sublayer = 11.06;         ///< y+ at which ln(E y+)/kappa = y+

/// u+ of the logarithmic layer.
inline double speed(double y_plus) { return std::log(E * std::max(y_plus, sublayer)) / kappa; }

/// T+ by Kader (Int. J. Heat Mass Transfer 24 (1981) 1541), turbulent Prandtl number 0.85.
inline double temperature(double y_plus, double Pr) {
  const double y = std::max(y_plus, 1e-10), p = Pr * y;
  const double gamma = 0.01 * std::pow(p, 4) / (1 + 5 * Pr * Pr * p);
  const double beta = std::pow(3.85 * std::cbrt(Pr) - 1.3, 2) + 2.12 * std::log(Pr);
  return p * std::exp(-gamma) + (2.12 * std::log(1 + y) + beta) * std::exp(-1 / gamma);
}

}  // namespace wall_law
}  // namespace silt
