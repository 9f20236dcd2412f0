#pragma once
#include <cmath>

#include "base/options.hpp"
#include "base/vector.hpp"

namespace silt {

/// Wall-adapting local eddy viscosity (Nicoud & Ducros, Flow, Turbulence and Combustion 62 (1999) 183): nu_t = (C_w
/// width)^2 (Sd:Sd)^(3/2)/((S:S)^(5/2) + (Sd:Sd)^(5/4)), Sd the deviatoric symmetric part of the squared velocity
/// gradient; zero in pure shear, of order y^3 at walls (docs/theory/turbulence.md, T14).
struct Wale {
  static constexpr const char* name = "wale";
  static constexpr bool limited_at_walls = false;
  double constant = 0.325;
  void options(OptionGroup& option) {
    option("wale_constant", constant, "-", "constant C_w of the WALE model", positive);
  }
  /// 1/s, of a velocity gradient g (row i: gradient of u_i).
  static double rate(const Mat3& g) {
    const Mat3 S = 0.5 * (g + g.transpose()), square = g * g;
    const Mat3 Sd = 0.5 * (square + square.transpose()) - square.trace() / 3 * Mat3::Identity();
    const double s = S.squaredNorm(), d = Sd.squaredNorm();
    const double below = std::pow(s, 2.5) + std::pow(d, 1.25);
    return below > 0 ? std::pow(d, 1.5) / below : 0;
  }
};

}  // namespace silt
