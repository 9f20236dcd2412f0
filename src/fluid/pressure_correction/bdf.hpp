#pragma once

namespace silt {

/// The first steps of a run are of first order: BDF2 after one BDF1 step takes half of that step's change of velocity
/// on once more, so an impulsive start (particles that meet the fluid's velocity at once) would keep 3/2 of its
/// impulse. After three steps what is taken on is the half of a small change; the order in time stays two.
inline constexpr int starting_steps = 3;

/// Backward difference formula of order 1 or 2 with variable step: du/dt at n+1 is c0 u^{n+1} - c1 u^n + c2 u^{n-1},
/// and u^{n+1} is extrapolated as e1 u^n - e2 u^{n-1} (Hairer, Noersett & Wanner, Solving ODEs I, III.5).
struct Bdf {
  double c0, c1, c2;  ///< 1/s
  double e1, e2;

  static Bdf first(double dt) { return {1 / dt, 1 / dt, 0, 1, 0}; }
  static Bdf second(double dt, double old_dt) {
    const double w = dt / old_dt;
    return {(1 + 2 * w) / (1 + w) / dt, (1 + w) / dt, w * w / (1 + w) / dt, 1 + w, w};
  }
};

}  // namespace silt
