#pragma once
#include <algorithm>

#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Drag of a single sphere in the superficial velocity a (u - v), times a^-chi, chi = 3.7 - 0.65 exp(-(1.5 - log10
/// Re)^2 / 2), Re = a rho d |u-v| / mu (Di Felice 1994; 7.92-7.93). Single sphere: Dallavalle's law as in the paper, or
/// Schiller & Naumann's.
struct DiFeliceDrag {
  static constexpr const char* name = "di_felice";
  std::string single = "dallavalle";
  void options(OptionGroup& option) {
    option("single", single, {"dallavalle", "schiller_naumann"},
           "drag law of the single sphere that Di Felice's law multiplies");
    schiller_naumann = single == "schiller_naumann";
  }
  bool schiller_naumann = false;
  double exchange(const FlowAround& flow) const {
    const double reynolds = flow.superficial_reynolds();
    const double factor = schiller_naumann ? schiller_naumann_factor(reynolds) : dallavalle_factor(reynolds);
    // At rest log10 Re is -infinity and chi its creeping-flow limit, 3.7.
    const double distance = 1.5 - std::log10(std::max(reynolds, 1e-30));
    const double chi = 3.7 - 0.65 * std::exp(-0.5 * distance * distance);
    return flow.stokes() * factor * flow.void_fraction * std::pow(flow.void_fraction, -chi);
  }
};

}  // namespace silt
