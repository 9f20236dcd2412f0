#pragma once
#include <cmath>
#include <numbers>

namespace silt {

/// What a drag law needs to know of the flow around one particle.
struct FlowAround {
  double diameter;       ///< m
  double void_fraction;  ///< alpha, fluid fraction around the particle
  double density;        ///< kg/m3, of the fluid
  double viscosity;      ///< Pa s, of the fluid
  double speed;          ///< m/s, |u - v|, u the interstitial velocity
  double mach = 0;       ///< speed over the fluid's speed of sound; 0 where that is not solved for

  /// Exchange coefficient of Stokes' drag, 3 pi mu d. kg/s
  double stokes() const { return 3 * std::numbers::pi * viscosity * diameter; }
  /// rho d |u - v| / mu
  double reynolds() const { return density * diameter * speed / viscosity; }
  /// With the superficial velocity: alpha rho d |u - v| / mu
  double superficial_reynolds() const { return void_fraction * reynolds(); }
};

/// C_D Re / 24 of a sphere, the drag over Stokes', by the formula of SchillerNaumannDrag.
inline double schiller_naumann_factor(double reynolds) {
  if (reynolds > 1000) return 0.44 * reynolds / 24;
  return 1 + 0.15 * std::pow(reynolds, 0.687);
}

/// C_D Re / 24 by Dallavalle (1948), the formula of DiFeliceDrag. Tends to 0.96 as Re -> 0.
inline double dallavalle_factor(double reynolds) {
  const double root = 0.63 * std::sqrt(reynolds) + 4.8;
  return root * root / 24;
}

}  // namespace silt
