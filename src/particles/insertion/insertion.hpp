#pragma once
#include <string>
#include <vector>

#include "particles/particles.hpp"
#include "particles/walls/walls.hpp"

namespace silt {

/// Reads every `-insertion_<name>_...` and makes the particles of the start, in the alphabetical order of the names.
/// `materials` are the names by index. The result is the same on every rank and for every rank count; each rank keeps
/// those in its cells (Locator::claim). Particles overlap neither each other (but those of a file by at most
/// `largest_overlap`) nor walls. Throws UserError, the same on every rank, for a demand that does not fit and for a bad
/// file. `only_check`: the options are read and none is made. Collective.
std::vector<Seed> make_insertions(const Walls& walls, Options& options, const std::vector<std::string>& materials,
                                  bool only_check = false);

}  // namespace silt
