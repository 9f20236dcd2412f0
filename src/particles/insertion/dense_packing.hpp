#pragma once
#include <string>
#include <vector>

#include "particles/insertion/fill.hpp"

namespace silt {

/// A dense random packing of a box or cylinder: spheres at random places push each other apart until none overlap
/// (relaxation of harmonic repulsion with momentum). Reaches 62 % solids away from walls. Adds the spheres to `placed`.
/// Throws UserError when that many do not fit, or when the region holds walls or other spheres.
std::vector<PlacedSphere> pack_region(const InsertionOptions& options, const std::string& prefix, const Region& region,
                                      Packing& placed);

/// As many radii as the options ask for, largest first.
std::vector<double> drawn_radii(const InsertionOptions& options, const std::string& prefix, const Region& region);

}  // namespace silt
