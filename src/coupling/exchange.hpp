#pragma once
#include <algorithm>
#include <cmath>

#include "base/vector.hpp"

namespace silt {

/// How a particle answers to a change of the fluid velocity over a step, in its two limits.
///
/// A free particle follows the fluid: eliminated exactly it owes the fluid the mass m (1 - exp(-k dt/m)), at once. A
/// particle held by its neighbours does not follow: it takes k dt (u^{n+1} - u^n), which its contacts must carry, so it
/// comes as a force over the next step. Momentum is conserved for any response; the response decides stability and
/// accuracy.
struct Response {
  double free = 0;  ///< kg, m (1 - exp(-k dt/m))
  double mass = 0;  ///< kg, (1 - held) free + held k dt: what the particle owes per unit change of the fluid velocity
  double held = 0;  ///< 0 free ... 1 held
};

/// `added`: kg, mass of fluid accelerated with the particle.
inline Response response(double mass, double exchange, double held, double dt, double added = 0) {
  const double free = -mass * std::expm1(-exchange * dt / (mass + added));
  return {free, (1 - held) * free + held * exchange * dt, held};
}

/// How much a particle was held back by contacts in the last step, 0 free ... 1 held: |v - w| / |w - v0| but at most 1,
/// with w the velocity it would have reached alone, w = u + F/k + (v0 - u - F/k) exp(-k dt/m). Where neither drag nor
/// the other force nor a contact changed the velocity by more than 1e-3 of what drag and force each would have done,
/// that says nothing and `before` stays. `force`: every force but drag and contacts, gravity included (N); `fluid`,
/// `start`, `now`: u, v0, v (m/s).
inline double held(const Vec3& start, const Vec3& now, const Vec3& fluid, const Vec3& force, double mass,
                   double exchange, double dt, double before) {
  const double relaxed = -std::expm1(-exchange * dt / mass);  // 1 - exp(-k dt/m)
  const double pushed = exchange * dt > 1e-8 * mass ? relaxed / exchange : dt / mass;
  const Vec3 by_drag = relaxed * (fluid - start), by_force = pushed * force, alone = by_drag + by_force;
  const double change = alone.norm(), missed = (now - start - alone).norm();
  if (!(std::max(change, missed) > 1e-3 * (by_drag.norm() + by_force.norm()))) return before;
  return missed < change ? missed / change : 1.0;
}

/// What fluid and particles exchanged in one fluid step, each sum made once over the particles and once over the nodes.
/// N s, all ranks.
struct ExchangeLedger {
  Vec3 drag_on_particles = Vec3::Zero();      ///< sum_p I_p, drag impulse the particles received in their substeps
  Vec3 forces_on_particles = Vec3::Zero();    ///< impulse of lift, virtual mass and viscous stress at the step's start
  Vec3 drag_on_fluid = Vec3::Zero();          ///< the load vector's total times dt: the opposite of the two above
  Vec3 response_on_particles = Vec3::Zero();  ///< sum_p J_p, owed for the change of the fluid velocity
  Vec3 response_on_fluid = Vec3::Zero();      ///< -dt sum_i response_i (u^{n+1} - u^n)_i
  Vec3 pressure_on_particles = Vec3::Zero();  ///< -dt sum_p V_p grad p
  Vec3 pressure_on_fluid =
      Vec3::Zero();  ///< dt sum_i M_i (1 - alpha_i) (grad p)_i: the share of grad p that the fluid does not feel
  Vec3 buoyancy = Vec3::Zero();       ///< -dt rho sum_p V_p g given to the particles as a force in this step
  Vec3 given_at_once = Vec3::Zero();  ///< part of J_p settled by kicks at the end of this step
  Vec3 delivered = Vec3::Zero();      ///< owed by the step before, given as a force during this one
  Vec3 in_transit = Vec3::Zero();     ///< owed at the end of this step, to be given as a force over the next
  double particle_volume = 0;         ///< m3, sum_p V_p
  double deposited_volume = 0;        ///< m3, sum_i M_i (1 - alpha_i)
  double residual = 0;  ///< largest imbalance of the pairs above, relative to the magnitudes that were summed
};

/// The residual above which the run must stop.
inline constexpr double exchange_tolerance = 1e-10;

/// `imbalance` over the magnitudes that were `exchanged`. Throws RunError where it is above exchange_tolerance; `what`
/// names the exchange.
double balanced(const char* what, double imbalance, double exchanged);

}  // namespace silt
