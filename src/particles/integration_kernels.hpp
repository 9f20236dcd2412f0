// The pass over all particles that moves them; part of sweep_kernels.hpp, compiled once per instruction set.
#pragma once
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

/// The drift of a particle that nothing but gravity acts on, with the bits of the general one; its spin stays.
SILT_INLINE void move_freely(Integration& step, int p, double& largest, double& check) {
  Motion& motion = step.motion[p];
  const double h = step.dt;
  const Quad move = quad(step.move), acceleration = quad(step.gravity) * move;
  const Quad velocity = quad(motion.velocity), before = quad(motion.position);
  const Quad position = before + (every(h) * move) * velocity + every(step.second) * acceleration;
  *reinterpret_cast<Quad*>(motion.position) = position;
  *reinterpret_cast<Quad*>(motion.velocity) = velocity + every(h) * acceleration;
  if (step.orientation) {
    const Quad spin = quad(motion.spin);
    turn_by(step.orientation[p], h * spin[0], h * spin[1], h * spin[2]);
  }
  const Quad moved = position - before;
  const double square = moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2];
  largest = largest > square ? largest : square;
  check += square;
}

template <bool correct, bool drift, bool fluid, bool turning, bool sparse>
void integrate_all(Integration& step) {
  const double h = step.dt;
  const Quad move = quad(step.move), turn = quad(step.turn), gravity = quad(step.gravity);
  double largest = 0, check = 0;
  for (int p = 0; p < step.count; ++p) {
    Motion& motion = step.motion[p];
    if constexpr (sparse) {
      // The loads of the few that have some lie far apart, where the processor does not foresee them.
      constexpr int ahead = 24;
      if (const int next = p + ahead; next < step.count && (step.loaded[next] | step.loaded_before[next])) {
        __builtin_prefetch(&step.present[next], 1);
        __builtin_prefetch(&step.previous[next], 1);
      }
      if (!(step.loaded[p] | step.loaded_before[p])) {
        if constexpr (drift) move_freely(step, p, largest, check);
        continue;
      }
    }
    Quad velocity = quad(motion.velocity), spin = quad(motion.spin);
    const double inverse_mass = motion.inverse_mass;
    const double inverse_inertia = 2.5 * inverse_mass / (motion.radius * motion.radius);
    const Quad force = quad(step.present[p].force), torque = quad(step.present[p].torque);
    double first = h, second = step.second, corrector = 0.5 * h, share = 1;
    double turn_first = h, turn_corrector = 0.5 * h;
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
    }
    if constexpr (correct) {
      const Quad change = move * (force - quad(step.previous[p].force));
      const Quad turned = turn * (torque - quad(step.previous[p].torque));
      if constexpr (fluid) {
        const Quad faster = every(corrector * share * inverse_mass) * change;
        const Quad taken = every(corrector * share - 0.5 * h) * change;
        impulse += taken;
        // An impulse does the work of the mean of the velocities before and after all that act together.
        impulse[3] += scalar_product(taken, velocity + every(0.5) * faster);
        velocity += faster;
      } else {
        velocity += every(corrector * inverse_mass) * change;
      }
      const Quad spun = every(turn_corrector * inverse_inertia) * turned;
      if constexpr (turning)
        impulse[3] += scalar_product(every(turn_corrector - 0.5 * h) * turned, spin + every(0.5) * spun);
      spin += spun;
    }
    if constexpr (drift) {
      Quad steady = every(inverse_mass) * force + gravity;
      Quad acceleration = steady;
      if constexpr (fluid) {
        steady += quad(step.drag[p].acceleration);
        acceleration = every(share) * steady + every(step.drag[p].rate) * (quad(step.drag[p].velocity) - velocity);
        impulse += every(1 / inverse_mass) * move * (every(first) * acceleration - every(h) * steady);
        const Quad others = every(inverse_mass) * force + gravity;
        impulse[3] += scalar_product(every(1 / inverse_mass) * move * (every(first) * acceleration - every(h) * others),
                                     velocity + every(0.5 * first) * move * acceleration);
      }
      acceleration *= move;
      const Quad position = quad(motion.position) + (every(h) * move) * velocity + every(second) * acceleration;
      velocity += every(first) * acceleration;
      Quad turned = every(inverse_inertia) * torque;
      if constexpr (turning) {
        const Quad others = turned;
        turned += every(step.turning[p].rate) * (quad(step.turning[p].spin) - spin);
        impulse[3] +=
            scalar_product(every(1 / inverse_inertia) * turn * (every(turn_first) * turned - every(h) * others),
                           spin + every(0.5 * turn_first) * turn * turned);
      }
      turned *= every(turn_first) * turn;
      spin += turned;
      if (step.orientation) {
        const Quad mean = every(h) * (spin - every(step.late_share) * turned);
        turn_by(step.orientation[p], mean[0], mean[1], mean[2]);
      }
      const Quad moved = position - quad(motion.position);
      *reinterpret_cast<Quad*>(motion.position) = position;
      const double square = moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2];
      largest = largest > square ? largest : square;
      check += square;
      *reinterpret_cast<Quad*>(step.previous[p].force) = Quad{};
      *reinterpret_cast<Quad*>(step.previous[p].torque) = Quad{};
    }
    *reinterpret_cast<Quad*>(motion.velocity) = velocity;
    *reinterpret_cast<Quad*>(motion.spin) = spin;
    if constexpr (fluid) *reinterpret_cast<Quad*>(step.drag[p].impulse) = impulse;
  }
  step.largest_square = largest;
  step.check = check;
}

template <bool fluid, bool turning, bool sparse>
SILT_INLINE void choose_pass(Integration& step) {
  if (step.correct && step.drift)
    integrate_all<true, true, fluid, turning, sparse>(step);
  else if (step.correct)
    integrate_all<true, false, fluid, turning, sparse>(step);
  else
    integrate_all<false, true, fluid, turning, sparse>(step);
}
void integrate(Integration& step) {
  if (step.turning)
    choose_pass<true, true, false>(step);
  else if (step.drag)
    choose_pass<true, false, false>(step);
  else if (step.loaded && step.loaded_before)
    choose_pass<false, false, true>(step);
  else
    choose_pass<false, false, false>(step);
}

}  // namespace SILT_ISA
}  // namespace silt
