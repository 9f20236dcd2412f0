#pragma once
#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// No drag: particles and fluid share space and pressure only.
struct NoDrag {
  static constexpr const char* name = "none";
  static constexpr ModelNote note = {"", "", "k = 0", ""};
  void options(OptionGroup&) {}
  double exchange(const FlowAround&) const { return 0; }
};

}  // namespace silt
