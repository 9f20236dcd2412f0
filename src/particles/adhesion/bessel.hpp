#pragma once
#include "particles/real.hpp"

namespace silt {

/// Modified Bessel function K1(x), x > 0, to 3e-7 of its value (Abramowitz & Stegun 1964, 9.8.3, 9.8.7 and 9.8.8).
template <class Real>
SILT_INLINE Real bessel_k1(Real x) {
  const auto series = [](Real t, const double(&c)[7]) {
    Real sum(c[6]);
    for (int k = 5; k >= 0; --k) sum = sum * t + Real(c[k]);
    return sum;
  };
  constexpr double i1[7] = {0.5, 0.87890594, 0.51498869, 0.15084934, 0.02658733, 0.00301532, 0.00032411};
  constexpr double small[7] = {1.0, 0.15443144, -0.67278579, -0.18156897, -0.01919402, -0.00110404, -0.00004686};
  constexpr double large[7] = {1.25331414, 0.23498619, -0.03655620, 0.01504268, -0.00780353, 0.00325614, -0.00068245};
  const Real two(2.0), near = smaller(x, two), far = larger(x, two);
  const Real t = near / Real(3.75), y = Real(0.5) * near;
  const Real low = log(y) * near * series(t * t, i1) + series(y * y, small) / near;
  const Real high = exp(Real(0.0) - far) / sqrt(far) * series(two / far, large);
  return select(x < two, low, high);
}

}  // namespace silt
