#pragma once
#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Cunningham's slip correction C_c (3.295); 1 in a continuum.
inline double cunningham(double mean_free_path, double diameter) {
  if (mean_free_path == 0) return 1;
  const double knudsen = 2 * mean_free_path / diameter;
  return 1 + knudsen * (1.257 + 0.4 * std::exp(-1.1 / knudsen));
}

/// Creeping flow around a single sphere with slip (7.91).
struct StokesCunninghamDrag {
  static constexpr const char* name = "stokes_cunningham";
  static constexpr ModelNote note = {"(7.91), (3.295)", "Stokes 1851; Cunningham 1910",
                                     "k = 3 pi mu d/C_c, C_c = 1 + Kn (1.257 + 0.4 exp(-1.1/Kn)), Kn = 2 lambda/d",
                                     "C_c at Kn = 0.136; terminal velocity"};
  double mean_free_path = 0;
  void options(OptionGroup& option) {
    option("mean_free_path", mean_free_path, "m", "mean free path of the gas, for the slip correction; 0: none",
           non_negative);
  }
  double exchange(const FlowAround& flow) const { return flow.stokes() / cunningham(mean_free_path, flow.diameter); }
};

}  // namespace silt
