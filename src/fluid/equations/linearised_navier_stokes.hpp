#pragma once
#include "fluid/equations/volume_averaged_navier_stokes.hpp"

namespace silt {

/// The derivative of VolumeAveragedNavierStokes::residual at one point, factored by hand so that a pair of nodes costs
/// some fifty multiplications where general dual numbers cost a thousand. A test holds it against differences of the
/// residual on every element and model; a change of the residual must be made here too.
///
/// With S the strong residual, W_a = tau_m supg m u.grad N_a, m = alpha rho, and b a velocity function:
///   dS_i/du_(b,c) = delta_ic L_b + N_b M_ic - mu grad_i N_b d_c alpha,
///   L_b = m (c0 N_b + u.grad N_b) + r N_b - mu grad alpha.grad N_b,  M_ic = m d_c u_i - 2/3 mu d_c alpha d_i
///   alpha/alpha.
template <int dim, class V>
struct LinearisedNavierStokes {
  V mass, shear, share, following, lent, tau_momentum, tau_pressure, divergence_factor, bulk_factor, pspg;
  V strong[dim], galerkin_gradient[dim][dim], strong_gradient[dim][dim];  ///< [i][c]: m d_c u_i, M_ic
  V convection2_velocity[dim];                                            ///< (2 m/h)^2 u_c = half of d(1/tau^2)/du_c
  V dilation_slope[dim];  ///< 2/3 mu d_c alpha, plus what the grad-div factor has of u_c
  V alpha_gradient[dim], velocity[dim];
  V supg, time, response_galerkin, response;
  bool stabilised;

  LinearisedNavierStokes() = default;
  LinearisedNavierStokes(const FlowState<V, dim>& s, const FlowCoefficients<V, dim>& at, const FlowParameters& k) {
    mass = at.alpha * k.density;
    shear = at.alpha * at.viscosity;
    share = k.model_a ? at.alpha : at.alpha * 0.0 + 1.0;
    following = at.following * k.continuity_scale;
    lent = k.model_a ? at.following : at.following * 0.0;
    stabilised = k.supg != 0 || k.pspg != 0 || k.grad_div != 0;
    time = mass * k.time_coefficient;
    response = at.response;
    response_galerkin = k.load_as_density ? at.response : at.response * 0.0;
    V particles[dim], galerkin[dim];
    VolumeAveragedNavierStokes<dim>::momentum(s, at, k, galerkin, particles, strong);
    const V curl = (2.0 / 3.0) * at.viscosity, curl_by_alpha = curl / at.alpha;
    for (int i = 0; i < dim; ++i) {
      velocity[i] = s.velocity[i];
      alpha_gradient[i] = at.grad_alpha[i] * at.viscosity;
      dilation_slope[i] = at.grad_alpha[i] * curl;
      for (int c = 0; c < dim; ++c) {
        galerkin_gradient[i][c] = mass * s.velocity_gradient[i][c];
        strong_gradient[i][c] = galerkin_gradient[i][c] - curl_by_alpha * at.grad_alpha[c] * at.grad_alpha[i];
      }
    }
    tau_momentum = tau_pressure = bulk_factor = pspg = supg = V{};
    for (int c = 0; c < dim; ++c) convection2_velocity[c] = V{};
    if (!stabilised) return;
    const V per_length = 1.0 / at.h;
    const V convection = 2.0 * mass * per_length, diffusion = 12.0 * shear * (per_length * per_length);
    const V inertia = time + at.response;
    V speed2 = s.velocity[0] * s.velocity[0];
    for (int i = 1; i < dim; ++i) speed2 += s.velocity[i] * s.velocity[i];
    const V steady = speed2 * (convection * convection) + diffusion * diffusion;
    const V root = square_root(steady);
    tau_momentum = 1.0 / square_root(V(steady + at.response * at.response));
    tau_pressure = 1.0 / square_root(V(steady + inertia * inertia));
    supg = mass * tau_momentum * k.supg;
    pspg = tau_pressure * at.alpha * (k.pspg * k.continuity_scale);
    const V factor = at.h * at.h * (0.25 * k.grad_div) / at.alpha;
    bulk_factor = (root - diffusion) * factor;
    const V slope = (s.flux_divergence + at.alpha_rate) * factor / root;
    for (int c = 0; c < dim; ++c) {
      convection2_velocity[c] = convection * convection * s.velocity[c];
      dilation_slope[c] += slope * convection2_velocity[c];
    }
  }

  /// What belongs to one velocity function b as unknown.
  struct Column {
    V shape, gradient[dim], galerkin, strong, flux[dim];  ///< flux: alpha_b grad N_b
  };
  Column column(const V& shape, const V (&gradient)[dim], const V& alpha) const {
    Column b;
    b.shape = shape;
    V carried = velocity[0] * gradient[0], smeared = alpha_gradient[0] * gradient[0];
    for (int i = 1; i < dim; ++i) {
      carried += velocity[i] * gradient[i];
      smeared += alpha_gradient[i] * gradient[i];
    }
    for (int i = 0; i < dim; ++i) {
      b.gradient[i] = gradient[i];
      b.flux[i] = alpha * gradient[i];
    }
    const V inertia = time * shape + mass * carried;
    b.galerkin = inertia + response_galerkin * shape;
    b.strong = inertia + response * shape - smeared;
    return b;
  }

  /// What belongs to one velocity function a as test function (already times the point's volume).
  struct VelocityTest {
    V shape, gradient[dim], stream;
    V by_shape[dim][dim];  ///< [i][c] factor of N_b
    V by_gradient[dim];    ///< [c] factor of grad_i N_b
    V bulk[dim], viscous[dim];
  };
  VelocityTest velocity_test(const V& shape, const V (&gradient)[dim]) const {
    VelocityTest a;
    a.shape = shape;
    V along = velocity[0] * gradient[0];
    for (int i = 1; i < dim; ++i) along += velocity[i] * gradient[i];
    a.stream = supg * along;
    const V shrink = a.stream * tau_momentum * tau_momentum;
    for (int c = 0; c < dim; ++c) {
      a.gradient[c] = gradient[c];
      a.viscous[c] = shear * gradient[c];
      a.bulk[c] = bulk_factor * gradient[c];
      a.by_gradient[c] = a.viscous[c] - a.stream * alpha_gradient[c];
      const V stream_slope = supg * gradient[c] - shrink * convection2_velocity[c];
      for (int i = 0; i < dim; ++i)
        a.by_shape[i][c] = shape * galerkin_gradient[i][c] + a.stream * strong_gradient[i][c] +
                           strong[i] * stream_slope + gradient[i] * dilation_slope[c];
    }
    return a;
  }
  /// out[i][c] += d(row (a, i))/d(u_(b,c)), rows `stride` apart.
  void add(const VelocityTest& a, const Column& b, V* out, int stride) const {
    V diagonal = a.shape * b.galerkin + a.stream * b.strong;
    for (int j = 0; j < dim; ++j) diagonal += a.viscous[j] * b.gradient[j];
    for (int i = 0; i < dim; ++i)
      for (int c = 0; c < dim; ++c) {
        V sum = a.by_shape[i][c] * b.shape + a.by_gradient[c] * b.gradient[i] + a.bulk[i] * b.flux[c];
        if (i == c) sum += diagonal;
        out[i * stride + c] += sum;
      }
  }

  /// What belongs to one pressure function a as test function (already times the point's volume); `scaled` is its value
  /// times the scale of the continuity rows.
  struct PressureTest {
    V scaled, gradient[dim], by_shape[dim];
    V stabilised[dim];  ///< pspg grad M_a
  };
  PressureTest pressure_test(const V& scaled, const V (&gradient)[dim]) const {
    PressureTest a;
    a.scaled = scaled;
    V residual = gradient[0] * strong[0];
    for (int j = 1; j < dim; ++j) residual += gradient[j] * strong[j];
    const V shrink = pspg * tau_pressure * tau_pressure * residual;
    for (int c = 0; c < dim; ++c) {
      a.stabilised[c] = pspg * gradient[c];
      V sum = gradient[0] * strong_gradient[0][c];
      for (int j = 1; j < dim; ++j) sum += gradient[j] * strong_gradient[j][c];
      a.by_shape[c] = pspg * sum - shrink * convection2_velocity[c] - following * gradient[c];
    }
    return a;
  }
  /// out[c] += d(row a)/d(u_(b,c)).
  void add(const PressureTest& a, const Column& b, V* out) const {
    V smeared = a.stabilised[0] * b.gradient[0];
    for (int j = 1; j < dim; ++j) smeared += a.stabilised[j] * b.gradient[j];
    for (int c = 0; c < dim; ++c)
      out[c] +=
          a.scaled * b.flux[c] + a.by_shape[c] * b.shape + a.stabilised[c] * b.strong - smeared * alpha_gradient[c];
  }
};

}  // namespace silt
