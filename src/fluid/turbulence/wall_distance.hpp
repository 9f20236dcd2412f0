#pragma once
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// m, the distance of every node to the nearest facet of the boundaries chosen, over all ranks and periodic images:
/// exact, with no equation to solve (2D: in the plane). `infinity` where there is no such boundary.
/// wall[boundaries of the mesh]. Collective.
std::vector<double> wall_distance(const Mesh& mesh, const std::vector<char>& wall);

}  // namespace silt
