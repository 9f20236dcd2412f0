#pragma once
#include <algorithm>
#include <cmath>

#include "fluid/compressible/gas.hpp"

namespace silt {

/// What stands outside an open boundary of compressible flow; which members count depends on the kind.
struct OpenBoundary {
  enum Kind { pressure, total_pressure, mass_flow, far_field, supersonic_inflow, supersonic_outflow, velocity };
  Kind kind = supersonic_outflow;
  double p = 1, T = 1, u[3] = {0, 0, 0};
  double inflow = 0;             ///< mass per area and time into the domain (mass_flow)
  bool has_pressure = false;     ///< velocity: p is that of gas which enters
  bool has_temperature = false;  ///< pressure: T is that of gas which enters

  /// far_field: gas enters at sonic speed (nozzles) or more: nothing of the inside counts.
  bool enters_sonic(const GasLaw& gas, const double* n, int dim) const {
    double entering = 0;
    for (int i = 0; i < dim; ++i) entering -= u[i] * n[i];
    return entering > 0.999 * std::sqrt(gas.gamma * T);
  }
};

namespace detail {
template <class S>
S power(const S& x, double exponent) {
  if constexpr (sizeof(S) == sizeof(double))
    return std::pow(x, exponent);
  else
    return chain(x, std::pow(x.value, exponent), exponent * std::pow(x.value, exponent - 1));
}
template <class S>
double value_of(const S& x) {
  if constexpr (sizeof(S) == sizeof(double))
    return x;
  else
    return x.value;
}
}  // namespace detail

/// The Euler flux through an open boundary with outward unit normal n, from the state inside (docs/theory/
/// compressible.md, C8 to C12).
template <class S, int dim>
void open_flux(const GasLaw& gas, const OpenBoundary& outside, const GasState<S, dim>& inside, const double* n,
               S (&F)[dim + 2]) {
  using detail::power, detail::value_of;
  constexpr int size = dim + 2;
  const double g = gas.gamma;
  S un = inside.u[0] * n[0];
  for (int i = 1; i < dim; ++i) un += inside.u[i] * n[i];
  const bool leaves_fast = value_of(un) >= std::sqrt(g * value_of(inside.T));
  GasState<S, dim> at = inside;
  switch (outside.kind) {
    case OpenBoundary::velocity:
      if (outside.has_pressure && value_of(un) < 0) at.p = S(outside.p);
      break;
    case OpenBoundary::supersonic_outflow:
      break;
    case OpenBoundary::supersonic_inflow:
      at.p = S(outside.p), at.T = S(outside.T);
      for (int i = 0; i < dim; ++i) at.u[i] = S(outside.u[i]);
      break;
    case OpenBoundary::pressure:
      if (leaves_fast) break;
      at.p = S(outside.p);
      if (value_of(un) < 0) {
        if (outside.has_temperature) at.T = S(outside.T);
        for (int i = 0; i < dim; ++i) at.u[i] = un * n[i];
      }
      break;
    case OpenBoundary::total_pressure: {
      // Isentropic from rest, along the normal; above the total pressure inside, gas leaves against it.
      if (value_of(inside.p) >= outside.p) {
        at.p = S(outside.p);
        if (value_of(un) < 0) {
          at.T = S(outside.T);
          for (int i = 0; i < dim; ++i) at.u[i] = S(0.0);
        }
        break;
      }
      const double choked = outside.p * std::pow(2 / (g + 1), g / (g - 1));
      at.p = value_of(inside.p) < choked ? S(choked) : inside.p;
      const S ratio = power(S(S(outside.p) / at.p), (g - 1) / g);  // T_0/T
      at.T = S(outside.T) / ratio;
      const S mach2 = (ratio - S(1.0)) * (2 / (g - 1));
      const S speed = square_root(S(mach2 * at.T * g));
      for (int i = 0; i < dim; ++i) at.u[i] = speed * (-n[i]);
      break;
    }
    case OpenBoundary::mass_flow: {
      at.T = S(outside.T);
      const S speed = at.T / at.p * outside.inflow;
      for (int i = 0; i < dim; ++i) at.u[i] = speed * (-n[i]);
      break;
    }
    case OpenBoundary::far_field: {
      GasState<S, dim> far;
      far.p = S(outside.p), far.T = S(outside.T);
      for (int i = 0; i < dim; ++i) far.u[i] = S(outside.u[i]);
      if (outside.enters_sonic(gas, n, dim)) {
        at = far;
        break;
      }
      if (leaves_fast) break;
      S Uin[size], Uout[size], Fout[size], jump[size], wave[size];
      inside.conserved(gas, Uin);
      far.conserved(gas, Uout);
      inside.flux(gas, n, F);
      far.flux(gas, n, Fout);
      for (int k = 0; k < size; ++k) jump[k] = Uout[k] - Uin[k];
      absolute_flux<S, dim>(gas, inside, n, jump, 0.05, wave);
      for (int k = 0; k < size; ++k) F[k] = (F[k] + Fout[k] - wave[k]) * 0.5;
      return;
    }
  }
  at.flux(gas, n, F);
}

}  // namespace silt
