#pragma once
#include "base/dual.hpp"

namespace silt {

/// What stays the same over all points of a step. SI units.
struct FlowParameters {
  double density = 1, viscosity = 1;
  double mean_gradient[3] = {
      0, 0, 0};  ///< N/m3, acts as a pressure gradient of -m does: rho g, and what drives a periodic flow
  double time_coefficient = 0;              ///< 1/s, factor of u^{n+1} in du/dt (BDF1: 1/dt, BDF2: 1.5/dt)
  double supg = 1, pspg = 1, grad_div = 1;  ///< factors of the stabilisation terms; 0 for the plain Galerkin form
  double continuity_scale =
      1;  ///< kg/(m2 s), factor of the continuity rows that makes them comparable to the momentum rows
  bool model_a = true;
  bool load_as_density =
      false;  ///< the particles' load enters the weak form as a density (Taylor-Hood), not as a nodal vector
};

/// The given fields at one point.
template <class T, int dim>
struct FlowCoefficients {
  T alpha, alpha_rate;  ///< void fraction, its rate (1/s)
  T grad_alpha[dim];    ///< 1/m
  T history[dim];       ///< m/s2, the part of du/dt that is known
  T velocity_old[dim];  ///< m/s, u^n
  T body[dim];          ///< N/m3, given force
  T load[dim];          ///< N/m3, density of the particles' force
  T response;           ///< kg/(m3 s), density of the particles' response
  T following;          ///< s, volume share of particles that follow the flow within the step
  T returned[dim];      ///< N/m3, s grad p of the step before
  T viscosity;          ///< Pa s, with that of the turbulence
  T h;                  ///< m, shortest edge of the cell
  bool loaded = true;   ///< false: load, response, following and returned are zero, and nobody looks at them
};

/// The unknowns at one point. `flux_divergence` is div(alpha u)_h, alpha u being interpolated from its nodal products,
/// so that a uniform superficial velocity through a changing alpha is represented exactly.
template <class S, int dim>
struct FlowState {
  S velocity[dim], velocity_gradient[dim][dim];  ///< [i][j] = d u_i / d x_j
  S pressure, pressure_gradient[dim];
  S flux_divergence;
  static constexpr int size = dim + dim * dim + 1 + dim + 1;
};

/// The integrands: row (a, i) of the momentum equation is
/// int N_a momentum_i + sum_j dN_a/dx_j stress_ij + w_a dN_a/dx_i pressure_stress, with w_a = alpha_a (model A) or 1
/// (model B); row a of the continuity equation is int N_a continuity + sum_j dN_a/dx_j flux_j.
template <class S, int dim>
struct FlowResidual {
  S momentum[dim], stress[dim][dim];
  S pressure_stress;
  S continuity, flux[dim];
};

/// Volume-averaged incompressible Navier-Stokes equations, rho constant:
///   alpha rho (du/dt + u.grad u) - div(alpha mu (grad u + grad u^T - 2/3 div u I)) + P (grad p - m) = f,   d(alpha)/dt
///   + div(alpha u) = 0; P = alpha in model A, 1 in model B, m = rho g (when p holds the static head) plus what drives
///   a periodic flow,
/// with particles that follow the flow div(alpha u + s (u - u^n)) and, in model A, s grad p less that of the step
/// before (docs/theory/coupling.md, C13, C14), with the residual-based variational multiscale terms SUPG, PSPG and
/// grad-div. The term alpha grad p is tested in the form -int p div(alpha v)_h, the adjoint of the continuity equation:
/// it does the work int p d(alpha)/dt exactly, and at a free boundary the pressure is a natural traction. Time scale
/// tau after Tezduyar & Osawa (2000):
///   1/tau^2 = (2 alpha rho |u|/h)^2 + (12 alpha mu/h^2)^2 + (alpha rho c/dt + beta)^2;
/// in SUPG only beta stands in the last bracket. tau is differentiated with the rest: the Jacobian is exact.
template <int dim>
struct VolumeAveragedNavierStokes {
  /// The momentum equation at the point: without the particles' density and the pressure, that density, and all of it
  /// (second derivatives of the velocity are left out: zero for P1, of higher order for Q1 and P2).
  template <class S, class T>
  static void momentum(const FlowState<S, dim>& state, const FlowCoefficients<T, dim>& at, const FlowParameters& k,
                       S (&galerkin)[dim], S (&particles)[dim], S (&strong)[dim]) {
    const T mass = at.alpha * k.density;
    const T pressure_factor = k.model_a ? at.alpha : at.alpha * 0.0 + 1.0;
    const S thinning = dilation(state, at) * T(1.0 / at.alpha);
    for (int i = 0; i < dim; ++i) {
      S acceleration = state.velocity[i] * (T{} + k.time_coefficient) + at.history[i];
      for (int j = 0; j < dim; ++j) acceleration += state.velocity[j] * state.velocity_gradient[i][j];
      // The mean pressure gradient is tested like the pressure's own (row (a, i) gets -int w_a N_a m_i in the cell
      // loop), so that a static head balances it exactly.
      galerkin[i] = acceleration * mass - at.body[i];
      particles[i] = S{};
      strong[i] =
          (state.pressure_gradient[i] - T(T{} + k.mean_gradient[i])) * pressure_factor - thinning * at.grad_alpha[i];
      for (int j = 0; j < dim; ++j)
        strong[i] -=
            (state.velocity_gradient[i][j] + state.velocity_gradient[j][i]) * T(at.grad_alpha[j] * at.viscosity);
      if (at.loaded) {
        if (k.model_a) galerkin[i] += state.pressure_gradient[i] * at.following - at.returned[i];
        particles[i] = (state.velocity[i] - at.velocity_old[i]) * at.response - at.load[i];
        strong[i] += particles[i];
      }
      strong[i] += galerkin[i];
    }
  }

  /// -2/3 alpha mu div u, with div u by continuity: zero where alpha is 1, whatever the discrete velocity.
  template <class S, class T>
  static S dilation(const FlowState<S, dim>& state, const FlowCoefficients<T, dim>& at) {
    S change = state.velocity[0] * at.grad_alpha[0] + at.alpha_rate;
    for (int i = 1; i < dim; ++i) change += state.velocity[i] * at.grad_alpha[i];
    return change * T((2.0 / 3.0) * at.viscosity);
  }

  template <class S, class T>
  static void residual(const FlowState<S, dim>& state, const FlowCoefficients<T, dim>& at, const FlowParameters& k,
                       FlowResidual<S, dim>& out) {
    const T mass = at.alpha * k.density;
    const T shear = at.alpha * at.viscosity;
    S galerkin[dim], particles[dim], strong[dim];
    momentum(state, at, k, galerkin, particles, strong);
    const S thinning = dilation(state, at);
    for (int i = 0; i < dim; ++i) {
      out.momentum[i] = k.load_as_density ? galerkin[i] + particles[i] : galerkin[i];
      for (int j = 0; j < dim; ++j)
        out.stress[i][j] = (state.velocity_gradient[i][j] + state.velocity_gradient[j][i]) * shear;
      out.stress[i][i] += thinning;
    }
    out.pressure_stress = -state.pressure;
    const S divergence = state.flux_divergence + at.alpha_rate;
    out.continuity = divergence * (T{} + k.continuity_scale);
    for (int j = 0; j < dim; ++j)
      out.flux[j] = at.loaded ? (state.velocity[j] - at.velocity_old[j]) * T(at.following * -k.continuity_scale) : S{};
    if (k.supg == 0 && k.pspg == 0 && k.grad_div == 0) return;

    S speed_squared = state.velocity[0] * state.velocity[0];
    for (int i = 1; i < dim; ++i) speed_squared += state.velocity[i] * state.velocity[i];
    const T per_length = 1.0 / at.h;
    const T convection = 2.0 * mass * per_length;
    const T diffusion = 12.0 * shear * (per_length * per_length);
    const T inertia = at.loaded ? mass * k.time_coefficient + at.response : mass * k.time_coefficient;
    const S steady = speed_squared * T(convection * convection) + T(diffusion * diffusion);
    const T one = T{} + 1.0;
    const S root = square_root(steady);
    const S tau_momentum = one / (at.loaded ? square_root(S(steady + T(at.response * at.response))) : root);
    const S tau_pressure = one / square_root(S(steady + T(inertia * inertia)));
    for (int j = 0; j < dim; ++j) {
      out.flux[j] += tau_pressure * strong[j] * T(at.alpha * (k.pspg * k.continuity_scale));
      const S weight = tau_momentum * state.velocity[j] * T(mass * k.supg);
      for (int i = 0; i < dim; ++i) out.stress[i][j] += weight * strong[i];
    }
    // Grad-div: h^2/4 times the convective part of 1/tau, alpha rho |u| h/2 where convection rules; nothing where
    // viscosity does, which needs no help and would lose accuracy.
    const S bulk = (root - diffusion) * divergence * T(at.h * at.h * (0.25 * k.grad_div) * T(1.0 / at.alpha));
    for (int i = 0; i < dim; ++i) out.stress[i][i] += bulk;
  }
};

}  // namespace silt
