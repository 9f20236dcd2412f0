#pragma once
#include <cmath>

#include "base/options.hpp"
#include "base/vector.hpp"

namespace silt {

/// Smagorinsky (Mon. Weather Rev. 91 (1963) 99): nu_t = l^2 sqrt(2 S_ij S_ij), l the constant times the cell's width or
/// kappa times the wall distance, the smaller (docs/theory/turbulence.md, T13).
struct Smagorinsky {
  static constexpr const char* name = "smagorinsky";
  static constexpr bool limited_at_walls = true;
  double constant = 0.1;
  void options(OptionGroup& option) {
    option("smagorinsky_constant", constant, "-", "constant C_s of the Smagorinsky model", positive);
  }
  /// 1/s, of a velocity gradient g (row i: gradient of u_i).
  static double rate(const Mat3& g) {
    const Mat3 S = 0.5 * (g + g.transpose());
    return std::sqrt(2 * S.squaredNorm());
  }
};

}  // namespace silt
