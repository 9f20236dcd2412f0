#pragma once
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"
#include "particles/rolling/rolling_motion.hpp"
#include "particles/tangential/tangential_load.hpp"

namespace silt {

/// Rolling spring and dashpot (7.41-7.43), Marshall 2009; Dominik & Tielens 1995. The rolling displacement xi is turned
/// into the present tangent plane; beyond R_eff theta_c, theta_c the critical rolling angle, it is cut back. The
/// stiffness is given, or that of a JKR neck.
struct SpringRolling {
  static constexpr const char* name = "spring";
  static constexpr ModelNote note{
      "(7.41-7.43)", "Marshall 2009; Dominik & Tielens 1995",
      "M_r = -(k_r xi + gamma_r V_r), acting as n x M_r on i, |xi| at most theta_c R_eff; xi = int V_r dt, V_r = "
      "-R_eff (w_i - w_j) x n - 1/2 (R_j - R_i)/(R_j + R_i) V_t; k_r given or 4 F_c (a/a0)^1.5",
      "frequency sqrt(k_r R_eff/I_r) of a rocking ball; torque k_r theta_c R_eff when it rolls on"};
  static constexpr bool extended = true;
  std::optional<double> stiffness;
  double damping = 0, critical_angle = 0.01;
  void options(OptionGroup& option) {
    option("stiffness", stiffness, "N", "k_r, torque over rolling displacement; default: that of the JKR neck",
           positive);
    option("damping", damping, "N s", "gamma_r, torque over rolling velocity", non_negative);
    option("critical_angle", critical_angle, "rad", "rolling displacement at which the contact yields, over R_eff",
           positive);
  }
  /// Whether k_r is that of the neck, so that an adhesion is needed.
  bool needs_neck() const { return !stiffness; }

  template <class Real>
  struct Constants {
    Real stiffness;  ///< N
    Real neck;       ///< Pa, k_r = stiffness + 4 sqrt(F_c neck/R_eff) a^1.5
    Real damping, critical_angle, least_share;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {stiffness.value_or(0), stiffness ? 0 : pair.effective_young / 3, damping, critical_angle, pair.least_share};
  }
  template <class Real>
  struct History {
    Real displacement[3];  ///< m, xi as it will be after the rest of the step (share_of_step)
  };
  template <class Real>
  static SILT_INLINE void torque(const Contact<Real>& contact, const NormalLoad<Real>& normal, const Constants<Real>& c,
                                 Real dt, History<Real>& history, Real* torque) {
    const Real least(1e-300), zero(0.0), one(1.0), half(0.5), a = normal.contact_radius;
    const Real radius = contact.effective_radius;
    const Real stiffness = c.stiffness + Real(4.0) * sqrt(normal.pull_off * c.neck / radius) * a * sqrt(a);
    const Real* n = contact.normal;
    const Real* w = contact.spin;
    const Real rolled[3] = {w[1] * n[2] - w[2] * n[1], w[2] * n[0] - w[0] * n[2], w[0] * n[1] - w[1] * n[0]};
    // (R_j - R_i)/(R_j + R_i) = 2 R_eff/R_i - 1, also at a wall.
    const Real lever = half * (Real(2.0) * radius / contact.radius - one);
    turn_into_plane(history.displacement, n);
    const Real read = dt * share_of_step(c.least_share, stiffness * radius * dt * dt / contact.rolling_inertia),
               rest = dt - read;
    Real velocity[3], xi[3];
    for (int d = 0; d < 3; ++d) {
      velocity[d] = zero - radius * rolled[d] - lever * contact.slip[d];
      xi[d] = history.displacement[d] + read * velocity[d];
    }
    const Real length = sqrt(dot(xi, xi)), limit = c.critical_angle * radius;
    const auto yields = length > limit;
    const Real kept = select(yields, limit / larger(length, least), one);
    const Real active = select(a > zero, one, zero);
    Real moment[3];
    for (int d = 0; d < 3; ++d) {
      moment[d] = active * (stiffness * kept * xi[d] + select(yields, zero, c.damping) * velocity[d]);
      history.displacement[d] = active * (kept * xi[d] + rest * velocity[d]);
    }
    torque[0] = n[1] * moment[2] - n[2] * moment[1];
    torque[1] = n[2] * moment[0] - n[0] * moment[2];
    torque[2] = n[0] * moment[1] - n[1] * moment[0];
  }

  /// Half a swing of a ball that rocks on the stiffness given; a neck's is softer than its normal force. s
  static double swing(const Constants<double>& c, const Encounter& e) {
    return swing_duration(e.rolling_inertia, c.stiffness * e.radius, c.damping * e.radius);
  }
};

}  // namespace silt
