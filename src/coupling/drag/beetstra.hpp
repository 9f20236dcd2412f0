#pragma once
#include <algorithm>

#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Lattice-Boltzmann fit for packed and fluidised spheres (Beetstra, van der Hoef & Kuipers 2007).
struct BeetstraDrag {
  static constexpr const char* name = "beetstra";
  static constexpr ModelNote note = {
      "", "Beetstra et al. 2007",
      "k = 3 pi mu d a F, F = 10 s/a^2 + a^2 (1 + 1.5 s^0.5) + 0.413 Re/(24 a^2) (1/a + 3 a s + "
      "8.4 Re^-0.343)/(1 + 10^(3 s) Re^(-(1 + 4 s)/2)), s = 1 - a, Re = a rho d |u-v|/mu",
      "values of OpenFOAM and MFiX-Exa; creeping packed and dilute limits; terminal velocity"};
  void options(OptionGroup&) {}
  double exchange(const FlowAround& flow) const {
    const double a = flow.void_fraction, s = 1 - a, reynolds = std::max(flow.superficial_reynolds(), 1e-12);
    const double inertia = 0.413 * reynolds / (24 * a * a) * (1 / a + 3 * a * s + 8.4 * std::pow(reynolds, -0.343)) /
                           (1 + std::pow(10.0, 3 * s) * std::pow(reynolds, -0.5 * (1 + 4 * s)));
    const double factor = 10 * s / (a * a) + a * a * (1 + 1.5 * std::sqrt(std::max(s, 0.0))) + inertia;
    return flow.stokes() * a * factor;
  }
};

}  // namespace silt
