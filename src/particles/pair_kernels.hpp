// The loops over all pairs, compiled once per instruction set; include only from pair_kernels_*.cpp.
#pragma once
#include "particles/pack.hpp"
#include "particles/pair_sums.hpp"

namespace silt {
namespace SILT_ISA {

/// Nearer than this (m2) two sources have no direction between them, and nothing acts; estimates in single precision
/// hold its inverse.
inline constexpr double least_square = 1e-36;

// Which lanes of a block count.
#if SILT_LANES == 8
using Lanes = __mmask8;
SILT_INLINE Lanes apart(Pack square) {
  return _mm512_cmp_pd_mask(__m512d(square.v), _mm512_set1_pd(least_square), _CMP_GT_OQ);
}
SILT_INLINE Lanes below(Pack square, double limit) {
  return _mm512_cmp_pd_mask(__m512d(square.v), _mm512_set1_pd(limit), _CMP_LT_OQ);
}
/// The lanes whose places, from `first` on, are in [begin, end).
SILT_INLINE Lanes places(int first, int begin, int end) {
  const unsigned from = begin > first ? 0xffu << (begin - first) : 0xffu;
  return Lanes(first + lanes > end ? from & (0xffu >> (first + lanes - end)) : from);
}
SILT_INLINE Lanes both(Lanes a, Lanes b) { return a & b; }
#else
using Lanes = Mask;
SILT_INLINE Lanes apart(Pack square) { return square > Pack(least_square); }
SILT_INLINE Lanes below(Pack square, double limit) { return square < Pack(limit); }
SILT_INLINE Lanes places(int first, int begin, int end) {
  Bits bits;
  for (int k = 0; k < lanes; ++k) bits[k] = first + k >= begin && first + k < end ? -1 : 0;
  return {bits};
}
SILT_INLINE Lanes both(Lanes a, Lanes b) { return a & b; }
#endif

/// 1/r and 1/r^2 in the lanes that count, 0 in the others.
struct Inverse {
  Pack one, two;
};
SILT_INLINE Inverse inverse_of(Pack square, Lanes counts) {
#if SILT_LANES == 8
  // The error e = 1 - a y^2 of the processor's estimate y is taken out by the series of (1 - e)^(-1/2), to round-off.
  const Pack y = Vector(_mm512_maskz_rsqrt14_pd(counts, __m512d(square.v)));
  const Pack e = 1.0 - square * y * y;
  const Pack one = y + y * e * (0.5 + e * (0.375 + e * 0.3125));
  return {one, one * one};
#else
  // Quotient and root of up to four lanes are done beside the products and sums, which are the longer work; those that
  // would mend an estimate of single precision come on top of them.
  const Pack two = select(counts, 1.0 / square, Pack(0.0));
  return {sqrt(two), two};
#endif
}
SILT_INLINE double sum_of(Pack a) {
  double sum = 0;
  for (int k = 0; k < lanes; ++k) sum += a.v[k];
  return sum;
}
SILT_INLINE void add_to(double* p, Pack a) { store_unaligned(p, load_unaligned(p) + a); }
SILT_INLINE void take_from(double* p, Pack a, Pack b) { store_unaligned(p, load_unaligned(p) - a * b); }

/// What a loop takes along with the pairs.
enum class Which { once, all, near };  ///< both of a pair at once; one of it; one of it, up to the cut-off

/// Adds up the action of the sources at the places [begin, end) on the one at i and, for pairs that are taken once,
/// what it does to them. Places beyond the last source have no moment and no charge.
template <bool dipole, bool force, bool field, bool periodic, Which which>
SILT_INLINE void act_on(const PairLoop& loop, int i, int begin, int end) {
  constexpr bool mutual = which == Which::once;
  const PairSources& s = *loop.sources;
  const double *const X = s.x.data(), *const Y = s.y.data(), *const Z = s.z.data();
  const double *const A = s.a.data(), *const B = s.b.data(), *const C = s.c.data();
  double *const FX = force ? loop.force->x.data() : nullptr, *const FY = force ? loop.force->y.data() : nullptr,
                *const FZ = force ? loop.force->z.data() : nullptr;
  double *const HX = field ? loop.field->x.data() : nullptr, *const HY = field ? loop.field->y.data() : nullptr,
                *const HZ = field ? loop.field->z.data() : nullptr;
  const double square = loop.cutoff * loop.cutoff;
  const Pack x = X[i], y = Y[i], z = Z[i], mx = A[i], my = dipole ? B[i] : 0, mz = dipole ? C[i] : 0;
  Pack fx = 0.0, fy = 0.0, fz = 0.0, hx = 0.0, hy = 0.0, hz = 0.0;
  // Sums that are added to are met at the same places every time: whole cache lines.
  for (int j = mutual ? begin / lanes * lanes : begin; j < end; j += lanes) {
    Pack dx = x - load_unaligned(X + j), dy = y - load_unaligned(Y + j), dz = z - load_unaligned(Z + j);
    if constexpr (periodic) {
      dx = dx - Pack(loop.periods.length[0]) * nearest(dx * Pack(loop.periods.inverse[0]));
      dy = dy - Pack(loop.periods.length[1]) * nearest(dy * Pack(loop.periods.inverse[1]));
      dz = dz - Pack(loop.periods.length[2]) * nearest(dz * Pack(loop.periods.inverse[2]));
    }
    const Pack r2 = dx * dx + dy * dy + dz * dz;
    Lanes counts = apart(r2);
    if constexpr (which == Which::near) counts = both(counts, below(r2, square));
    if (j < begin || j + lanes > end) counts = both(counts, places(j, begin, end));
    const auto [inverse, inverse2] = inverse_of(r2, counts);
    const Pack inverse3 = inverse2 * inverse;
    if constexpr (dipole) {
      const Pack nx = load_unaligned(A + j), ny = load_unaligned(B + j), nz = load_unaligned(C + j);
      const Pack inverse5 = inverse3 * inverse2;
      const Pack b = nx * dx + ny * dy + nz * dz;
      Pack c;
      if constexpr (force || mutual) c = mx * dx + my * dy + mz * dz;
      if constexpr (force) {
        // All over 1/r^5, which comes in with the sums.
        const Pack g = mx * nx + my * ny + mz * nz - 5.0 * inverse2 * b * c;
        const Pack gx = g * dx + b * mx + c * nx, gy = g * dy + b * my + c * ny, gz = g * dz + b * mz + c * nz;
        fx = fx + inverse5 * gx;
        fy = fy + inverse5 * gy;
        fz = fz + inverse5 * gz;
        if constexpr (mutual) {
          take_from(FX + j, inverse5, gx);
          take_from(FY + j, inverse5, gy);
          take_from(FZ + j, inverse5, gz);
        }
      }
      if constexpr (field) {
        const Pack third = (1.0 / 3.0) * inverse3, q = inverse5 * b;
        hx = hx + q * dx - third * nx;
        hy = hy + q * dy - third * ny;
        hz = hz + q * dz - third * nz;
        if constexpr (mutual) {
          const Pack p = inverse5 * c;
          store_unaligned(HX + j, load_unaligned(HX + j) + p * dx - third * mx);
          store_unaligned(HY + j, load_unaligned(HY + j) + p * dy - third * my);
          store_unaligned(HZ + j, load_unaligned(HZ + j) + p * dz - third * mz);
        }
      }
    } else {
      const Pack h = inverse3 * load_unaligned(A + j);
      hx = hx + h * dx;
      hy = hy + h * dy;
      hz = hz + h * dz;
      if constexpr (mutual) {
        const Pack back = -inverse3 * mx;
        add_to(HX + j, back * dx);
        add_to(HY + j, back * dy);
        add_to(HZ + j, back * dz);
      }
    }
  }
  if constexpr (force) {
    FX[i] += sum_of(fx);
    FY[i] += sum_of(fy);
    FZ[i] += sum_of(fz);
  }
  if constexpr (field) {
    HX[i] += sum_of(hx);
    HY[i] += sum_of(hy);
    HZ[i] += sum_of(hz);
  }
}

template <bool dipole, bool force, bool field, bool periodic>
void all_pairs(const PairLoop& loop) {
  const PairSources& s = *loop.sources;
  const int owned = static_cast<int>(s.place.size());
  if (loop.cutoff > 0) {
    for (int p = 0; p < owned; ++p)
      for (int k = s.run_start[p]; k < s.run_start[p + 1]; ++k)
        act_on<dipole, force, field, periodic, Which::near>(loop, s.place[p], s.run[2 * k], s.run[2 * k + 1]);
    return;
  }
  if (owned == 0) return;
  // Those of this rank stand together: with each other every pair once, with the others their own half.
  const int first = s.place[0], last = first + owned;
  for (int i = first; i < last; ++i) {
    act_on<dipole, force, field, periodic, Which::once>(loop, i, i + 1, last);
    if (first > 0) act_on<dipole, force, field, periodic, Which::all>(loop, i, 0, first);
    if (last < s.count) act_on<dipole, force, field, periodic, Which::all>(loop, i, last, s.count);
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
