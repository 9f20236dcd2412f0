#pragma once
#include <cmath>

namespace silt {

/// Tabor parameter (7.53), by the formula of AutomaticAdhesion: reach of the neck over reach of the surface forces D
/// (m); g surface energy of the pair (J/m2). Below 0.1 dmt holds, above 3 jkr.
inline double tabor_parameter(double radius, double surface_energy, double young, double distance) {
  return std::cbrt(4 * radius * surface_energy * surface_energy / (young * young * distance * distance * distance));
}
inline constexpr double tabor_hard = 0.1, tabor_soft = 3;

}  // namespace silt
