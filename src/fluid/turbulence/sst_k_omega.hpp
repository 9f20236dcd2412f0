#pragma once
#include <algorithm>
#include <cmath>

#include "fluid/turbulence/closure.hpp"

namespace silt {

/// Shear-stress-transport k-omega model (Menter, Kuntz & Langtry, Turbulence, Heat and Mass Transfer 4 (2003) 625;
/// docs/theory/turbulence.md, T10 to T12).
struct SstKOmega {
  static constexpr const char* name = "sst_k_omega";
  static constexpr double beta_star = 0.09, a1 = 0.31;
  static constexpr double beta_1 = 0.075, beta_2 = 0.0828, gamma_1 = 5.0 / 9, gamma_2 = 0.44;
  static constexpr double sigma_k1 = 0.85, sigma_k2 = 1.0, sigma_omega1 = 0.5, sigma_omega2 = 0.856;
  static constexpr double C_mu = beta_star;

  static double second_blending(const TurbulentPoint& p) {
    const double omega = std::max(p.second, 1e-30), d = p.distance, nu = p.viscosity / p.density;
    const double argument = std::max(2 * std::sqrt(p.k) / (beta_star * omega * d), 500 * nu / (d * d * omega));
    return std::tanh(argument * argument);
  }
  /// rho a1 k / max(a1 omega, S F2) (T10).
  static double eddy_viscosity(const TurbulentPoint& p) {
    const double F2 = p.distance > 0 ? second_blending(p) : 1.0;
    return p.density * a1 * p.k / std::max({a1 * p.second, p.strain.shear * F2, 1e-30});
  }
  static TurbulentTerms terms(const TurbulentPoint& p, double mu_t) {
    const double omega = std::max(p.second, 1e-30), k = std::max(p.k, 0.0), rho = p.density, d = p.distance;
    const double nu = p.viscosity / rho, S2 = p.strain.shear * p.strain.shear;
    const double cross = 2 * rho * sigma_omega2 / omega * p.cross;
    double F1 = 1;
    if (d > 0) {
      const double near = std::max(std::sqrt(k) / (beta_star * omega * d), 500 * nu / (d * d * omega));
      const double far = 4 * rho * sigma_omega2 * k / (std::max(cross, 1e-10) * d * d);
      F1 = std::tanh(std::pow(std::min(near, far), 4));
    }
    const auto blend = [F1](double one, double two) { return F1 * one + (1 - F1) * two; };
    const double beta = blend(beta_1, beta_2), gamma = blend(gamma_1, gamma_2);
    TurbulentTerms t;
    t.eddy_viscosity = mu_t;
    t.free = 1 - F1;
    t.k_diffusivity = p.viscosity + mu_t * blend(sigma_k1, sigma_k2);
    t.second_diffusivity = p.viscosity + mu_t * blend(sigma_omega1, sigma_omega2);
    t.k_production = std::min(p.production, 10 * beta_star * rho * k * omega);
    t.k_destruction = rho * beta_star * omega;
    const double ratio = mu_t > 1e-30 * rho ? rho * t.k_production / mu_t : rho * S2;
    t.second_production = gamma * ratio + beta * rho * omega * omega + std::max(0.0, (1 - F1) * cross);
    t.second_destruction = 2 * beta * rho * omega + std::max(0.0, -(1 - F1) * cross) / omega;
    return t;
  }
  static double second_of_viscosity(double rho, double k, double mu_t) { return rho * k / mu_t; }
  static double second_of_length(double k, double length) { return std::sqrt(k) / (std::pow(C_mu, 0.25) * length); }
  static double dissipation(double k, double omega) { return beta_star * k * omega; }
};

}  // namespace silt
