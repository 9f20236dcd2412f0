#pragma once
#include <cstdint>
#include <vector>

#include "particles/sweep.hpp"

namespace silt {

/// Which cells of a coarse grid over a rank's particles hold one: a bit a cell, by which other ranks find those of
/// their particles that may lie near one of them. The box around all of a rank's particles would not do, for parts of a
/// domain may embrace each other.
class OccupiedCells {
 public:
  /// A box around a rank's particles, wrapped into the domain, and their number. The same on all ranks that use it.
  struct Extent {
    double lower[3], upper[3], particles;
  };
  /// No cell is marked. Cells are wider than `reach`, and not many more than the particles.
  OccupiedCells(const Extent& extent, double reach);

  void mark(const double* x);
  /// Marks the neighbours of all marked cells too.
  void spread();
  /// After spread(): true for every point, wrapped into the domain, nearer than the reach to a marked one or one of its
  /// periodic images, and for some that are further.
  bool near(const double* x, const Periods& periods) const;

  std::vector<std::uint64_t>& bits() { return bits_; }

 private:
  bool get(long cell) const { return bits_[cell / 64] >> cell % 64 & 1; }
  void set(long cell) { bits_[cell / 64] |= std::uint64_t(1) << cell % 64; }

  long count_[3];  ///< with a layer around the box
  double lower_[3], inverse_[3];
  std::vector<std::uint64_t> bits_;
};

/// Squared distance of two extents, or of their nearest periodic images, the same seen from either side. m2
double distance_square(const OccupiedCells::Extent& a, const OccupiedCells::Extent& b, const Periods& periods);

}  // namespace silt
