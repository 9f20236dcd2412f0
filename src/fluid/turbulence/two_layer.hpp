#pragma once
#include <algorithm>
#include <cmath>

#include "fluid/turbulence/wall_law.hpp"

namespace silt {

/// The one-equation layer of k-epsilon along resolved walls: epsilon and eddy viscosity by lengths where Re_y =
/// sqrt(k) y/nu < 200 (Wolfshtein 1969; Chen & Patel, AIAA J. 26 (1988) 641; docs/theory/turbulence.md, T18).
namespace two_layer {

inline constexpr double reach = 200, width = 10;  ///< Re_y where the layers meet, and over which they blend
inline const double c_l = wall_law::kappa / std::pow(wall_law::C_mu, 0.75);

inline double reynolds(double nu, double k, double y) { return std::sqrt(k) * std::min(y, 1e30) / nu; }
inline bool holds(double nu, double k, double y) { return reynolds(nu, k, y) < reach; }

/// k^(3/2)/l_epsilon, l_epsilon = c_l y (1 - exp(-Re_y/(2 c_l))); 2 nu k/y^2 on the wall.
inline double dissipation(double nu, double k, double y) {
  const double Re = reynolds(nu, k, y);
  if (Re < 1e-6) return 2 * nu * k / (y * y);
  return k * std::sqrt(k) / (-c_l * y * std::expm1(-Re / (2 * c_l)));
}

/// rho C_mu l_mu sqrt(k), l_mu = c_l y (1 - exp(-Re_y/70)), blended into `outside`.
inline double eddy_viscosity(double outside, double rho, double mu, double k, double y) {
  const double Re = reynolds(mu / rho, k, y), share = 0.5 * (1 + std::tanh((Re - reach) / width));
  if (share > 1 - 1e-12) return outside;
  return share * outside - (1 - share) * rho * wall_law::C_mu * c_l * y * std::expm1(-Re / 70) * std::sqrt(k);
}

}  // namespace two_layer
}  // namespace silt
