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
  explicit WallContacts(int components) : components_(components) {}

  int count() const { return static_cast<int>(points_.size()); }
  const std::vector<WallPoint>& points() const { return points_; }
  int row_width() const { return 4 + components_; }

  /// Where the geometry writes the new points; adopt() then gives them their histories.
  std::vector<WallPoint>& next() { return next_; }
  void adopt();
  void fill(WallSweep& sweep);

  /// {boundary, normal, history} of every contact, for `particles` owned particles; and back, in their new order.
  void gather(int particles, ParticleRows& rows) const;
  void restore(const ParticleRows& rows);

 private:
  double* history(int component) { return history_.data() + component * stride_; }
  const double* history(int component) const { return history_.data() + component * stride_; }
  void resize(Aligned<double>& values, std::size_t& stride, int count) const;

  int components_;
  std::vector<WallPoint> points_, next_;
  Aligned<double> history_, next_history_;  ///< [components][stride]
  std::size_t stride_ = 0, next_stride_ = 0;
};

}  // namespace silt
