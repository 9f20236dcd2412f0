#pragma once
#include <algorithm>

#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// Packed bed, Ergun (1952) (7.98); V the particle's volume.
struct ErgunDrag {
  static constexpr const char* name = "ergun";
  static constexpr ModelNote note = {"(7.98)", "Ergun 1952", "k = V (150 (1-a) mu/(a d^2) + 1.75 rho |u-v|/d)",
                                     "pressure drop of a fixed bed; terminal velocity"};
  void options(OptionGroup&) {}
  double exchange(const FlowAround& flow) const {
    const double d = flow.diameter, volume = std::numbers::pi / 6 * d * d * d;
    return volume * (150 * (1 - flow.void_fraction) * flow.viscosity / (flow.void_fraction * d * d) +
                     1.75 * flow.density * flow.speed / d);
  }
};

}  // namespace silt
