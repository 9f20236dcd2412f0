#pragma once
#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/ergun.hpp"
#include "coupling/drag/wen_yu.hpp"

namespace silt {

/// Ergun below a void fraction of 0.8, Wen & Yu above (Gidaspow 1994; 7.98-7.99). With `blending` the two are weighted
/// by an arc tangent of the void fraction (Huilin & Gidaspow 2003).
struct GidaspowDrag {
  static constexpr const char* name = "gidaspow";
  static constexpr ModelNote note = {
      "(7.98-7.99)", "Gidaspow 1994; Huilin & Gidaspow 2003",
      "Ergun for a < 0.8, Wen & Yu above; blending: Wen & Yu with the weight atan(150 1.75 (a - 0.8))/pi + 1/2, Ergun "
      "with the rest",
      "beta of all particles in a volume; both branches away from the joint; terminal velocity"};
  bool blending = false;
  void options(OptionGroup& option) {
    option("blending", blending, "join Ergun and Wen-Yu smoothly around a void fraction of 0.8 instead of switching");
  }
  double exchange(const FlowAround& flow) const {
    if (blending) {
      const double share = std::atan(150 * 1.75 * (flow.void_fraction - 0.8)) / std::numbers::pi + 0.5;
      return (1 - share) * ErgunDrag{}.exchange(flow) + share * WenYuDrag{}.exchange(flow);
    }
    return flow.void_fraction < 0.8 ? ErgunDrag{}.exchange(flow) : WenYuDrag{}.exchange(flow);
  }
};

}  // namespace silt
