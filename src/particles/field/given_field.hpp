#pragma once
#include <string>

#include "base/expression.hpp"

namespace silt {

/// What the time step must know of a field.
struct FieldRange {
  double largest = 0;  ///< in the field's unit
  double rate = 0;  ///< 1/s, the largest change in time over the largest size: 2 pi f of one that turns or alternates
};

/// A vector field given by formulas in x, y, z, t, with its gradient by central differences (of fourth order, so that
/// fields up to cubic ones are exact to round-off).
class GivenField {
 public:
  /// `extent`: m, of the domain: the differences are taken over a share of it.
  GivenField(const std::string& option, const std::string& text, double extent)
      : formula_(option, text), step_(1e-3 * extent) {}
  /// Its largest size and how fast it changes, sampled over places in the box [lower, upper] and times of all scales.
  FieldRange range(const Vec3& lower, const Vec3& upper) const;
  bool uniform() const { return formula_.uniform(); }
  Vec3 operator()(const Vec3& x, double t) const { return formula_(x, t); }
  /// gradient(k, d) = dH_k/dx_d.
  Mat3 gradient(const Vec3& x, double t) const {
    if (uniform()) return Mat3::Zero();
    Mat3 result;
    for (int d = 0; d < 3; ++d) {
      const Vec3 e = step_ * Vec3::Unit(d);
      result.col(d) =
          (8 * (formula_(x + e, t) - formula_(x - e, t)) - (formula_(x + 2 * e, t) - formula_(x - 2 * e, t))) /
          (12 * step_);
    }
    return result;
  }

 private:
  VectorExpression formula_;
  double step_;
};

}  // namespace silt
