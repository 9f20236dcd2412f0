#pragma once
#include <string>

namespace silt {

class Mesh;

/// Finds the directions in which the mesh of a Gmsh file repeats itself (its section $Periodic): a node that stands for
/// several places is seen at different ones by its cells. Collective. Throws UserError where other sides than opposite
/// ends along x, y or z repeat each other, or where fewer than three cells lie between them.
void find_periods(Mesh& mesh, const std::string& file);

/// Throws UserError where a part of the ends of a periodic direction is a boundary. Collective; needs the boundaries.
void check_periodic_ends(const Mesh& mesh, const std::string& file);

}  // namespace silt
