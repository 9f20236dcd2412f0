#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/options.hpp"
#include "particles/walls/wall_motion.hpp"

namespace silt {

/// The options `-wall_<name>_...`: a wall that is no boundary of the mesh.
struct RigidWallOptions {
  std::string type = "plane", material, temperature, side = "inside", ends = "open";
  InputFile file;
  std::optional<Vec3> point, normal, axis, lower, upper;
  std::optional<double> radius, end_radius, length;
  std::vector<double> profile;
  double scale = 1;
  Vec3 offset = Vec3::Zero();
  WallMotionOptions motion;

  void options(OptionGroup& option);
};

}  // namespace silt
