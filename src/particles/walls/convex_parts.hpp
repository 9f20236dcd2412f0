#pragma once
#include <vector>

#include "particles/walls/surface.hpp"

namespace silt {

/// Cuts a coplanar patch of facets into few convex polygons along facet edges (one for a rectangle or a disc, however
/// finely meshed), corners as ordered in its facets, none of them on a straight side.
std::vector<std::vector<Vec3>> convex_parts(const Surface& surface, const Patch& patch);

}  // namespace silt
