// The loops over all pairs, compiled once per instruction set; include only from pair_kernels_*.cpp.
#pragma once
#include <limits>

#include "particles/pack.hpp"
#include "particles/pair_sums.hpp"

namespace silt {
namespace SILT_ISA {

/// 1/sqrt(a). Where the processor has an estimate, two steps of Newton's method bring it to round-off.
SILT_INLINE Pack inverse_root(Pack a) {
#if SILT_LANES == 8
  Pack r = Vector(_mm512_rsqrt14_pd(__m512d(a.v)));
  const Pack half = 0.5 * a;
  r = r * (1.5 - half * r * r);
  return r * (1.5 - half * r * r);
#else
  return 1.0 / sqrt(a);
#endif
}
SILT_INLINE double sum_of(Pack a) {
  double sum = 0;
  for (int k = 0; k < lanes; ++k) sum += a.v[k];
  return sum;
}
SILT_INLINE Pack numbers(int first) {
  Pack a;
  for (int k = 0; k < lanes; ++k) a.v[k] = first + k;
  return a;
}
SILT_INLINE void add_to(double* p, Pack a) { store_unaligned(p, load_unaligned(p) + a); }

/// Adds up the action of the sources at the places [begin, end) on the one at i. `mutual`: the opposite force is given
/// to them, for pairs that are taken once.
template <bool dipole, bool force, bool field, bool periodic, bool mutual>
SILT_INLINE void act_on(const PairLoop& loop, int i, int begin, int end, double square) {
  const PairSources& s = *loop.sources;
  const Pack x = s.x[i], y = s.y[i], z = s.z[i];
  const Pack mx = s.a[i], my = s.b[i], mz = s.c[i];
  Pack fx = 0.0, fy = 0.0, fz = 0.0, hx = 0.0, hy = 0.0, hz = 0.0;
  for (int j = begin; j < end; j += lanes) {
    Pack dx = x - load_unaligned(&s.x[j]), dy = y - load_unaligned(&s.y[j]), dz = z - load_unaligned(&s.z[j]);
    if constexpr (periodic) {
      dx = dx - Pack(loop.periods.length[0]) * nearest(dx * Pack(loop.periods.inverse[0]));
      dy = dy - Pack(loop.periods.length[1]) * nearest(dy * Pack(loop.periods.inverse[1]));
      dz = dz - Pack(loop.periods.length[2]) * nearest(dz * Pack(loop.periods.inverse[2]));
    }
    const Pack r2 = dx * dx + dy * dy + dz * dz;
    // Not itself, not beyond the cut-off, not beyond the end.
    Mask valid = (r2 > Pack(0.0)) & (r2 < Pack(square));
    if (j + lanes > end) valid = valid & (numbers(j) < Pack(static_cast<double>(end)));
    const Pack inverse = select(valid, inverse_root(r2), Pack(0.0)), inverse2 = inverse * inverse,
               inverse3 = inverse2 * inverse;
    if constexpr (dipole) {
      const Pack nx = load_unaligned(&s.a[j]), ny = load_unaligned(&s.b[j]), nz = load_unaligned(&s.c[j]);
      const Pack inverse5 = inverse3 * inverse2;
      const Pack b = nx * dx + ny * dy + nz * dz, q = inverse5 * b;
      if constexpr (force) {
        const Pack a = mx * dx + my * dy + mz * dz, m = mx * nx + my * ny + mz * nz, p = inverse5 * a;
        const Pack g = inverse5 * m - 5.0 * p * b * inverse2;
        const Pack gx = g * dx + q * mx + p * nx, gy = g * dy + q * my + p * ny, gz = g * dz + q * mz + p * nz;
        fx = fx + gx;
        fy = fy + gy;
        fz = fz + gz;
        if constexpr (mutual) {
          add_to(&loop.force->x[j], -gx);
          add_to(&loop.force->y[j], -gy);
          add_to(&loop.force->z[j], -gz);
        }
      }
      if constexpr (field) {
        const Pack h = 3.0 * q;
        hx = hx + (h * dx - inverse3 * nx);
        hy = hy + (h * dy - inverse3 * ny);
        hz = hz + (h * dz - inverse3 * nz);
      }
    } else {
      const Pack h = inverse3 * load_unaligned(&s.a[j]);
      hx = hx + h * dx;
      hy = hy + h * dy;
      hz = hz + h * dz;
    }
  }
  if constexpr (force) {
    loop.force->x[i] += sum_of(fx);
    loop.force->y[i] += sum_of(fy);
    loop.force->z[i] += sum_of(fz);
  }
  if constexpr (field) {
    loop.field->x[i] += sum_of(hx);
    loop.field->y[i] += sum_of(hy);
    loop.field->z[i] += sum_of(hz);
  }
}

template <bool dipole, bool force, bool field, bool periodic>
void all_pairs(const PairLoop& loop) {
  const PairSources& s = *loop.sources;
  const int owned = static_cast<int>(s.place.size());
  const bool cut = loop.cutoff > 0;
  const double square = cut ? loop.cutoff * loop.cutoff : std::numeric_limits<double>::max();
  if constexpr (dipole && force && !field)
    if (!cut && owned == s.count) {  // alone: every pair once
      for (int i = 0; i < owned; ++i) act_on<dipole, force, field, periodic, true>(loop, i, i + 1, s.count, square);
      return;
    }
  for (int p = 0; p < owned; ++p) {
    if (!cut) {
      act_on<dipole, force, field, periodic, false>(loop, s.place[p], 0, s.count, square);
      continue;
    }
    for (int k = s.run_start[p]; k < s.run_start[p + 1]; ++k)
      act_on<dipole, force, field, periodic, false>(loop, s.place[p], s.run[2 * k], s.run[2 * k + 1], square);
  }
}

template <bool dipole, bool force, bool field>
void choose_images(const PairLoop& loop) {
  loop.periods.any ? all_pairs<dipole, force, field, true>(loop) : all_pairs<dipole, force, field, false>(loop);
}

void dipoles(const PairLoop& loop) {
  if (loop.force && loop.field)
    choose_images<true, true, true>(loop);
  else if (loop.force)
    choose_images<true, true, false>(loop);
  else
    choose_images<true, false, true>(loop);
}

void charges(const PairLoop& loop) { choose_images<false, false, true>(loop); }

}  // namespace SILT_ISA
}  // namespace silt
