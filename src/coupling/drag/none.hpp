#pragma once
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// No drag: particles and fluid share space and pressure only.
struct NoDrag {
  static constexpr const char* name = "none";
  void options(OptionGroup&) {}
  double exchange(const FlowAround&) const { return 0; }
};

}  // namespace silt
