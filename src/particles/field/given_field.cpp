#include "particles/field/given_field.hpp"

#include <algorithm>

namespace silt {

FieldRange GivenField::range(const Vec3& lower, const Vec3& upper) const {
  // From a tenth of a picosecond to a quarter of an hour, seven times a decade: whatever its frequency, a field that
  // swings is met in several phases of its first period. Steps that start on round numbers are not straddled.
  constexpr double first = 1.234e-13, growth = 1.3895, last = 1e3;
  const auto place = [&](int k, int n) {
    const Vec3 share = Vec3(k % n, k / n % n, k / (n * n)) / (n - 1);
    return Vec3(lower + share.cwiseProduct(upper - lower));
  };
  const Expression::Trial trial;
  FieldRange range;
  for (int k = 0; k < (uniform() ? 1 : 125); ++k)
    range.largest = std::max(range.largest, formula_(place(k, 5), 0).norm());
  double change = 0;
  for (double t = first; t < last; t *= growth)
    for (int k = 0; k < (uniform() ? 1 : 8); ++k) {
      const Vec3 x = place(k, 2);
      range.largest = std::max(range.largest, formula_(x, t).norm());
      // A jump between two times is as slow as the longer of two differences tells.
      const auto slope = [&](double h) { return (formula_(x, t + h) - formula_(x, t - h)).norm() / (2 * h); };
      change = std::max(change, std::min(slope(1e-3 * t), slope(0.03 * t)));
    }
  if (range.largest > 0) range.rate = change / range.largest;
  return range;
}

}  // namespace silt
