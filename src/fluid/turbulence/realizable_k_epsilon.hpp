#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fluid/turbulence/closure.hpp"

namespace silt {

/// Realizable k-epsilon model (Shih, Liou, Shabbir, Yang & Zhu, Computers & Fluids 24 (1995) 227;
/// docs/theory/turbulence.md, T5 to T7).
struct RealizableKEpsilon {
  static constexpr const char* name = "realizable_k_epsilon";
  /// A0 = 1/C_mu - sqrt(6) cos(pi/6)/sqrt(C_mu): gives C_mu = 0.09 in the logarithmic layer, where S k/epsilon =
  /// 1/sqrt(C_mu). (The report of 1994, NASA TM 106721, and OpenFOAM have 4.0, most other codes 4.04.)
  static constexpr double A0 = 4.04, C2 = 1.9, sigma_k = 1.0, sigma_epsilon = 1.2;
  static constexpr double C_mu = 0.09;  ///< in equilibrium: of walls and inflows

  /// C_mu = 1/(A0 + A_s U* k/epsilon), A_s = sqrt(6) cos(arccos(W)/3) (T6).
  static double coefficient(const Strain& s, double k, double epsilon) {
    const double angle = std::acos(std::clamp(s.cubic, -1.0, 1.0)) / 3;
    const double As = std::numbers::sqrt3 * std::numbers::sqrt2 * std::cos(angle);
    const double U = std::sqrt(0.5 * (s.shear * s.shear + s.vorticity * s.vorticity));
    return 1 / (A0 + As * U * k / epsilon);
  }
  static double eddy_viscosity(const TurbulentPoint& p) {
    const double epsilon = std::max(p.second, 1e-30);
    return p.density * coefficient(p.strain, p.k, epsilon) * p.k * p.k / epsilon;
  }
  /// k: P - rho epsilon (T2); epsilon: rho C1 S epsilon - rho C2 epsilon^2/(k + sqrt(nu epsilon)) (T7).
  static TurbulentTerms terms(const TurbulentPoint& p, double mu_t) {
    const double epsilon = std::max(p.second, 1e-30), k = std::max(p.k, 1e-30), rho = p.density;
    const double S = p.strain.shear, eta = S * k / epsilon, C1 = std::max(0.43, eta / (eta + 5));
    const double decay = C2 * epsilon / (k + std::sqrt(p.viscosity / rho * epsilon));
    TurbulentTerms t;
    t.eddy_viscosity = mu_t;
    t.k_diffusivity = p.viscosity + mu_t / sigma_k;
    t.second_diffusivity = p.viscosity + mu_t / sigma_epsilon;
    // epsilon = epsilon* (2 k/k* - 1), epsilon^2 = epsilon* (2 epsilon - epsilon*)
    t.k_production = p.production + rho * epsilon;
    t.k_destruction = 2 * rho * epsilon / k;
    t.second_production = rho * (C1 * S + decay) * epsilon;
    t.second_destruction = 2 * rho * decay;
    return t;
  }
  /// epsilon that gives an eddy viscosity.
  static double second_of_viscosity(double rho, double k, double mu_t) { return rho * C_mu * k * k / mu_t; }
  static double second_of_length(double k, double length) { return std::pow(C_mu, 0.75) * k * std::sqrt(k) / length; }
  static double dissipation(double, double epsilon) { return epsilon; }
};

}  // namespace silt
