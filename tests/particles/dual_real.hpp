#pragma once
#include <cmath>

#include "base/dual.hpp"

namespace silt {

// What the laws ask of a number type (real.hpp), for dual numbers.
template <int N>
bool operator>(const Dual<N>& a, const Dual<N>& b) {
  return a.value > b.value;
}
template <int N>
bool operator<(const Dual<N>& a, const Dual<N>& b) {
  return a.value < b.value;
}
template <int N>
bool operator>=(const Dual<N>& a, const Dual<N>& b) {
  return a.value >= b.value;
}
template <int N>
bool operator<=(const Dual<N>& a, const Dual<N>& b) {
  return a.value <= b.value;
}
template <int N>
Dual<N> select(bool condition, const Dual<N>& a, const Dual<N>& b) {
  return condition ? a : b;
}
template <int N>
Dual<N> cbrt(const Dual<N>& x) {
  const double root = std::cbrt(x.value);
  return chain(x, root, 1 / (3 * root * root));
}
template <int N>
Dual<N> log(const Dual<N>& x) {
  return chain(x, std::log(x.value), 1 / x.value);
}

}  // namespace silt
