#pragma once
#include <string>

#include "base/options.hpp"
#include "base/vector.hpp"

namespace silt {

/// How the material of a wall turns while its shape stays where it is (a shaft, the shell of a drum, a disc): the
/// options `-<prefix>_rotation_...` beside `-<prefix>_velocity`, the same for the fluid and for the particles.
struct SurfaceMotion {
  std::string rotation_rate = "0";
  Vec3 rotation_axis = Vec3::UnitZ(), rotation_centre = Vec3::Zero();
  void options(OptionGroup& option) {
    option("rotation_rate", rotation_rate,
           "rad/s; type no_slip: rate at which the wall turns about its rotation axis, its shape staying where it is; "
           "formula in t");
    option("rotation_axis", rotation_axis, "-", "direction of the axis about which a no_slip wall turns");
    option("rotation_centre", rotation_centre, "m", "a point of the axis about which a no_slip wall turns");
  }
  /// Three formulas in x, y, z, t: velocity + rate axis x (position - centre), m/s. Throws UserError for an axis
  /// without direction and for a rate that depends on x, y, z.
  std::string formula(const std::string& prefix, const std::string& velocity) const;
};

}  // namespace silt
