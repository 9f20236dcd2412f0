#include "particles/walls/wall_boundary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/surface_motion.hpp"
#include "base/text.hpp"

namespace silt {

int wall_material(const std::string& chosen, const std::string& prefix, const Options& options,
                  const std::vector<std::string>& materials) {
  if (chosen.empty()) return static_cast<int>(std::min_element(materials.begin(), materials.end()) - materials.begin());
  const auto found = std::find(materials.begin(), materials.end(), lower_case(chosen));
  if (found != materials.end()) return static_cast<int>(found - materials.begin());
  const std::string hint = nearest(chosen, materials);
  throw UserError(fmt::format("option -{}_material ({}): '{}' is not a material; there are {}{}", prefix,
                              options.origin(prefix + "_material"), chosen, fmt::join(materials, ", "),
                              hint.empty() ? "" : fmt::format(" (did you mean {}?)", hint)));
}

std::vector<WallBoundary> read_wall_boundaries(const Mesh& mesh, Options& options,
                                               const std::vector<std::string>& materials) {
  std::vector<WallBoundary> result;
  for (const auto& name : mesh.boundaries) {
    const std::string prefix = "boundary_" + name;
    const std::string type = options.find(prefix + "_type").value_or("");
    WallBoundaryOptions chosen;
    if (type == "pressure") chosen.role = "outlet";
    options.read(prefix, chosen);
    WallBoundary boundary;
    boundary.role = chosen.role == "wall"     ? BoundaryRole::wall
                    : chosen.role == "outlet" ? BoundaryRole::outlet
                                              : BoundaryRole::open;
    boundary.material = wall_material(chosen.material, prefix, options, materials);
    if (!chosen.temperature.empty()) {
      if (boundary.role != BoundaryRole::wall)
        throw UserError(fmt::format("option -{}_wall_temperature: particles meet no wall there (-{}_particles {})",
                                    prefix, prefix, chosen.role));
      boundary.temperature.emplace(prefix + "_wall_temperature", chosen.temperature);
    }
    // The velocity of an inflow is the fluid's; that of a wall is its own.
    if (type.empty() || type == "no_slip") {
      SurfaceMotion motion;
      options.read(prefix, motion);
      const auto text = options.find(prefix + "_velocity");
      if (text || options.given(prefix + "_rotation_rate")) {
        VectorExpression velocity(prefix + "_velocity", motion.formula(prefix, text.value_or("0, 0, 0")));
        if (velocity.constant())
          boundary.velocity = velocity(Vec3::Zero(), 0);
        else
          boundary.motion = std::move(velocity);
      }
    }
    result.push_back(std::move(boundary));
  }
  return result;
}

}  // namespace silt
