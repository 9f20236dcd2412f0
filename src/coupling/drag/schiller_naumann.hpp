#pragma once
#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// A single sphere (Schiller & Naumann 1935). No effect of neighbours.
struct SchillerNaumannDrag {
  static constexpr const char* name = "schiller_naumann";
  static constexpr ModelNote note = {"", "Schiller & Naumann 1935",
                                     "C_D = 24/Re (1 + 0.15 Re^0.687), 0.44 above Re = 1000",
                                     "C_D at Re 1, 100, 10^4; terminal velocity"};
  void options(OptionGroup&) {}
  double exchange(const FlowAround& flow) const { return flow.stokes() * schiller_naumann_factor(flow.reynolds()); }
};

}  // namespace silt
