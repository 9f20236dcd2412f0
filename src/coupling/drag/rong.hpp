#pragma once
#include <algorithm>

#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Lattice-Boltzmann fit for packed uniform spheres (Rong, Dong & Yu 2013), in the form of Di Felice.
struct RongDrag {
  static constexpr const char* name = "rong";
  static constexpr ModelNote note = {
      "", "Rong, Dong & Yu 2013",
      "drag of a sphere by Dallavalle in a (u - v), times a^-b, b = 2.65 (a + 1) - (5.3 - 3.5 a) a^2 exp(-(1.5 - log10 "
      "Re)^2/2), Re = a rho d |u-v|/mu",
      "values of PhasicFlow; exponent in creeping flow and at Re = 10^1.5; terminal velocity"};
  void options(OptionGroup&) {}
  double exchange(const FlowAround& flow) const {
    const double a = flow.void_fraction, reynolds = flow.superficial_reynolds();
    const double distance = 1.5 - std::log10(std::max(reynolds, 1e-30));
    const double exponent = 2.65 * (a + 1) - (5.3 - 3.5 * a) * a * a * std::exp(-0.5 * distance * distance);
    return flow.stokes() * dallavalle_factor(reynolds) * a * std::pow(a, -exponent);
  }
};

}  // namespace silt
