#pragma once
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Creeping flow around a single sphere with Cunningham's slip correction (7.91, 3.295): k = 3 pi mu d / C_c,
/// C_c = 1 + Kn (1.257 + 0.4 exp(-1.1 / Kn)), Kn = 2 lambda / d.
struct StokesDrag {
  static constexpr const char* name = "stokes";
  double mean_free_path = 0;
  void options(OptionGroup& option) {
    option("mean_free_path", mean_free_path, "m", "mean free path of the gas, for the slip correction; 0: none",
           non_negative);
  }
  double exchange(const FlowAround& flow) const {
    if (mean_free_path == 0) return flow.stokes();
    const double knudsen = 2 * mean_free_path / flow.diameter;
    return flow.stokes() / (1 + knudsen * (1.257 + 0.4 * std::exp(-1.1 / knudsen)));
  }
};

}  // namespace silt
