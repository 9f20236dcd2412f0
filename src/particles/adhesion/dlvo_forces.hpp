#pragma once
#include "particles/contact.hpp"

namespace silt {

/// Van der Waals force between two spheres at the gap h (7.45-7.46; the print of the potential loses its minus sign),
/// Hamaker 1937 for unequal radii (the formula of VdwDlvo), written without differences of large numbers. 1/R_j = 0 is
/// a wall. N, < 0 attractive
template <class Real>
SILT_INLINE Real hamaker_force(Real hamaker, Real gap, Real radius, Real inverse_other) {
  const Real one(1.0), two(2.0), wide = two * radius + gap;
  const Real outer = gap * (two + inverse_other * wide), inner = wide * (two + inverse_other * gap);
  return Real(-32.0 / 3.0) * hamaker * radius * radius * radius * (one + inverse_other * (radius + gap)) /
         (outer * outer * inner * inner);
}

/// Force between two double layers of constant potentials at the gap h (7.47), Hogg, Healy & Fuerstenau 1966 (the
/// formula of ElectrostaticDlvo). `permittivity` is 2 pi eps. N, > 0 repulsive
template <class Real>
SILT_INLINE Real double_layer_force(Real permittivity, Real product, Real squares, Real inverse_length, Real gap,
                                    Real effective_radius) {
  const Real e = exp(Real(0.0) - inverse_length * gap);
  return permittivity * effective_radius * inverse_length * e * (Real(2.0) * product - squares * e) /
         (Real(1.0) - e * e);
}

}  // namespace silt
