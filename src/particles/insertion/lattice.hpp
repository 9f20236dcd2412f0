#pragma once
#include <vector>

#include "particles/insertion/packing.hpp"
#include "particles/insertion/region.hpp"

namespace silt {

enum class LatticeKind {
  cubic,     ///< simple cubic (square in 2D): at most 52 % (79 %) solids
  hexagonal  ///< close-packed layers (triangular in 2D): at most 74 % (91 %) solids
};

/// Sites of a lattice whose nearest neighbours are `spacing` apart, those where a sphere of the given radius fits into
/// the region and between the spheres already placed; in the order z, y, x. Starts at the region's lower corner, or is
/// stretched to fill the region.
std::vector<Vec3> lattice_sites(LatticeKind kind, double spacing, bool stretch, const Region& region, double radius,
                                const Packing& placed);

}  // namespace silt
