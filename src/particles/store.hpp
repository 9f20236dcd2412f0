#pragma once
#include <cstdint>
#include <vector>

#include "particles/aligned.hpp"
#include "particles/particles.hpp"
#include "particles/sweep.hpp"

namespace silt {

/// Four doubles of a particle, aligned.
struct alignas(32) Row {
  double entry[4];
};

/// The particles of this rank as the step loops see them: owned first, then ghosts, then two dummies that pad the lists
/// of pairs to whole packs.
struct Store {
  int owned = 0, ghosts = 0;
  Aligned<Motion> motion;        ///< [owned + ghosts + 2]
  Aligned<Load> present;         ///< [owned + ghosts + 2] contact forces being summed up, or at the present positions
  Aligned<Load> previous;        ///< contact forces of the step before
  Aligned<Row> origin;           ///< [owned] m, positions at the last rebuild
  Aligned<DragStep> drag;        ///< [owned] only while a fluid acts
  Aligned<TurnStep> turning;     ///< [owned] only while a fluid holds the spins
  std::vector<std::int64_t> id;  ///< [owned + ghosts]
  std::vector<int> cell;         ///< [owned]
  std::vector<FluidAction> action;  ///< [owned]
  Columns columns;                  ///< [owned + ghosts] what models ask for

  int all() const { return owned + ghosts; }
  int dummy() const { return owned + ghosts; }
  /// Makes room for `count` particles and the dummies.
  void reserve(int count);
  /// Writes the dummy records behind the ghosts.
  void place_dummies();
  /// New owned particle k was order[k]; those not in the order are forgotten. Ghosts are lost. `carried` is the load
  /// that stays meaningful.
  void reorder(const std::vector<int>& order, Aligned<Load>& carried);

 private:
  Aligned<Motion> motion_scratch_;
  Aligned<Load> load_scratch_;
};

}  // namespace silt
