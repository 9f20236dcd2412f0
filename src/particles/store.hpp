#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "particles/aligned.hpp"
#include "particles/particles.hpp"
#include "particles/sweep.hpp"

namespace silt {

/// The particles of this rank as the step loops see them: owned first, then ghosts, then two that pad the lists of
/// pairs to whole packs.
struct Store {
  int owned = 0, ghosts = 0;
  Aligned<Motion> motion;        ///< [owned + ghosts + 2]
  Aligned<Rotation> rotation;    ///< [owned + ghosts + 2]
  Aligned<Load> present;         ///< [owned + ghosts + 2] contact forces being summed up, or at the present positions
  Aligned<Load> previous;        ///< contact forces of the step before
  Aligned<DragStep> drag;        ///< [owned] only while a fluid acts
  Aligned<TurnStep> turning;     ///< [owned] only while a fluid holds the spins
  Aligned<double> turned;        ///< [owned][4] rad, of a step, only while a field has vectors fixed in the particles
  std::vector<std::int64_t> id;  ///< [owned + ghosts]
  std::vector<int> cell;         ///< [owned]
  bool acted_on = false;         ///< a fluid or who plays it has asked for the actions
  std::vector<FluidAction> action;  ///< [owned] where acted_on, else empty
  Columns columns;                  ///< [owned + ghosts] what models ask for

  int all() const { return owned + ghosts; }
  int padding() const { return owned + ghosts; }
  Body body(int p) const { return {motion[p], rotation[p]}; }
  void set_body(int p, const Body& body) { motion[p] = body, rotation[p] = body; }
  /// Makes room for `count` particles and the padding.
  void reserve(int count);
  /// Writes the padding particles behind the ghosts.
  void place_padding();
  /// Gives every particle a FluidAction from now on.
  void want_actions() {
    if (acted_on) return;
    acted_on = true;
    action.resize(owned);
  }
  /// Remembers where the particles are, all between `lower` and `upper`, for way().
  void note_origins(const Vec3& lower, const Vec3& upper);
  /// An upper bound of the distance from there, not far above it. m
  double way(int p) const { return std::sqrt(square_of_way(p)) + rounding_; }
  /// The largest of them; 0 without particles.
  double longest_way() const {
    double square = 0;
    for (int p = 0; p < owned; ++p) square = std::max(square, square_of_way(p));
    return owned > 0 ? std::sqrt(square) + rounding_ : 0;
  }
  /// What the arrays take, by name. B
  std::vector<std::pair<std::string, std::size_t>> bytes() const;
  /// New owned particle k was order[k]; those not in the order, which then ascends, are forgotten. Ghosts are lost.
  /// `carried` is the load that stays meaningful.
  void reorder(const std::vector<int>& order, Aligned<Load>& carried);

 private:
  double square_of_way(int p) const {
    double square = 0;
    for (int d = 0; d < 3; ++d) {
      const double moved = motion[p].position[d] - corner_[d] - origin_[3 * static_cast<std::size_t>(p) + d];
      square += moved * moved;
    }
    return square;
  }

  std::vector<float> origin_;  ///< [owned][3] m, from corner_
  double corner_[3] = {0, 0, 0}, rounding_ = 0;
};

}  // namespace silt
