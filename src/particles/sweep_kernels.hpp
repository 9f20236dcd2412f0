// The loops of sweep.hpp, compiled once per instruction set by sweep_plain.cpp, sweep_avx2.cpp, sweep_avx512.cpp.
// Contacts run in blocks through short loops, kinematics -> laws, one after the other -> scatter, with
// buffers that stay in the first-level cache: each loop fits the processor's reorder buffer, and each law is chosen
// once a block.
#pragma once
#include "particles/integration_kernels.hpp"
#include "particles/law_stages.hpp"
#include "particles/pack.hpp"
#include "particles/search_kernels.hpp"
#include "particles/sweep.hpp"

namespace silt {
namespace SILT_ISA {

/// Positions and radii of the partners, and from j to i across the nearest periodic sides.
template <bool periodic>
SILT_INLINE void load_pairs(const double* motion, const Periods& periods, const int* i, const int* j, Pack* xi,
                            Pack* xj, Pack* distance) {
  constexpr int stride = sizeof(Motion) / sizeof(double);
  load_columns(motion, stride, 0, i, xi);
  load_columns(motion, stride, 0, j, xj);
  for (int d = 0; d < 3; ++d) distance[d] = xi[d] - xj[d];
  if constexpr (periodic) nearest_image(periods, distance);
}

/// What the motions of `count` pairs give without a root or a division: the distance (in block.normal), the relative
/// velocity (block.slip), both radii (block.arm_i, arm_j) and the sum of the inverse masses (block.effective_mass). The
/// long latencies have a loop of their own, which the processor can overlap over many contacts.
template <bool periodic, bool extended>
SILT_INLINE void gather_pairs(const PairSweep& sweep, Block& block, int first, int count) {
  const double* motion = reinterpret_cast<const double*>(sweep.motion);
  constexpr int stride = sizeof(Motion) / sizeof(double);
  for (int o = 0; o < count; o += lanes) {
    const int k = first + o;
    const int *i = sweep.pairs.i + k, *j = sweep.pairs.j + k;
    if (k + block_size + lanes <= sweep.pairs.count)
      for (int q = 0; q < lanes; ++q) {
        __builtin_prefetch(&sweep.motion[j[block_size + q]]);
        if (sweep.scattered) {
          __builtin_prefetch(&sweep.motion[i[block_size + q]]);
          __builtin_prefetch(&sweep.rotation[i[block_size + q]]);
          __builtin_prefetch(&sweep.load[i[block_size + q]], 1);
        }
      }
    Pack xi[4], xj[4], vi[4], vj[4], distance[3];
    load_pairs<periodic>(motion, sweep.periods, i, j, xi, xj, distance);
    load_columns(motion, stride, 4, i, vi);
    load_columns(motion, stride, 4, j, vj);
    for (int d = 0; d < 3; ++d) {
      store(&block.normal[d][o], distance[d]);
      store(&block.slip[d][o], vi[d] - vj[d]);
    }
    store(&block.arm_i[o], xi[3]);
    store(&block.arm_j[o], xj[3]);
    store(&block.effective_mass[o], vi[3] + vj[3]);
    if constexpr (extended) {
      const Pack si = xi[3] * xi[3], sj = xj[3] * xj[3];
      store(&block.rolling_inertia[o], Pack(1.4) * si * sj / (vi[3] * sj + vj[3] * si));
    }
  }
}

/// Normals, overlaps and effective sizes of the gathered pairs.
template <bool extended>
SILT_INLINE void measure_pairs(PairSweep& sweep, Block& block, int first, int count) {
  const Pack half(0.5), one(1.0);
  const Pack leave(-sweep.laws.leave_gap), deepest(sweep.deepest_share);
  for (int o = 0; o < count; o += lanes) {
    Pack distance[3];
    for (int d = 0; d < 3; ++d) distance[d] = load(&block.normal[d][o]);
    const Pack radius_i = load(&block.arm_i[o]), radius_j = load(&block.arm_j[o]);
    const Pack r = sqrt(dot(distance, distance));
    // Asked for here, where the processor waits for the divider anyway.
    if (first + o + block_size + lanes <= sweep.pairs.count)
      for (int q = 0; q < lanes; ++q) {
        const int ahead = sweep.pairs.j[first + o + block_size + q];
        __builtin_prefetch(&sweep.rotation[ahead]);
        __builtin_prefetch(&sweep.load[ahead], 1);
      }
    // One division serves 1/r, R_eff and m_eff.
    const Pack radii = radius_i + radius_j, inverse_masses = load(&block.effective_mass[o]);
    const Pack inverse = one / (r * radii * inverse_masses);
    const Pack inverse_r = inverse * radii * inverse_masses;
    for (int d = 0; d < 3; ++d) store(&block.normal[d][o], distance[d] * inverse_r);
    const Pack overlap = radii - r, give = half * overlap;
    store(&block.effective_radius[o], radius_i * radius_j * (inverse * r * inverse_masses));
    store(&block.effective_mass[o], inverse * r * radii);
    store(&block.overlap[o], overlap);
    store(&block.arm_i[o], radius_i - give);
    store(&block.arm_j[o], radius_j - give);
    if constexpr (extended) {
      store(&block.radius[o], radius_i);
      store(&block.distance[o], r);
    }
    const unsigned apart = lane_bits(overlap <= leave);
    const unsigned deep = lane_bits(overlap > deepest * smaller(radius_i, radius_j));
    if (apart | deep) {
      const int k = first + o;
      for (int q = 0; q < lanes && k + q < sweep.pairs.count; ++q) {
        if (apart >> q & 1)
          sweep.leaving[(k + q) / 8] |= static_cast<unsigned char>(1 << (k + q) % 8), ++sweep.leaving_count;
        if (deep >> q & 1) sweep.too_deep = k + q;
      }
    }
  }
}

/// Approach and slip at the contact points, from the relative velocity and the spins.
template <bool extended, bool several>
SILT_INLINE void slip_of_pairs(const PairSweep& sweep, Block& block, int first, int count) {
  const double* rotation = reinterpret_cast<const double*>(sweep.rotation);
  constexpr int stride = sizeof(Rotation) / sizeof(double);
  const Pack materials(sweep.laws.materials);
  const bool at_radius = sweep.laws.slip_at_radius;
  for (int o = 0; o < count; o += lanes) {
    const int *i = sweep.pairs.i + first + o, *j = sweep.pairs.j + first + o;
    Pack wi[4], wj[4], velocity[3], rolling[3];
    load_columns(rotation, stride, 0, i, wi);
    load_columns(rotation, stride, 0, j, wj);
    Pack arm_i = load(&block.arm_i[o]), arm_j = load(&block.arm_j[o]);
    if (at_radius) {
      const Pack give = Pack(0.5) * load(&block.overlap[o]);
      arm_i = arm_i + give;
      arm_j = arm_j + give;
    }
    Contact<Pack> contact;
    for (int d = 0; d < 3; ++d) {
      contact.normal[d] = load(&block.normal[d][o]);
      velocity[d] = load(&block.slip[d][o]);
      rolling[d] = arm_i * wi[d] + arm_j * wj[d];
    }
    set_relative_motion(contact, velocity, rolling);
    for (int d = 0; d < 3; ++d) {
      store(&block.slip[d][o], contact.slip[d]);
      if constexpr (extended) store(&block.spin[d][o], wi[d] - wj[d]);
    }
    store(&block.approach[o], contact.approach);
    if constexpr (several) store(&block.pair[o], wi[3] * materials + wj[3]);
  }
}

/// Kinematics of `count` pairs, once for particles, ghosts and periodic images.
template <bool periodic, bool extended, bool several>
SILT_INLINE void pair_kinematics(PairSweep& sweep, Block& block, int first, int count) {
  gather_pairs<periodic, extended>(sweep, block, first, count);
  measure_pairs<extended>(sweep, block, first, count);
  slip_of_pairs<extended, several>(sweep, block, first, count);
}

#if SILT_LANES == 8
/// Adds the contacts' forces to both partners, force and torque in one record; one contact after the other, as a
/// particle may occur more than once.
template <bool extended>
SILT_INLINE void pair_scatter(const PairSweep& sweep, const Block& block, int first, int count) {
  for (int o = 0; o < count; o += 8) {
    Vector column[6], row[8];
    const Pack nx = load(&block.normal[0][o]), ny = load(&block.normal[1][o]), nz = load(&block.normal[2][o]);
    const Pack fx = load(&block.force[0][o]), fy = load(&block.force[1][o]), fz = load(&block.force[2][o]);
    column[0] = fx.v, column[1] = fy.v, column[2] = fz.v;
    // Torque of the force at the contact point, -arm n from the centre of i: arm F x n.
    column[3] = (fy * nz - fz * ny).v, column[4] = (fz * nx - fx * nz).v, column[5] = (fx * ny - fy * nx).v;
    records_of(column, row);
    for (int q = 0; q < 8; ++q) {
      Vector& on_i = *reinterpret_cast<Vector*>(&sweep.load[sweep.pairs.i[first + o + q]]);
      Vector& on_j = *reinterpret_cast<Vector*>(&sweep.load[sweep.pairs.j[first + o + q]]);
      on_i += row[q] * force_and_arm(1, &block.arm_i[o + q]);
      on_j += row[q] * force_and_arm(-1, &block.arm_j[o + q]);
    }
    if constexpr (extended) {
      column[0] = column[1] = column[2] = Vector{};
      for (int d = 0; d < 3; ++d) column[3 + d] = load(&block.torque[d][o]).v;
      records_of(column, row);
      for (int q = 0; q < 8; ++q) {
        *reinterpret_cast<Vector*>(&sweep.load[sweep.pairs.i[first + o + q]]) += row[q];
        *reinterpret_cast<Vector*>(&sweep.load[sweep.pairs.j[first + o + q]]) -= row[q];
      }
    }
  }
}
#else
/// Adds the contacts' forces to both partners; one contact after the other, as a particle may occur more than once.
template <bool extended>
SILT_INLINE void pair_scatter(const PairSweep& sweep, const Block& block, int first, int count) {
  for (int o = 0; o < count; o += 4) {
    Quad force[3], couple[3], row_f[4], row_i[4], row_j[4];
    for (int d = 0; d < 3; ++d) force[d] = quad(&block.force[d][o]);
    const Quad nx = quad(&block.normal[0][o]), ny = quad(&block.normal[1][o]), nz = quad(&block.normal[2][o]);
    // Torque of the force at the contact point, -arm n from the centre of i: arm F x n.
    couple[0] = force[1] * nz - force[2] * ny;
    couple[1] = force[2] * nx - force[0] * nz;
    couple[2] = force[0] * ny - force[1] * nx;
    const Quad arm_i = quad(&block.arm_i[o]), arm_j = quad(&block.arm_j[o]);
    rows_of(force[0], force[1], force[2], row_f);
    if constexpr (extended) {
      const Quad mx = quad(&block.torque[0][o]), my = quad(&block.torque[1][o]), mz = quad(&block.torque[2][o]);
      rows_of(arm_i * couple[0] + mx, arm_i * couple[1] + my, arm_i * couple[2] + mz, row_i);
      rows_of(arm_j * couple[0] - mx, arm_j * couple[1] - my, arm_j * couple[2] - mz, row_j);
    } else {
      rows_of(arm_i * couple[0], arm_i * couple[1], arm_i * couple[2], row_i);
      rows_of(arm_j * couple[0], arm_j * couple[1], arm_j * couple[2], row_j);
    }
    for (int q = 0; q < 4; ++q) {
      Load& on_i = sweep.load[sweep.pairs.i[first + o + q]];
      Load& on_j = sweep.load[sweep.pairs.j[first + o + q]];
      *reinterpret_cast<Quad*>(on_i.force) += row_f[q];
      *reinterpret_cast<Quad*>(on_i.torque) += row_i[q];
      *reinterpret_cast<Quad*>(on_j.force) -= row_f[q];
      *reinterpret_cast<Quad*>(on_j.torque) += row_j[q];
    }
  }
}
#endif

/// Leaves behind what the contacts of the block exert.
template <bool extended>
void keep_trace(const Block& block, double* trace, std::size_t stride, int count) {
  for (int o = 0; o < count; ++o) {
    trace[o] = block.noted[o];
    for (int d = 0; d < 3; ++d) {
      trace[(1 + d) * stride + o] = block.force[d][o];
      trace[(4 + d) * stride + o] = extended ? block.torque[d][o] : 0;
    }
  }
}

template <bool periodic, bool extended, bool several>
void pair_blocks(PairSweep& sweep) {
  Block block;
  block.dt = sweep.dt;
  const Laws laws(sweep.laws);
  const PairArrays& pairs = sweep.pairs;
  for (int first = sweep.first; first < pairs.count; first += block_size) {
    const int left = (pairs.count - first + 7) / 8 * 8;  // the lists are padded to 8
    const int count = left < block_size ? left : block_size;
    pair_kinematics<periodic, extended, several>(sweep, block, first, count);
    laws.run(block, pairs.history + first, pairs.stride, count, sweep.dt);
    pair_scatter<extended>(sweep, block, first, count);
    if (sweep.trace) keep_trace<extended>(block, sweep.trace + first, pairs.stride, count);
  }
}

template <bool periodic, bool extended>
SILT_INLINE void choose_several(PairSweep& sweep) {
  sweep.laws.materials > 1 ? pair_blocks<periodic, extended, true>(sweep)
                           : pair_blocks<periodic, extended, false>(sweep);
}
template <bool periodic>
SILT_INLINE void choose_extended(PairSweep& sweep) {
  sweep.laws.extended ? choose_several<periodic, true>(sweep) : choose_several<periodic, false>(sweep);
}
void pair_sweep(PairSweep& sweep) {
  sweep.leaving_count = 0;
  sweep.too_deep = -1;
  sweep.periods.any ? choose_extended<true>(sweep) : choose_extended<false>(sweep);
}

template <bool periodic>
SILT_INLINE void candidates(CandidateSweep& sweep) {
  const double* motion = reinterpret_cast<const double*>(sweep.motion);
  const Pack enter(sweep.enter_gap);
  constexpr int ahead = 32;
  for (int k = 0; k < sweep.count; k += lanes) {
    const int *i = sweep.i + k, *j = sweep.j + k;
    if (k + ahead + lanes <= sweep.count)
      for (int q = 0; q < lanes; ++q) __builtin_prefetch(&sweep.motion[j[ahead + q]]);
    Pack xi[4], xj[4], distance[3];
    load_pairs<periodic>(motion, sweep.periods, i, j, xi, xj, distance);
    store(&sweep.gap[k], sqrt(dot(distance, distance)) - (xi[3] + xj[3] + enter));
  }
}
void candidate_sweep(CandidateSweep& sweep) { sweep.periods.any ? candidates<true>(sweep) : candidates<false>(sweep); }

template <bool periodic>
SILT_INLINE void count_pairs(ContactCensus& census) {
  const double* motion = reinterpret_cast<const double*>(census.motion);
  constexpr int ahead = 32;
  const Pack none(0.0);
  Pack touching(0.0), largest(0.0), fabric[3] = {none, none, none};
  alignas(64) double mine[lanes];
  for (int k = 0; k < census.count; k += lanes) {
    const int *i = census.i + k, *j = census.j + k;
    if (k + ahead + lanes <= census.count)
      for (int q = 0; q < lanes; ++q) {
        __builtin_prefetch(&census.motion[i[ahead + q]]);
        __builtin_prefetch(&census.motion[j[ahead + q]]);
      }
    for (int q = 0; q < lanes; ++q) mine[q] = k + q < census.count && i[q] < census.owned;
    Pack xi[4], xj[4], distance[3];
    load_pairs<periodic>(motion, census.periods, i, j, xi, xj, distance);
    const Pack square = dot(distance, distance), overlap = xi[3] + xj[3] - sqrt(square);
    const Pack counted = select(overlap > none, load(mine), none);  // pairs that act over a gap do not touch
    touching = touching + counted;
    largest = larger(largest, counted * overlap / smaller(xi[3], xj[3]));
    for (int d = 0; d < 3; ++d) fabric[d] = fabric[d] + counted * distance[d] * distance[d] / square;
  }
  alignas(64) double lane[5][lanes];
  store(lane[0], touching);
  store(lane[1], largest);
  for (int d = 0; d < 3; ++d) store(lane[2 + d], fabric[d]);
  census.touching = census.largest = census.fabric[0] = census.fabric[1] = census.fabric[2] = 0;
  for (int q = 0; q < lanes; ++q) {
    census.touching += lane[0][q];
    if (lane[1][q] > census.largest) census.largest = lane[1][q];
    for (int d = 0; d < 3; ++d) census.fabric[d] += lane[2 + d][q];
  }
}
void contact_census(ContactCensus& census) {
  census.periods.any ? count_pairs<true>(census) : count_pairs<false>(census);
}

/// Contacts with walls: the same laws, filled one by one.
void wall_sweep(WallSweep& sweep) {
  Block block;
  block.dt = sweep.dt;
  const Laws laws(sweep.laws);
  for (int first = 0; first < sweep.count; first += block_size) {
    const int left = sweep.count - first;
    const int count = left < block_size ? left : block_size;
    const int padded = (count + 7) / 8 * 8;
    for (int o = 0; o < padded; ++o) {
      const WallPoint& point = sweep.points[first + (o < count ? o : count - 1)];
      const Motion& particle = sweep.motion[point.particle];
      const Rotation& rotation = sweep.rotation[point.particle];
      double velocity[3], rolling[3];
      Contact<double> contact;
      for (int d = 0; d < 3; ++d) {
        contact.normal[d] = point.normal[d];
        velocity[d] = particle.velocity[d] - point.velocity[d];
        rolling[d] = (sweep.laws.slip_at_radius ? particle.radius : point.distance) * rotation.spin[d];
      }
      set_relative_motion(contact, velocity, rolling);
      for (int d = 0; d < 3; ++d) {
        block.normal[d][o] = contact.normal[d];
        block.slip[d][o] = contact.slip[d];
        block.spin[d][o] = rotation.spin[d];
      }
      block.overlap[o] = particle.radius - point.distance;
      block.approach[o] = contact.approach;
      block.effective_radius[o] = particle.radius;
      block.effective_mass[o] = 1 / particle.inverse_mass;
      block.radius[o] = particle.radius;
      block.distance[o] = point.distance;
      block.rolling_inertia[o] = 1.4 * particle.radius * particle.radius / particle.inverse_mass;
      block.arm_i[o] = point.distance;
      block.pair[o] = rotation.material * sweep.laws.materials + point.material;
      for (int d = 0; d < 3; ++d) block.torque[d][o] = 0;
    }
    laws.run(block, sweep.history + first, sweep.stride, padded, sweep.dt);
    if (sweep.trace) keep_trace<true>(block, sweep.trace + first, sweep.stride, count);
    for (int o = 0; o < count; ++o) {
      const WallPoint& point = sweep.points[first + o];
      const double* x = sweep.motion[point.particle].position;
      Load& load = sweep.load[point.particle];
      const double force[3] = {block.force[0][o], block.force[1][o], block.force[2][o]};
      double at[3];
      for (int d = 0; d < 3; ++d) at[d] = x[d] - point.shift[d] - block.arm_i[o] * block.normal[d][o];
      for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3, f = (d + 2) % 3;
        const double couple = force[e] * block.normal[f][o] - force[f] * block.normal[e][o];
        load.force[d] += force[d];
        load.torque[d] += block.arm_i[o] * couple + block.torque[d][o];
        sweep.wall_force[point.boundary][d] += force[d];
        sweep.wall_torque[point.boundary][d] += at[e] * force[f] - at[f] * force[e] + block.torque[d][o];
      }
    }
  }
}

}  // namespace SILT_ISA
}  // namespace silt
