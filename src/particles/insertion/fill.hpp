#pragma once
#include <string>
#include <vector>

#include "particles/insertion/insertion_options.hpp"
#include "particles/insertion/packing.hpp"
#include "particles/insertion/region.hpp"

namespace silt {

/// A sphere that has found its place.
struct PlacedSphere {
  Vec3 centre;
  double radius;
};

/// Fills a region at random without overlaps: by random sequential addition (largest spheres first) up to a quarter of
/// solids, above by a random choice among the sites of the widest lattice that has enough of them, cubic or else
/// hexagonal, each particle moved at random within the gap to its neighbours. Adds the spheres to `placed`. Throws
/// UserError saying how many fit. `prefix` is the option prefix, for messages.
std::vector<PlacedSphere> fill_region(const InsertionOptions& options, const std::string& prefix, const Region& region,
                                      Packing& placed);

/// Particles on the sites of a simple cubic lattice: all that fit, or the first `count`.
std::vector<PlacedSphere> lattice_region(const InsertionOptions& options, const std::string& prefix,
                                         const Region& region, Packing& placed);

}  // namespace silt
