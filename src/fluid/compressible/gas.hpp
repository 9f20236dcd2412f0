#pragma once
#include <cmath>

#include "base/dual.hpp"

namespace silt {

/// Equation of state and transport of the gas, in the units of the compressible scheme: pressure in p_0, temperature in
/// T_0, speed in sqrt(R T_0), so that rho = p/T and the gas constant is 1; lengths stay in metres.
struct GasLaw {
  double gamma = 1.4;
  double viscosity = 0;  ///< at T = 1
  double prandtl = 0.71;
  double sutherland = 0;  ///< S/T_0; 0 with `constant`
  bool constant_viscosity = true;

  // Inlined always: code of a unit for one instruction set must not serve others.
  [[gnu::always_inline]] double cv() const { return 1 / (gamma - 1); }
  [[gnu::always_inline]] double cp() const { return gamma / (gamma - 1); }
  /// Sutherland (1893): mu = mu_0 T^1.5 (1 + S)/(T + S).                                                      (C4)
  template <class S>
  S mu(const S& T) const {
    if (constant_viscosity) return T * 0.0 + viscosity;
    return T * square_root(T) * (viscosity * (1 + sutherland)) / (T + sutherland);
  }
  template <class S>
  S mu_slope(const S& T) const {
    return constant_viscosity ? S{} : S(mu(T) * (1.5 / T - 1.0 / (T + sutherland)));
  }
};

/// Pressure, velocity, temperature at a point; S is double or a dual number.
template <class S, int dim>
struct GasState {
  static constexpr int size = dim + 2;
  S p, u[dim], T;

  S density() const { return p / T; }
  S kinetic() const {
    S sum = u[0] * u[0];
    for (int i = 1; i < dim; ++i) sum += u[i] * u[i];
    return sum * 0.5;
  }
  /// rho, rho u, rho E.
  void conserved(const GasLaw& gas, S (&U)[size]) const {
    const S rho = density();
    U[0] = rho;
    for (int i = 0; i < dim; ++i) U[1 + i] = rho * u[i];
    U[dim + 1] = p * gas.cv() + rho * kinetic();
  }
  /// Euler flux through the normal n (any length).
  void flux(const GasLaw& gas, const double* n, S (&F)[size]) const {
    S U[size];
    conserved(gas, U);
    S through = u[0] * n[0];
    for (int i = 1; i < dim; ++i) through += u[i] * n[i];
    for (int k = 0; k < size; ++k) F[k] = U[k] * through;
    for (int i = 0; i < dim; ++i) F[1 + i] += p * n[i];
    F[dim + 1] += p * through;
  }
};

/// d(conserved)/d(p, u, T), row by row.
template <class S, int dim>
void conserved_slope(const GasLaw& gas, const GasState<S, dim>& s, S (&A)[dim + 2][dim + 2]) {
  const S rho = s.density(), k = s.kinetic();
  for (auto& row : A)
    for (S& a : row) a = S{};
  A[0][0] = 1.0 / s.T;
  A[0][dim + 1] = -rho / s.T;
  for (int i = 0; i < dim; ++i) {
    A[1 + i][0] = s.u[i] / s.T;
    A[1 + i][1 + i] = rho;
    A[1 + i][dim + 1] = -rho * s.u[i] / s.T;
    A[dim + 1][1 + i] = rho * s.u[i];
  }
  A[dim + 1][0] = k / s.T + gas.cv();
  A[dim + 1][dim + 1] = -rho * k / s.T;
}

/// d(flux in direction i)/d(p, u, T).
template <class S, int dim>
void flux_slope(const GasLaw& gas, const GasState<S, dim>& s, int i, S (&A)[dim + 2][dim + 2]) {
  S U[dim + 2];
  s.conserved(gas, U);
  conserved_slope(gas, s, A);
  for (auto& row : A)
    for (S& a : row) a *= s.u[i];
  for (int k = 0; k < dim + 2; ++k) A[k][1 + i] += U[k];
  A[1 + i][0] += 1.0;
  A[dim + 1][0] += s.u[i];
  A[dim + 1][1 + i] += s.p;
}

/// |A_n| z, A_n = d(flux through n)/d(conserved) at the state s, n of unit length: eigenvalues by absolute value, not
/// below `floor` times |u_n| + c (Harten).
template <class S, int dim>
void absolute_flux(const GasLaw& gas, const GasState<S, dim>& s, const double* n, const S (&z)[dim + 2], double floor,
                   S (&out)[dim + 2]) {
  const auto magnitude = [](const S& x, const S& least) {
    S r = x;
    if constexpr (sizeof(S) == sizeof(double)) {
      r = x < 0 ? -x : x;
      if (r < least) r = least;
    } else {
      if (x.value < 0) r = -x;
      if (r.value < least.value) r = least;
    }
    return r;
  };
  const S rho = s.density(), k = s.kinetic();
  const S c2 = s.T * gas.gamma, c = square_root(c2);
  S un = s.u[0] * n[0];
  for (int i = 1; i < dim; ++i) un += s.u[i] * n[i];
  // Increments of density, velocity and pressure.
  S du[dim], work = s.u[0] * z[1], dun = S(0.0);
  for (int i = 0; i < dim; ++i) {
    du[i] = (z[1 + i] - s.u[i] * z[0]) / rho;
    dun += du[i] * n[i];
    if (i > 0) work += s.u[i] * z[1 + i];
  }
  const S dp = (z[dim + 1] - work + k * z[0]) * (gas.gamma - 1);
  const S least = (magnitude(un, S(0.0)) + c) * floor;
  const S slow = magnitude(S(un - c), least), middle = magnitude(un, least), fast = magnitude(S(un + c), least);
  const S wave = rho * c * dun;
  const S a1 = slow * (dp - wave) / (c2 * 2.0), a3 = fast * (dp + wave) / (c2 * 2.0);
  const S a2 = middle * (z[0] - dp / c2);
  const S H = c2 * (1 / (gas.gamma - 1)) + k;
  out[0] = a1 + a2 + a3;
  out[dim + 1] = a1 * (H - c * un) + a3 * (H + c * un) + a2 * k;
  for (int i = 0; i < dim; ++i) {
    const S shear = middle * rho * (du[i] - dun * n[i]);
    out[1 + i] = a1 * (s.u[i] - c * n[i]) + a3 * (s.u[i] + c * n[i]) + a2 * s.u[i] + shear;
    out[dim + 1] += s.u[i] * shear;
  }
}

}  // namespace silt
