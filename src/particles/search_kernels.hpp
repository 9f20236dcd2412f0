// The search for spheres near one sphere; part of sweep_kernels.hpp, compiled once per instruction set.
#pragma once
#include "particles/pack.hpp"
#include "particles/sweep.hpp"

namespace silt {
namespace SILT_ISA {

SILT_INLINE void nearest_image(const Periods& periods, Pack* distance) {
  for (int d = 0; d < 3; ++d)
    distance[d] = distance[d] - Pack(periods.length[d]) * nearest(distance[d] * Pack(periods.inverse[d]));
}

/// Writes the number and the square of every lane that is set, one behind the other; returns how many.
SILT_INLINE int keep_lanes(unsigned set, int first, Pack square, int* number, double* squares) {
#if SILT_LANES == 8
  const __m256i numbers = _mm256_add_epi32(_mm256_set1_epi32(first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(number), _mm256_maskz_compress_epi32(__mmask8(set), numbers));
  _mm512_storeu_pd(squares, _mm512_maskz_compress_pd(__mmask8(set), __m512d(square.v)));
  return __builtin_popcount(set);
#else
  int kept = 0;
  for (int k = 0; k < lanes; ++k) {
    number[kept] = first + k;
    squares[kept] = square.v[k];
    kept += set >> k & 1;
  }
  return kept;
#endif
}

/// Adds those with numbers in [begin, end) that are near the sphere at x (and of its radius) to the first `found`.
template <bool across>
SILT_INLINE int near_in_stretch(const NearSearch& search, const Pack* x, Pack cut_off, int begin, int end, int found) {
  for (int k = begin; k < end; k += lanes) {
    Pack distance[3];
    for (int d = 0; d < 3; ++d) distance[d] = x[d] - load_unaligned(search.x[d] + k);
    if constexpr (across) nearest_image(*search.periods, distance);
    const Pack square = dot(distance, distance), cut = cut_off + load_unaligned(search.radius + k);
    unsigned near = lane_bits(square < cut * cut);
    if (end - k < lanes) near &= (1u << (end - k)) - 1;
    found += keep_lanes(near, k, square, search.found + found, search.square + found);
  }
  return found;
}

template <bool across>
SILT_INLINE void near_spheres(NearSearch& search) {
  Pack x[3];
  for (int d = 0; d < 3; ++d) x[d] = Pack(search.sphere[d]);
  const Pack cut_off(search.sphere[3] + search.reach);
  int found = 0;
  for (int q = 0; q < search.stretches; ++q) {
    const int begin = search.stretch[q].begin > search.after ? search.stretch[q].begin : search.after + 1;
    found = near_in_stretch<across>(search, x, cut_off, begin, search.stretch[q].end, found);
  }
  search.count = found;
}
void near_sphere(NearSearch& search) { search.across ? near_spheres<true>(search) : near_spheres<false>(search); }

using Floats = float __attribute__((vector_size(32)));
using Ints = int __attribute__((vector_size(32)));
SILT_INLINE Floats floats_at(const float* p) {
  Floats values;
  __builtin_memcpy(&values, p, sizeof values);
  return values;
}
SILT_INLINE void put(void* p, Floats values) { __builtin_memcpy(p, &values, sizeof values); }
SILT_INLINE void put(void* p, Ints values) { __builtin_memcpy(p, &values, sizeof values); }

/// Spheres that seekers are compared with, side by side in the order of the rows they were copied from.
struct Nearby {
  static constexpr int room = 512, widest = 16;  // floats of a register
  int count = 0;
  alignas(64) float x[3][room + widest], radius[room + widest];
  alignas(64) int number[room + widest];

  /// Adds those from begin on, as far as there is room; returns the first that there is none for, or `end`.
  SILT_INLINE int take(const RowSearch& search, int begin, int end, const float* shift) {
    const int taken = end - begin < room - count ? end - begin : room - count;
    for (int k = 0; k < taken; k += 8) {
      const int from = begin + k, to = count + k;
      for (int d = 0; d < 3; ++d) put(x[d] + to, floats_at(search.x[d] + from) + shift[d]);
      put(radius + to, floats_at(search.radius + from));
      put(number + to, Ints{0, 1, 2, 3, 4, 5, 6, 7} + from);
    }
    count += taken;
    return begin + taken;
  }
  /// Fills the last register with spheres that are near none.
  SILT_INLINE void pad() {
    for (int q = 0; q < widest; ++q) x[0][count + q] = 1e30F, number[count + q] = 0;
  }
};

/// Adds the pairs of a seeker with those behind it in the order of the cells that are near, with squared distances for
/// gaps; returns how many have been found with these.
SILT_INLINE int near_seeker(const RowSearch& search, const Nearby& nearby, int seeker, int found) {
#if SILT_LANES == 8
  const __m512 x = _mm512_set1_ps(search.x[0][seeker]), y = _mm512_set1_ps(search.x[1][seeker]),
               z = _mm512_set1_ps(search.x[2][seeker]), radius = _mm512_set1_ps(search.radius[seeker]),
               reach = _mm512_set1_ps(search.reach);
  const __m512i self = _mm512_set1_epi32(seeker);
  for (int k = 0; k < nearby.count; k += 16) {
    const __m512 dx = _mm512_sub_ps(x, _mm512_load_ps(nearby.x[0] + k)),
                 dy = _mm512_sub_ps(y, _mm512_load_ps(nearby.x[1] + k)),
                 dz = _mm512_sub_ps(z, _mm512_load_ps(nearby.x[2] + k));
    const __m512 square = _mm512_fmadd_ps(dz, dz, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dx, dx)));
    const __m512 radii = _mm512_add_ps(radius, _mm512_load_ps(nearby.radius + k)), cut = _mm512_add_ps(radii, reach);
    const __m512i number = _mm512_load_si512(nearby.number + k);
    const __mmask16 near =
        _mm512_mask_cmp_ps_mask(_mm512_cmpgt_epi32_mask(number, self), square, _mm512_mul_ps(cut, cut), _CMP_LT_OQ);
    _mm512_storeu_si512(search.seeker + found, self);
    _mm512_storeu_si512(search.found + found, _mm512_maskz_compress_epi32(near, number));
    _mm512_storeu_ps(search.gap + found, _mm512_maskz_compress_ps(near, square));
    _mm512_storeu_ps(search.radii + found, _mm512_maskz_compress_ps(near, radii));
    found += __builtin_popcount(near);
  }
#else
  const float x = search.x[0][seeker], y = search.x[1][seeker], z = search.x[2][seeker];
  for (int k = 0; k < nearby.count; k += 8) {
    const auto row = [k](const float* from) { return floats_at(from + k); };
    const Floats dx = x - row(nearby.x[0]), dy = y - row(nearby.x[1]), dz = z - row(nearby.x[2]);
    const Floats square = dx * dx + dy * dy + dz * dz, radii = search.radius[seeker] + row(nearby.radius);
    const Floats cut = radii + search.reach;
    const Ints is_near = (square < cut * cut) & (*reinterpret_cast<const Ints*>(nearby.number + k) > seeker);
#if defined(__AVX2__)
    unsigned near = unsigned(_mm256_movemask_ps(__m256(is_near)));
#else
    unsigned near = 0;
    for (int q = 0; q < 8; ++q) near |= is_near[q] ? 1u << q : 0u;
#endif
    for (; near; near &= near - 1) {
      const int q = __builtin_ctz(near);
      search.seeker[found] = seeker;
      search.found[found] = nearby.number[k + q];
      search.gap[found] = square[q];
      search.radii[found++] = radii[q];
    }
  }
#endif
  return found;
}

/// A few seekers at once, which stand side by side, against all in the cells around them, copied side by side too: full
/// registers, and little to set up a seeker.
void near_row(RowSearch& search) {
  constexpr int at_once = 5, most = 3 * 9;
  struct Stretch {
    int begin, end;
    float shift[3];
  } stretch[most];
  Nearby nearby;
  int found = 0;
  while (search.next < search.last) {
    const int first = search.next;
    int seekers = search.last - first < at_once ? search.last - first : at_once;
    const int left = search.column[first], right = search.column[first + seekers - 1];
    const int before = left > 0 ? left - 1 : 0, after = right + 2 < search.cells ? right + 2 : search.cells;
    int count = 0, others = 0;
    const auto look_at = [&](const RowSearch::Row& row, int begin, int end, float shift) {
      stretch[count++] = {begin, end, {shift, row.shift[0], row.shift[1]}};
      others += end - begin;
    };
    look_at(search.row[0], first + 1, search.row[0].start[after], 0);
    for (int q = 1; q < search.rows; ++q)
      look_at(search.row[q], search.row[q].start[before], search.row[q].start[after], 0);
    if (search.period > 0) {
      // The cells at the other ends of the rows; of the own row only what is behind the seekers.
      for (int q = 0; left == 0 && q < search.rows; ++q)
        look_at(search.row[q], search.row[q].start[search.cells - 1], search.row[q].start[search.cells],
                -search.period);
      for (int q = 1; right + 1 == search.cells && q < search.rows; ++q)
        look_at(search.row[q], search.row[q].start[0], search.row[q].start[1], search.period);
    }
    if (found + seekers * others + Nearby::widest > search.room) {
      if (found > 0) break;
      // The fewer seekers, the less may be found.
      seekers = others > 0 ? (search.room - Nearby::widest) / others : seekers;
      search.needed = others + Nearby::widest;
      if (seekers == 0) break;
    }
    const auto compare = [&] {
      nearby.pad();
      for (int s = first; s < first + seekers; ++s) found = near_seeker(search, nearby, s, found);
      nearby.count = 0;
    };
    nearby.count = 0;
    for (int q = 0; q < count; ++q)
      for (int k = stretch[q].begin; k < stretch[q].end;) {
        k = nearby.take(search, k, stretch[q].end, stretch[q].shift);
        if (nearby.count == Nearby::room) compare();
      }
    compare();
    search.next += seekers;
  }
  search.count = found;
  // Roots only of those that are near.
  float *const gap = search.gap, *const radii = search.radii;
  for (int k = 0; k < found; ++k) gap[k] = __builtin_sqrtf(gap[k]) - radii[k];
}

}  // namespace SILT_ISA
}  // namespace silt
