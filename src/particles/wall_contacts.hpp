#pragma once
#include <vector>

#include "particles/aligned.hpp"
#include "particles/particle_rows.hpp"
#include "particles/sweep.hpp"

namespace silt {

/// The contacts of particles with walls, from step to step. A point inherits the history of the point of the same
/// particle in the step before whose normal is nearest to its own, whichever wall that was on.
class WallContacts {
 public:
  /// `keep_lost`: contacts that are no longer there are listed in lost().
  explicit WallContacts(int components, bool keep_lost = false) : components_(components), keep_lost_(keep_lost) {}

  int count() const { return static_cast<int>(points_.size()); }
  const std::vector<WallPoint>& points() const { return points_; }
  static int row_width(int components) { return head + components; }

  /// Where the geometry writes the new points; adopt() then gives them their histories. Of the points further from
  /// their particle's surface than `gap` only those are kept that were nearer before: contacts that end with this step.
  std::vector<WallPoint>& next() { return next_; }
  void adopt(const Motion* particles, double gap);
  /// A contact that ended with the last adopt(), and what it remembered.
  struct Lost {
    int particle;
    std::vector<double> history;
  };
  const std::vector<Lost>& lost() const { return lost_; }
  double& history(int component, int contact) { return history_[component * stride_ + contact]; }
  double history(int component, int contact) const { return history_[component * stride_ + contact]; }
  void fill(WallSweep& sweep);

  /// {boundary, material, distance, normal, history} of every contact, for `particles` owned particles; and back, in
  /// their new order: all that is asked of a contact before the geometry is looked at again.
  void gather(int particles, ParticleRows& rows) const;
  void restore(const ParticleRows& rows);

 private:
  static constexpr int head = 6;  ///< of a row, before the history
  void resize(Aligned<double>& values, std::size_t& stride, int count) const;

  int components_;
  bool keep_lost_;
  std::vector<Lost> lost_;
  std::vector<char> taken_;  ///< of the old points
  std::vector<WallPoint> points_, next_;
  Aligned<double> history_, next_history_;  ///< [components][stride]
  std::size_t stride_ = 0, next_stride_ = 0;
};

}  // namespace silt
