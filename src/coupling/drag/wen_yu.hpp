#pragma once
#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Fluidised suspension, Wen & Yu (1966) (7.99).
struct WenYuDrag {
  static constexpr const char* name = "wen_yu";
  static constexpr ModelNote note = {"(7.99)", "Wen & Yu 1966",
                                     "k = 3 pi mu d f(Re) a^-2.65, f of schiller_naumann, Re = a rho d |u-v|/mu",
                                     "beta of all particles in a volume; terminal velocity"};
  void options(OptionGroup&) {}
  double exchange(const FlowAround& flow) const {
    return flow.stokes() * schiller_naumann_factor(flow.superficial_reynolds()) * std::pow(flow.void_fraction, -2.65);
  }
};

}  // namespace silt
