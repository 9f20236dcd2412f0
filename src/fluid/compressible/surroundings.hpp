#pragma once
#include <algorithm>
#include <cmath>

#include "fluid/compressible/open_boundary.hpp"

namespace silt {

/// Share of the way to the pressure outside that the pressure of the incoming wave goes in a step: the rate is
/// 0.27 c (1 - M^2)/L, M the Mach number through the boundary (Rudy & Strikwerda 1980).
inline double relaxation(const GasLaw& gas, double T, double through, double dt, double length) {
  const double c2 = gas.gamma * T;
  return 1 - std::exp(-0.27 * std::sqrt(c2) * std::max(0.0, 1 - through * through / c2) * dt / length);
}

/// The outside of a far field during a step, from the state inside at its start (docs/theory/compressible.md, C8a). A
/// jet that leaves into gas at rest does not meet gas at rest, and gas drawn in from rest comes with a velocity: what
/// is known outside is the static pressure of what leaves, the stagnation pressure and temperature of what enters, and
/// the incoming wave changes at the rate at which the pressure relaxes to that. A stream outside that enters
/// counts as given.
inline void follow_inside(const GasLaw& gas, OpenBoundary& outside, double p, const double* u, double T,
                          const double* n, int dim, double dt, double length) {
  const double far_sound = std::sqrt(gas.gamma * outside.T);
  double far = 0, through = 0;
  for (int i = 0; i < dim; ++i) far += outside.u[i] * n[i], through += u[i] * n[i];
  const bool still = std::abs(far) < 1e-6 * far_sound;
  if (far < 0 && !still) return;
  const double share = relaxation(gas, T, through, dt, length), exponent = (gas.gamma - 1) / gas.gamma;
  if (through > std::max(far, 0.0)) {
    const double at = p + share * (outside.p - p);
    outside.T = T * std::pow(at / p, exponent);
    outside.p = at;
    std::copy_n(u, dim, outside.u);
  } else if (still && through < 0) {
    const double enters = std::max(through, -0.9 * far_sound);
    const double at = outside.T - enters * enters / (2 * gas.cp());
    const double drawn = outside.p * std::pow(at / outside.T, 1 / exponent);
    outside.p = p + share * (drawn - p);
    outside.T = at;
    for (int i = 0; i < dim; ++i) outside.u[i] += (enters - far) * n[i];
  }
}

}  // namespace silt
