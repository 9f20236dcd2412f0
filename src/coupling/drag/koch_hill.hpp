#pragma once
#include <algorithm>

#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Lattice-Boltzmann fit for beds of spheres (Hill, Koch & Ladd 2001; Koch & Hill 2001).
struct KochHillDrag {
  static constexpr const char* name = "koch_hill";
  static constexpr ModelNote note = {
      "", "Hill, Koch & Ladd 2001",
      "k = 3 pi mu d a^2 (F0 + F3 Re/2), F0 = (1 + 3 (s/2)^0.5 + 135/64 s ln s + 16.14 s)/(1 + "
      "0.681 s - 8.48 s^2 + 8.16 s^3) for s = 1 - a < 0.4, 10 s/a^3 above, F3 = 0.0673 + 0.212 s "
      "+ 0.0232/a^5, Re = a rho d |u-v|/mu",
      "values of Lethe; dilute and packed limits, F3; terminal velocity"};
  void options(OptionGroup&) {}
  double exchange(const FlowAround& flow) const {
    const double a = flow.void_fraction, s = std::max(1 - a, 1e-12);
    const double creeping = s < 0.4 ? (1 + 3 * std::sqrt(s / 2) + 135.0 / 64 * s * std::log(s) + 16.14 * s) /
                                          (1 + s * (0.681 + s * (-8.48 + 8.16 * s)))
                                    : 10 * s / (a * a * a);
    const double inertial = 0.0673 + 0.212 * s + 0.0232 / (a * a * a * a * a);
    return flow.stokes() * a * a * (creeping + 0.5 * inertial * flow.superficial_reynolds());
  }
};

}  // namespace silt
