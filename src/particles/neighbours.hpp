#pragma once
#include <memory>
#include <vector>

#include "base/vector.hpp"
#include "particles/contact_lists.hpp"
#include "particles/store.hpp"

namespace silt {

/// A grid of cells over the particles of a rank, at least a reach wide; wraps where the domain is periodic.
class CellGrid {
 public:
  /// Covers positions [lower, upper]; in periodic directions the whole period from `origin`. `particles` bounds the
  /// number of cells.
  CellGrid(const Vec3& lower, const Vec3& upper, const Vec3& origin, const Periods& periods, double reach,
           int particles);

  int cells() const { return count_[0] * count_[1] * count_[2]; }
  int cell_of(const double* x) const {
    int c[3];
    for (int d = 0; d < 3; ++d) {
      c[d] = static_cast<int>((x[d] - lower_[d]) * inverse_[d]);
      c[d] = c[d] < 0 ? 0 : c[d] >= count_[d] ? count_[d] - 1 : c[d];
    }
    return (c[2] * count_[1] + c[1]) * count_[0] + c[0];
  }
  /// Runs of consecutive cells [first, last] that together are the cell and its neighbours, each cell once.
  struct Run {
    int first, last;
  };
  int neighbours(int cell, Run* run) const;  ///< at most 27 runs
  /// Rows of cells along x; cell c is the (c % cells_a_row())-th of row c / cells_a_row().
  int rows() const { return count_[1] * count_[2]; }
  int cells_a_row() const { return count_[0]; }
  /// A row and how many periods further up in y and z it is met.
  struct Row {
    int row, periods[2];
  };
  /// The row and those of its neighbours that have higher numbers, also across periodic sides, at most 9; only where
  /// each is met once.
  int later_rows(int row, Row* rows) const;
  /// Whether no two cells are neighbours on two sides: periodic directions have three at least.
  bool each_once() const;
  const double* lower() const { return lower_; }
  double largest_extent() const { return largest_; }  ///< m, of what is covered

 private:
  int count_[3];
  bool wraps_[3];
  double lower_[3], inverse_[3], largest_ = 0;
};

/// The owned particles in the order of the cells of a grid.
struct CellOrder {
  std::vector<int> order;  ///< for Store::reorder
  std::vector<int> start;  ///< [cells + 1] where each cell begins in it
  int steps_back = 0;      ///< particles that stand behind one of a later cell: 0 when all stand in this order already
};
CellOrder order_along(const CellGrid& grid, const Store& store);

/// The owned particles, sorted along the cells of a grid, for searches.
struct Bins {
  std::vector<int> start;     ///< [cells + 1]
  std::vector<int> particle;  ///< who stands where
  /// Positions and radii, and a few more entries for whole packs. m
  std::unique_ptr<double[]> x, y, z, r;
  /// `placed`: with positions and radii, without which only find_pairs() can do.
  Bins(CellOrder&& order, const Store& store, bool placed = true);
  void place(const Store& store);
};

/// Whether one of the bins' particles has its surface nearer than `gap` to that of a sphere at x (3 doubles).
bool any_within(const CellGrid& grid, const Bins& bins, const Periods& periods, const double* x, double radius,
                double gap);

/// Gaps between surfaces (m): at which a pair becomes a contact and ceases to be one, to which pairs are listed beyond
/// that, and below which a pair with a history still is a contact.
struct PairReach {
  double enter_gap = 0, leave_gap = 0, skin = 0, memory_gap = 0;
};

/// Fills the lists, which are empty, with all pairs of two owned particles, or of one and a ghost, nearer than
/// leave_gap
/// + skin. `own`: the bins of the owned particles.
void find_pairs(const CellGrid& grid, Bins& own, const Store& store, const Periods& periods,
                const PairReach& pair_reach, const ContactMemory& memory, const Kernels& kernels, ContactLists& lists);

}  // namespace silt
