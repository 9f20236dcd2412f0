#pragma once
#include <string>

#include "particles/walls/rigid_wall.hpp"

namespace silt {

/// The inside or outside (or both) of an axis-aligned box as a wall.
FacetShape box_shape(const Vec3& lower, const Vec3& upper, WallSideChoice side, const Surface& domain,
                     const std::string& prefix, double smooth_angle);

/// A surface from an STL file as a wall; `prefix` of the options, for messages. Throws UserError, the same on every
/// rank. Collective.
FacetShape stl_shape(const std::string& file, double scale, const Vec3& offset, WallSideChoice side,
                     const Surface& domain, const std::string& prefix, double smooth_angle);

}  // namespace silt
