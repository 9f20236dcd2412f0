#pragma once
#include <algorithm>

#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Immersed-boundary fit for static arrays of spheres (Tang, Peters, Kuipers, Kriebitzsch & van der Hoef 2015). Beyond
/// its range, above a Reynolds number of 1000, the bracket of the inertial part keeps its value: C_D is constant.
struct TangDrag {
  static constexpr const char* name = "tang";
  static constexpr ModelNote note = {
      "", "Tang et al. 2015",
      "k = 3 pi mu d a F, F = 10 s/a^2 + a^2 (1 + 1.5 s^0.5) + [0.11 s (1 + s) - 0.00456/a^4 + "
      "(0.169 a + 0.0644/a^4) Re^-0.343] Re, the bracket kept above Re = 1000; Re = a rho d "
      "|u-v|/mu",
      "values of MFiX-Exa; creeping and dilute limits; terminal velocity"};
  void options(OptionGroup&) {}
  double exchange(const FlowAround& flow) const {
    const double a = flow.void_fraction, s = std::max(1 - a, 0.0), a4 = a * a * a * a;
    const double reynolds = std::max(flow.superficial_reynolds(), 1e-12);
    const double creeping = 10 * s / (a * a) + a * a * (1 + 1.5 * std::sqrt(s));
    const double inertial =
        0.11 * s * (1 + s) - 0.00456 / a4 + (0.169 * a + 0.0644 / a4) * std::pow(std::min(reynolds, 1000.0), -0.343);
    return flow.stokes() * a * (creeping + inertial * reynolds);
  }
};

}  // namespace silt
