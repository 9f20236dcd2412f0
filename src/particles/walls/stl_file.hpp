#pragma once
#include <array>
#include <string>
#include <vector>

#include "base/vector.hpp"

namespace silt {

/// A facet of an STL file; its corners are anticlockwise seen from where its normal points.
struct StlFacet {
  std::array<Vec3, 3> corner;
  Vec3 normal = Vec3::Zero();  ///< as the file gives it, possibly zero
};

/// Reads an ASCII or binary STL file (told by its size). Throws UserError naming file and line or size. Local.
std::vector<StlFacet> read_stl(const std::string& file);

/// Looks for what makes facets no wall: degenerate ones, facets there twice, normals against the order of corners,
/// facets that cross; for a surface that must enclose a volume also open edges, neighbours of opposite orientation, and
/// normals that point inwards. Throws UserError naming the facets by their number in the file, from 1.
void check_stl(const std::vector<StlFacet>& facets, bool closed, const std::string& file);

}  // namespace silt
