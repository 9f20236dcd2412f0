// The pass over all particles that moves them; part of sweep_kernels.hpp, compiled once per instruction set.
#pragma once
#include <cstdint>

#include "particles/orientation.hpp"
#include "particles/pack.hpp"
#include "particles/sweep.hpp"

namespace silt {
namespace SILT_ISA {

SILT_INLINE Quad quad(const double* p) { return *reinterpret_cast<const Quad*>(p); }
SILT_INLINE Quad every(double a) { return Quad{a, a, a, a}; }
SILT_INLINE double scalar_product(const Quad& a, const Quad& b) {
  const Quad c = a * b;
  return c[0] + c[1] + c[2];
}

/// Bit k is set where particle first + k may bear a load, now or in the step before.
SILT_INLINE std::uint64_t loaded_in_block(const Integration& step, int first, int count) {
#if SILT_LANES == 8
  if (count == 64) {
    const __m512i both =
        _mm512_or_si512(_mm512_loadu_si512(step.loaded + first), _mm512_loadu_si512(step.loaded_before + first));
    return _mm512_test_epi8_mask(both, both);
  }
#endif
  std::uint64_t bits = 0;
  for (int k = 0; k < count; ++k) bits |= std::uint64_t(step.loaded[first + k] | step.loaded_before[first + k]) << k;
  return bits;
}

/// How long each of four particles moves freely, by the bits of those that bear a load: they take part with a step of
/// no time, for a branch would be foreseen wrongly for every other one of them, which costs more than all four.
struct FreeSteps {
  double dt[16][4], second[16][4];
  SILT_INLINE explicit FreeSteps(const Integration& step) {
    for (int loaded = 0; loaded < 16; ++loaded)
      for (int k = 0; k < 4; ++k) {
        dt[loaded][k] = loaded >> k & 1 ? 0 : step.dt;
        second[loaded][k] = loaded >> k & 1 ? 0 : step.second;
      }
  }
};

/// The squared lengths of four vectors, whose fourth entries are 0.
SILT_INLINE Quad square_lengths(Quad a, Quad b, Quad c, Quad d) {
  a *= a, b *= b, c *= c, d *= d;
  const Quad ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Quad cd = __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

/// What a pass finds of the ways of the particles in this step.
struct Ways {
  Quad largest{}, sum{};
  SILT_INLINE void add(Quad squares) {
    largest = largest > squares ? largest : squares;
    sum += squares;
  }
};

/// The drift of those particles of a block that nothing but gravity acts on, with the bits of the general one; their
/// spins stay.
template <bool falls>
SILT_INLINE void move_freely(Integration& step, const FreeSteps& steps, int first, int count, std::uint64_t loaded,
                             Ways& ways) {
  const Quad move = quad(step.move), acceleration = quad(step.gravity) * move;
  const auto move_one = [&](Motion& motion, double dt, double second) {
    const Quad velocity = quad(motion.velocity), before = quad(motion.position);
    Quad position = before + (every(dt) * move) * velocity;
    if constexpr (falls) {
      position += every(second) * acceleration;
      *reinterpret_cast<Quad*>(motion.velocity) = velocity + every(dt) * acceleration;
    }
    *reinterpret_cast<Quad*>(motion.position) = position;
    return position - before;
  };
  for (int k = 0; k < count; k += 4) {
    Motion* motion = step.motion + first + k;
    const unsigned bits = loaded >> k & 15;
    const double *dt = steps.dt[bits], *second = steps.second[bits];
    Quad moved[4] = {};
    if (k + 4 <= count)
      for (int q = 0; q < 4; ++q) moved[q] = move_one(motion[q], dt[q], second[q]);
    else
      for (int q = 0; k + q < count; ++q) moved[q] = move_one(motion[q], dt[q], second[q]);
    ways.add(square_lengths(moved[0], moved[1], moved[2], moved[3]));
  }
  if (!step.orientation) return;
  for (int k = 0; k < count; ++k)
    if (!(loaded >> k & 1)) {
      const Quad spin = quad(step.rotation[first + k].spin);
      turn_by(step.orientation[first + k], step.dt * spin[0], step.dt * spin[1], step.dt * spin[2]);
    }
}

/// leapfrog: the drift gives half of the impulse of its forces' contacts, and the next corrector the other.
template <bool correct, bool drift, bool fluid, bool turning, bool sparse, bool leapfrog>
void integrate_all(Integration& step) {
  const double h = step.dt;
  const Quad move = quad(step.move), turn = quad(step.turn), gravity = quad(step.gravity);
  Ways ways;
  const auto integrate_one = [&](int p) {
    Motion& motion = step.motion[p];
    Quad velocity = quad(motion.velocity), spin = quad(step.rotation[p].spin);
    const double inverse_mass = motion.inverse_mass;
    const double inverse_inertia = 2.5 * inverse_mass / (motion.radius * motion.radius);
    const Quad force = quad(step.present[p].force), torque = quad(step.present[p].torque);
    double first = h, second = step.second, corrector = 0.5 * h, share = 1;
    double turn_first = h, turn_corrector = 0.5 * h, turn_second = step.second;
    Quad impulse{};
    if constexpr (fluid) {
      first = step.drag[p].first;
      second = step.drag[p].second;
      corrector = step.drag[p].corrector;
      share = step.drag[p].share;
      impulse = quad(step.drag[p].impulse);
    }
    if constexpr (turning) {
      turn_first = step.turning[p].first;
      turn_corrector = step.turning[p].corrector;
      turn_second = step.turning[p].second;
    }
    if constexpr (correct) {
      const Quad change = move * (force - quad(step.previous[p].force));
      const Quad turned = turn * (torque - quad(step.previous[p].torque));
      Quad kick = every(corrector) * change, own = every(0.5 * h) * change;
      Quad twist = every(turn_corrector) * turned, own_twist = every(0.5 * h) * turned;
      if constexpr (leapfrog) {  // the other half of what the forces before give
        const Quad before = move * quad(step.previous[p].force), torque_before = turn * quad(step.previous[p].torque);
        kick += every(0.5 * first) * before, own += every(0.5 * h) * before;
        twist += every(0.5 * turn_first) * torque_before, own_twist += every(0.5 * h) * torque_before;
      }
      const Quad faster = every(share * inverse_mass) * kick, spun = every(inverse_inertia) * twist;
      if constexpr (fluid) {
        const Quad taken = every(share) * kick - own;
        impulse += taken;
        // An impulse does the work of the mean of the velocities before and after all that act together.
        impulse[3] += scalar_product(taken, velocity + every(0.5) * faster);
      }
      if constexpr (turning) impulse[3] += scalar_product(twist - own_twist, spin + every(0.5) * spun);
      velocity += faster;
      spin += spun;
    }
    if constexpr (drift) {
      Quad contact = every(inverse_mass) * force;
      Quad acceleration = contact + gravity;
      if constexpr (fluid)
        acceleration = every(share) * (acceleration + quad(step.drag[p].acceleration)) +
                       every(step.drag[p].rate) * (quad(step.drag[p].velocity) - velocity);
      acceleration *= move;
      const Quad position = quad(motion.position) + (every(h) * move) * velocity + every(second) * acceleration;
      Quad gained = every(first) * acceleration;
      if constexpr (leapfrog) {
        contact *= every(0.5);
        gained -= every(first * share) * move * contact;
      }
      if constexpr (fluid) {
        const Quad mass = every(1 / inverse_mass), others = every(h) * move * (contact + gravity);
        impulse += mass * (gained - others - every(h) * move * quad(step.drag[p].acceleration));
        impulse[3] += scalar_product(mass * (gained - others), velocity + every(0.5) * gained);
      }
      velocity += gained;
      Quad couple = every(inverse_inertia) * torque;
      Quad turned = couple;
      if constexpr (turning) turned += every(step.turning[p].rate) * (quad(step.turning[p].spin) - spin);
      turned *= turn;
      if (step.orientation || step.turned) {
        // As the position: exact for a constant torque, whatever the hold of the fluid.
        const Quad angle = every(h) * spin + every(turn_second) * turned;
        if (step.orientation) turn_by(step.orientation[p], angle[0], angle[1], angle[2]);
        if (step.turned) *reinterpret_cast<Quad*>(step.turned[p]) = angle;
      }
      Quad turn_gained = every(turn_first) * turned;
      if constexpr (leapfrog) {
        couple *= every(0.5);
        turn_gained -= every(turn_first) * turn * couple;
      }
      if constexpr (turning)
        impulse[3] += scalar_product(every(1 / inverse_inertia) * (turn_gained - every(h) * turn * couple),
                                     spin + every(0.5) * turn_gained);
      spin += turn_gained;
      const Quad moved = position - quad(motion.position);
      *reinterpret_cast<Quad*>(motion.position) = position;
      ways.add(square_lengths(moved, Quad{}, Quad{}, Quad{}));
      *reinterpret_cast<Quad*>(step.previous[p].force) = Quad{};
      *reinterpret_cast<Quad*>(step.previous[p].torque) = Quad{};
    }
    *reinterpret_cast<Quad*>(motion.velocity) = velocity;
    *reinterpret_cast<Quad*>(step.rotation[p].spin) = spin;
    if constexpr (fluid) *reinterpret_cast<Quad*>(step.drag[p].impulse) = impulse;
  };
  if constexpr (sparse) {
    constexpr int block = 64;
    const FreeSteps steps(step);
    const Quad falling = gravity * move;
    const bool falls = falling[0] != 0 || falling[1] != 0 || falling[2] != 0;
    const auto size = [&](int first) { return step.count - first < block ? step.count - first : block; };
    std::uint64_t loaded = step.count > 0 ? loaded_in_block(step, 0, size(0)) : 0;
    for (int first = 0; first < step.count; first += block) {
      // The loads of the few that have some lie far apart, where the processor does not foresee them.
      const int next = first + block;
      const std::uint64_t coming = next < step.count ? loaded_in_block(step, next, size(next)) : 0;
      for (std::uint64_t left = coming; left; left &= left - 1) {
        __builtin_prefetch(&step.present[next + __builtin_ctzll(left)], 1);
        __builtin_prefetch(&step.previous[next + __builtin_ctzll(left)], 1);
        __builtin_prefetch(&step.rotation[next + __builtin_ctzll(left)], 1);
      }
      if constexpr (drift)
        falls ? move_freely<true>(step, steps, first, size(first), loaded, ways)
              : move_freely<false>(step, steps, first, size(first), loaded, ways);
      for (std::uint64_t left = loaded; left; left &= left - 1) integrate_one(first + __builtin_ctzll(left));
      loaded = coming;
    }
  } else {
    for (int p = 0; p < step.count; ++p) integrate_one(p);
  }
  step.largest_square = step.check = 0;
  for (int k = 0; k < 4; ++k) {
    step.largest_square = step.largest_square > ways.largest[k] ? step.largest_square : ways.largest[k];
    step.check += ways.sum[k];
  }
}

template <bool fluid, bool turning, bool sparse, bool leapfrog>
SILT_INLINE void choose_pass(Integration& step) {
  if (step.correct && step.drift)
    integrate_all<true, true, fluid, turning, sparse, leapfrog>(step);
  else if (step.correct)
    integrate_all<true, false, fluid, turning, sparse, leapfrog>(step);
  else
    integrate_all<false, true, fluid, turning, sparse, leapfrog>(step);
}
template <bool leapfrog>
SILT_INLINE void choose_forces(Integration& step) {
  if (step.turning)
    choose_pass<true, true, false, leapfrog>(step);
  else if (step.drag)
    choose_pass<true, false, false, leapfrog>(step);
  else if (!leapfrog && step.loaded && step.loaded_before)
    choose_pass<false, false, true, false>(step);
  else
    choose_pass<false, false, false, leapfrog>(step);
}
void integrate(Integration& step) { step.leapfrog ? choose_forces<true>(step) : choose_forces<false>(step); }

}  // namespace SILT_ISA
}  // namespace silt
