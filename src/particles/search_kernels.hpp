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

/// Writes the number and the gap of every lane that is set, one behind the other; returns how many.
SILT_INLINE int keep_lanes(unsigned set, int first, Pack gap, int* number, double* gaps) {
#if SILT_LANES == 8
  const __m256i numbers = _mm256_add_epi32(_mm256_set1_epi32(first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(number), _mm256_maskz_compress_epi32(__mmask8(set), numbers));
  _mm512_storeu_pd(gaps, _mm512_maskz_compress_pd(__mmask8(set), __m512d(gap.v)));
  return __builtin_popcount(set);
#else
  int kept = 0;
  for (int k = 0; k < lanes; ++k) {
    number[kept] = first + k;
    gaps[kept] = gap.v[k];
    kept += set >> k & 1;
  }
  return kept;
#endif
}

template <bool across>
SILT_INLINE void near_spheres(NearSearch& search) {
  const Pack radius(search.sphere[3]), reach(search.reach);
  int found = 0;
  for (int q = 0; q < search.stretches; ++q) {
    const int begin = search.stretch[q].begin > search.after ? search.stretch[q].begin : search.after + 1;
    const int end = search.stretch[q].end;
    for (int k = begin; k < end; k += lanes) {
      Pack distance[3];
      for (int d = 0; d < 3; ++d) distance[d] = Pack(search.sphere[d]) - load_unaligned(search.x[d] + k);
      if constexpr (across) nearest_image(*search.periods, distance);
      const Pack square = dot(distance, distance), radii = radius + load_unaligned(search.radius + k);
      const Pack cut = radii + reach;
      unsigned near = lane_bits(square < cut * cut);
      if (end - k < lanes) near &= (1u << (end - k)) - 1;
      found += keep_lanes(near, k, sqrt(square) - radii, search.found + found, search.gap + found);
    }
  }
  search.count = found;
}
void near_sphere(NearSearch& search) { search.across ? near_spheres<true>(search) : near_spheres<false>(search); }

}  // namespace SILT_ISA
}  // namespace silt
