#pragma once
#include <cmath>

/// Force laws are written once for any number type: double (reference path, wall helpers, tests), a pack of doubles
/// (the vectorised sweep, pack.hpp) or a dual number. They use + - * /, comparisons, sqrt, cbrt, exp, log, and the
/// functions below.
#define SILT_INLINE __attribute__((always_inline)) inline

namespace silt {

/// a where the condition holds, else b, in every lane; both are evaluated.
SILT_INLINE double select(bool condition, double a, double b) { return condition ? a : b; }
SILT_INLINE double sqrt(double a) { return __builtin_sqrt(a); }
SILT_INLINE double cbrt(double a) { return __builtin_cbrt(a); }
SILT_INLINE double exp(double a) { return __builtin_exp(a); }
SILT_INLINE double log(double a) { return __builtin_log(a); }

/// Whether a comparison holds in any lane.
SILT_INLINE bool any_lane(bool condition) { return condition; }

template <class Real>
SILT_INLINE Real larger(Real a, Real b) {
  return select(a > b, a, b);
}
template <class Real>
SILT_INLINE Real smaller(Real a, Real b) {
  return select(a < b, a, b);
}

template <class Real>
SILT_INLINE Real magnitude(Real a) {
  return larger(a, Real(0.0) - a);
}

}  // namespace silt
