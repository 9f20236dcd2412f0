#pragma once
#include <cmath>

namespace silt {

/// A number with its derivatives in N directions (forward automatic differentiation): a formula templated on its scalar
/// gives its value with `double` and its exact gradient with `Dual`. T is the number itself: double, or a pack of lanes
/// (one cell a lane, see Lanes) when many points are differentiated at once.
template <int N, class T = double>
struct Dual {
  T value{};
  T derivative[N]{};

  Dual() = default;
  Dual(const T& v) : value(v) {}
  /// The independent variable number `direction`.
  static Dual variable(const T& v, int direction) {
    Dual result(v);
    result.derivative[direction] = T{} + 1.0;
    return result;
  }

  Dual& operator+=(const Dual& b) {
    value += b.value;
    for (int i = 0; i < N; ++i) derivative[i] += b.derivative[i];
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    value -= b.value;
    for (int i = 0; i < N; ++i) derivative[i] -= b.derivative[i];
    return *this;
  }
  Dual& operator+=(const T& b) {
    value += b;
    return *this;
  }
  Dual& operator-=(const T& b) {
    value -= b;
    return *this;
  }
  Dual& operator*=(const T& b) {
    value *= b;
    for (int i = 0; i < N; ++i) derivative[i] *= b;
    return *this;
  }

  Dual& operator*=(const Dual& b) { return *this = *this * b; }

  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator+(Dual a, const T& b) { return a += b; }
  friend Dual operator+(const T& a, Dual b) { return b += a; }
  friend Dual operator-(Dual a, const T& b) { return a -= b; }
  friend Dual operator-(const T& a, const Dual& b) { return -b + a; }
  friend Dual operator-(Dual a) {
    a.value = -a.value;
    for (int i = 0; i < N; ++i) a.derivative[i] = -a.derivative[i];
    return a;
  }
  friend Dual operator*(Dual a, const T& b) { return a *= b; }
  friend Dual operator*(const T& a, Dual b) { return b *= a; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual result(a.value * b.value);
    for (int i = 0; i < N; ++i) result.derivative[i] = a.value * b.derivative[i] + b.value * a.derivative[i];
    return result;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const T inverse = 1.0 / b.value;
    Dual result(a.value * inverse);
    for (int i = 0; i < N; ++i) result.derivative[i] = (a.derivative[i] - result.value * b.derivative[i]) * inverse;
    return result;
  }
  friend Dual operator/(Dual a, const T& b) { return a *= 1.0 / b; }
  friend Dual operator/(const T& a, const Dual& b) { return Dual(a) / b; }
};

/// f(x) with f' known: the chain rule.
template <int N, class T>
Dual<N, T> chain(const Dual<N, T>& x, const T& f, const T& slope) {
  Dual<N, T> result(f);
  for (int i = 0; i < N; ++i) result.derivative[i] = slope * x.derivative[i];
  return result;
}
/// Square root of a number, of a pack of lanes (one by one) or of a dual number.
template <class T>
inline T square_root(const T& x) {
  if constexpr (sizeof(T) == sizeof(double)) {
    return __builtin_sqrt(x);
  } else {
    T y;
    for (unsigned l = 0; l < sizeof(T) / sizeof(double); ++l) y[l] = __builtin_sqrt(x[l]);
    return y;
  }
}
template <int N, class T>
inline Dual<N, T> square_root(const Dual<N, T>& x) {
  const T root = square_root(x.value);
  return chain(x, root, T(0.5 / root));
}
template <int N, class T>
Dual<N, T> sqrt(const Dual<N, T>& x) {
  return square_root(x);
}
/// The other functions a formula uses are found by name: `using std::sin; sin(x)`.
template <int N, class T>
Dual<N, T> sin(const Dual<N, T>& x) {
  using std::cos, std::sin;
  return chain(x, T(sin(x.value)), T(cos(x.value)));
}
template <int N, class T>
Dual<N, T> cos(const Dual<N, T>& x) {
  using std::cos, std::sin;
  return chain(x, T(cos(x.value)), T(-sin(x.value)));
}
template <int N, class T>
Dual<N, T> exp(const Dual<N, T>& x) {
  using std::exp;
  const T e = exp(x.value);
  return chain(x, e, e);
}

/// W doubles handled by one instruction: lane k belongs to the k-th cell of a batch.
template <int W>
struct LanesOf {
  typedef double type __attribute__((vector_size(W * sizeof(double))));
};
template <int W>
using Lanes = typename LanesOf<W>::type;

}  // namespace silt
