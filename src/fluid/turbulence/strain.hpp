#pragma once
#include <cmath>

#include "base/vector.hpp"

namespace silt {

/// The invariants of a velocity gradient g (row i: gradient of u_i), 1/s and powers of it.
struct Strain {
  double shear = 0;       ///< S = sqrt(2 S_ij S_ij), S_ij the deviatoric rate of strain
  double vorticity = 0;   ///< sqrt(2 W_ij W_ij)
  double cubic = 0;       ///< sqrt(6) S_ij S_jk S_ki / (S_ij S_ij)^(3/2), in [-1, 1]
  double dilatation = 0;  ///< div u
};

inline Strain strain(const Mat3& g) {
  const double third = g.trace() / 3;
  const Mat3 S = 0.5 * (g + g.transpose()) - third * Mat3::Identity(), W = 0.5 * (g - g.transpose());
  const double SS = S.squaredNorm();
  Strain result{std::sqrt(2 * SS), std::sqrt(2 * W.squaredNorm()), 0, g.trace()};
  if (SS > 1e-200) result.cubic = std::sqrt(6.0) * (S * S * S).trace() / (SS * std::sqrt(SS));
  return result;
}

}  // namespace silt
