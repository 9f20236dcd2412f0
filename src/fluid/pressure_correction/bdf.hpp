#pragma once

namespace silt {

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
