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

/// One cell of the row after the other, as far as the room for what is found reaches.
void near_row(RowSearch& row) {
  NearSearch& search = row.search;
  int found = 0;
  for (; row.cell < row.last; ++row.cell) {
    const int first = row.start[0][row.cell], behind = row.start[0][row.cell + 1];
    if (first == behind) continue;
    const int before = row.cell > 0 ? row.cell - 1 : 0, after = row.cell + 2 < row.cells ? row.cell + 2 : row.cells;
    int begin[5], end[5], most = 0;
    for (int q = 0; q < row.rows; ++q) {
      begin[q] = row.start[q][before];
      end[q] = row.start[q][after];
      most += end[q] - begin[q];
    }
    row.needed = (behind - first) * most + lanes;
    if (found + row.needed > row.room) break;
    for (int s = first; s < behind; ++s) {
      Pack x[3];
      for (int d = 0; d < 3; ++d) x[d] = Pack(search.x[d][s]);
      const Pack cut_off(search.radius[s] + search.reach);
      int now = near_in_stretch<false>(search, x, cut_off, s + 1, end[0], found);
      for (int q = 1; q < row.rows; ++q) now = near_in_stretch<false>(search, x, cut_off, begin[q], end[q], now);
      for (; found < now; ++found) row.seeker[found] = s;
    }
  }
  search.count = found;
}

}  // namespace SILT_ISA
}  // namespace silt
