#pragma once
#include <cmath>

#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// The closure of Mazzei & Lettieri (2007): the drag with which a homogeneous suspension settles by the law of
/// Richardson & Zaki at every Reynolds number. Its exponent n (Rowe 1987) goes by the Reynolds number of the single
/// sphere, which follows from n: found by iteration.
struct MazzaDrag {
  static constexpr const char* name = "mazza";
  static constexpr ModelNote note = {
      "", "Mazzei & Lettieri 2007; Rowe 1987",
      "k = V 3/4 C_D(Re*) a rho |u-v|/d a^(2 - 2n), C_D of Dallavalle, n = (4.8 + 0.42 "
      "Re*^0.75)/(1 + 0.175 Re*^0.75), Re* = Re/a^n, Re = a rho d |u-v|/mu",
      "settling by Richardson & Zaki's law, its definition; a^-3.8 in slow and fast flow (Gibilaro et "
      "al. 1985); terminal velocity; not against the paper, which was not at hand"};
  void options(OptionGroup&) {}
  /// Exponent of Richardson & Zaki at the Reynolds number of the single sphere's terminal velocity.
  static double exponent(double reynolds) {
    const double power = 0.175 * std::pow(reynolds, 0.75);
    return (4.8 + 2.4 * power) / (1 + power);
  }
  double exchange(const FlowAround& flow) const {
    const double a = flow.void_fraction, reynolds = flow.superficial_reynolds();
    // n falls with Re*, which falls with n: a contraction, since d(ln Re*)/dn d(n)/d(ln Re*) stays below 1 for a > 0.2.
    double n = exponent(reynolds), terminal = reynolds;
    for (int k = 0; k < 100; ++k) {
      terminal = reynolds * std::pow(a, -n);
      const double next = exponent(terminal);
      const bool found = std::abs(next - n) < 1e-12;
      n = next;
      if (found) break;
    }
    // C_D(Re*) Re/24 with Re the interstitial one: C_D Re* / 24 times Re_p / Re* = a^{n - 1}.
    return flow.stokes() * dallavalle_factor(terminal) * std::pow(a, n - 1) * a * std::pow(a, 2 * (1 - n));
  }
};

}  // namespace silt
