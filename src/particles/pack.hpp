// Packs of doubles for the translation units that are compiled once per instruction set. Include only from sweep_*.cpp,
// which define SILT_ISA (a namespace of their own, so that no inline function compiled for a wide instruction set can
// stand in for the plain one at link time) and SILT_LANES.
#pragma once
#include <immintrin.h>

// Everything here is inlined: no vector crosses a call, so its calling convention does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif

#include "particles/real.hpp"

namespace silt {
namespace SILT_ISA {

inline constexpr int lanes = SILT_LANES;
using Quad = double __attribute__((vector_size(32)));
using Vector = double __attribute__((vector_size(8 * SILT_LANES)));
using Bits = long long __attribute__((vector_size(8 * SILT_LANES)));

/// The outcome of a comparison, lane by lane.
struct Mask {
  Bits bits;
};

/// One double a lane.
struct Pack {
  Vector v;
  Pack() = default;
  SILT_INLINE Pack(Vector a) : v(a) {}
  SILT_INLINE Pack(double a) : v(a - Vector{}) {}
};

SILT_INLINE Pack operator+(Pack a, Pack b) { return a.v + b.v; }
SILT_INLINE Pack operator-(Pack a, Pack b) { return a.v - b.v; }
SILT_INLINE Pack operator*(Pack a, Pack b) { return a.v * b.v; }
SILT_INLINE Pack operator/(Pack a, Pack b) { return a.v / b.v; }
SILT_INLINE Pack operator-(Pack a) { return -a.v; }
SILT_INLINE Mask operator>(Pack a, Pack b) { return {a.v > b.v}; }
SILT_INLINE Mask operator<(Pack a, Pack b) { return {a.v < b.v}; }
SILT_INLINE Mask operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
SILT_INLINE Mask operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
SILT_INLINE Mask operator&(Mask a, Mask b) { return {a.bits & b.bits}; }
SILT_INLINE Mask operator|(Mask a, Mask b) { return {a.bits | b.bits}; }
SILT_INLINE Pack select(Mask condition, Pack a, Pack b) { return condition.bits ? a.v : b.v; }

SILT_INLINE Pack load(const double* p) { return *reinterpret_cast<const Vector*>(p); }
SILT_INLINE Pack load_unaligned(const double* p) {
  Pack a;
  __builtin_memcpy(&a.v, p, sizeof a.v);
  return a;
}
SILT_INLINE void store(double* p, Pack a) { *reinterpret_cast<Vector*>(p) = a.v; }
SILT_INLINE void store_unaligned(double* p, Pack a) { __builtin_memcpy(p, &a.v, sizeof a.v); }

#if SILT_LANES == 8
/// The processor's own root of eight doubles takes about 24 cycles, and all laws wait for it; a step of Goldschmidt
/// from 14 to 28 bits and one of Newton on the remainder give the same but for the last bit in about 5.
SILT_INLINE Pack sqrt(Pack a) {
  const __m512d x = __m512d(a.v), half = _mm512_set1_pd(0.5);
  const __m512d guess = _mm512_maskz_rsqrt14_pd(0xff, x);
  __m512d root = x * guess, half_inverse = half * guess;
  const __m512d off = _mm512_fnmadd_pd(root, half_inverse, half);
  root = _mm512_fmadd_pd(root, off, root);
  half_inverse = _mm512_fmadd_pd(half_inverse, off, half_inverse);
  root = _mm512_fmadd_pd(_mm512_fnmadd_pd(root, root, x), half_inverse, root);
  const __mmask8 itself = _mm512_fpclass_pd_mask(x, 0x0e);  // zeros and infinity
  return Vector(_mm512_mask_blend_pd(itself, root, x));
}
// With a mask of all lanes: without one, g++ 12 warns of the undefined vector that the header hands on.
SILT_INLINE Pack nearest(Pack a) { return Vector(_mm512_maskz_roundscale_pd(0xff, __m512d(a.v), 8)); }
/// Bit k is set where lane k of the mask is.
SILT_INLINE unsigned lane_bits(Mask a) { return _mm512_movepi64_mask(__m512i(a.bits)); }
#elif defined(__AVX2__)
SILT_INLINE Pack sqrt(Pack a) { return Vector(_mm256_sqrt_pd(__m256d(a.v))); }
SILT_INLINE Pack nearest(Pack a) { return Vector(_mm256_round_pd(__m256d(a.v), 8)); }
SILT_INLINE unsigned lane_bits(Mask a) { return unsigned(_mm256_movemask_pd(__m256d(a.bits))); }
#else
SILT_INLINE Pack sqrt(Pack a) {
  Vector r;
  for (int k = 0; k < lanes; ++k) r[k] = __builtin_sqrt(a.v[k]);
  return r;
}
SILT_INLINE Pack nearest(Pack a) {
  // Adding and taking away 1.5 * 2^52 rounds to the nearest whole number, ties to even, as the other two do.
  const Vector shift = 6755399441055744.0 - Vector{};
  return (a.v + shift) - shift;
}
SILT_INLINE unsigned lane_bits(Mask a) {
  unsigned bits = 0;
  for (int k = 0; k < lanes; ++k) bits |= a.bits[k] ? 1u << k : 0u;
  return bits;
}
#endif

SILT_INLINE bool any_lane(Mask a) { return lane_bits(a) != 0; }

// Lane by lane: only the rarer laws use them, and so each lane gets the bits of the same formula in plain numbers.
SILT_INLINE Pack cbrt(Pack a) {
  Vector r;
  for (int k = 0; k < lanes; ++k) r[k] = __builtin_cbrt(a.v[k]);
  return r;
}
SILT_INLINE Pack exp(Pack a) {
  Vector r;
  for (int k = 0; k < lanes; ++k) r[k] = __builtin_exp(a.v[k]);
  return r;
}
SILT_INLINE Pack log(Pack a) {
  Vector r;
  for (int k = 0; k < lanes; ++k) r[k] = __builtin_log(a.v[k]);
  return r;
}

/// Reads one quad of doubles (at offset `at` doubles) from the record of each lane and turns the rows into columns.
SILT_INLINE void load_columns(const double* base, int stride, int at, const int* index, Pack* column) {
  const auto row = [&](int k) {
    return *reinterpret_cast<const Quad*>(base + static_cast<long>(index[k]) * stride + at);
  };
#if SILT_LANES == 8
  const auto two = [&](int k) { return __builtin_shufflevector(row(k), row(k + 4), 0, 1, 2, 3, 4, 5, 6, 7); };
  const Vector r0 = two(0), r1 = two(1), r2 = two(2), r3 = two(3);
  const Vector t0 = __builtin_shufflevector(r0, r1, 0, 8, 2, 10, 4, 12, 6, 14);
  const Vector t1 = __builtin_shufflevector(r0, r1, 1, 9, 3, 11, 5, 13, 7, 15);
  const Vector t2 = __builtin_shufflevector(r2, r3, 0, 8, 2, 10, 4, 12, 6, 14);
  const Vector t3 = __builtin_shufflevector(r2, r3, 1, 9, 3, 11, 5, 13, 7, 15);
  column[0] = __builtin_shufflevector(t0, t2, 0, 1, 8, 9, 4, 5, 12, 13);
  column[1] = __builtin_shufflevector(t1, t3, 0, 1, 8, 9, 4, 5, 12, 13);
  column[2] = __builtin_shufflevector(t0, t2, 2, 3, 10, 11, 6, 7, 14, 15);
  column[3] = __builtin_shufflevector(t1, t3, 2, 3, 10, 11, 6, 7, 14, 15);
#else
  const Quad r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
  const Quad t0 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6), t1 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7);
  const Quad t2 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6), t3 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
  column[0] = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  column[1] = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  column[2] = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  column[3] = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
#endif
}

/// Turns three columns of four contacts (and a column of zeros) into the contacts' rows.
SILT_INLINE void rows_of(Quad x, Quad y, Quad z, Quad* row) {
  const Quad zero = {};
  const Quad t0 = __builtin_shufflevector(x, y, 0, 4, 2, 6), t1 = __builtin_shufflevector(x, y, 1, 5, 3, 7);
  const Quad t2 = __builtin_shufflevector(z, zero, 0, 4, 2, 6), t3 = __builtin_shufflevector(z, zero, 1, 5, 3, 7);
  row[0] = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  row[1] = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  row[2] = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  row[3] = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}

#if SILT_LANES == 8
/// Turns six columns of eight contacts (force and couple) into the contacts' records of force, 0, couple, 0.
SILT_INLINE void records_of(const Vector* column, Vector* row) {
  const Vector zero = {};
  const auto low = [](Vector a, Vector b) { return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14); };
  const auto high = [](Vector a, Vector b) { return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15); };
  for (int odd = 0; odd < 2; ++odd) {
    const Vector a = odd ? high(column[0], column[1]) : low(column[0], column[1]);
    const Vector b = odd ? high(column[2], zero) : low(column[2], zero);
    const Vector c = odd ? high(column[3], column[4]) : low(column[3], column[4]);
    const Vector d = odd ? high(column[5], zero) : low(column[5], zero);
    const Vector ab = __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11);
    const Vector cd = __builtin_shufflevector(c, d, 0, 1, 2, 3, 8, 9, 10, 11);
    row[odd] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5, 8, 9, 12, 13);
    row[2 + odd] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7, 10, 11, 14, 15);
    const Vector ab2 = __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15);
    const Vector cd2 = __builtin_shufflevector(c, d, 4, 5, 6, 7, 12, 13, 14, 15);
    row[4 + odd] = __builtin_shufflevector(ab2, cd2, 0, 1, 4, 5, 8, 9, 12, 13);
    row[6 + odd] = __builtin_shufflevector(ab2, cd2, 2, 3, 6, 7, 10, 11, 14, 15);
  }
}

/// The sign in the first four lanes, the arm in the others.
SILT_INLINE Vector force_and_arm(double sign, const double* arm) {
  return Vector(_mm512_mask_broadcastsd_pd(_mm512_set1_pd(sign), 0xf0, _mm_load_sd(arm)));
}
#endif

}  // namespace SILT_ISA
}  // namespace silt
