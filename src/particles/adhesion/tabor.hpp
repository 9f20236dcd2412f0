#pragma once
#include <cmath>

namespace silt {

/// Tabor parameter (7.53), mu_T = (4 R_eff g^2/(E_eff^2 D^3))^(1/3): reach of the neck over reach of the surface forces
/// D (m); g surface energy of the pair (J/m2). Below 0.1 dmt holds, above 3 jkr.
inline double tabor_parameter(double radius, double surface_energy, double young, double distance) {
  return std::cbrt(4 * radius * surface_energy * surface_energy / (young * young * distance * distance * distance));
}
inline constexpr double tabor_hard = 0.1, tabor_soft = 3;

}  // namespace silt
