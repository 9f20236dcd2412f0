#pragma once
#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"
#include "particles/rolling/rolling_motion.hpp"
#include "particles/tangential/tangential_load.hpp"

namespace silt {

/// Elastic-plastic spring and dashpot, Ai et al. 2011, type C, with the stiffness of Iwashita & Oda 1998; I_r is the
/// rolling inertia of the pair about the contact; the dashpot acts only below the limit.
struct EpsdRolling {
  static constexpr const char* name = "epsd";
  static constexpr ModelNote note{
      "", "Ai et al. 2011; Iwashita & Oda 1998",
      "M = -(k_r theta + c_r w_r), k_r |theta| at most mu_r R_eff |F_n|; k_r = 2.25 k_n mu_r^2 R_eff^2, c_r = 2 eta "
      "sqrt(I_r k_r), 0 at the limit",
      "frequency sqrt(k_r/I_r) and decay eta of a rocking ball; a rolling ball stops after v^2/(2 * 5/7 mu_r g)"};
  static constexpr bool extended = true;
  double damping_ratio = 0.3;
  void options(OptionGroup& option) {
    option("damping_ratio", damping_ratio, "-", "eta, rolling damping as a share of critical", non_negative);
  }
  template <class Real>
  struct Constants {
    Real rolling_friction, damping_ratio, least_share;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {pair.rolling_friction, damping_ratio, pair.least_share};
  }
  template <class Real>
  struct History {
    Real angle[3];  ///< rad, theta as it will be after the rest of the step (share_of_step)
  };
  template <class Real>
  static SILT_INLINE void torque(const Contact<Real>& contact, const NormalLoad<Real>& normal, const Constants<Real>& c,
                                 Real dt, History<Real>& history, Real* torque) {
    const Real least(1e-300), zero(0.0), one(1.0), two(2.0);
    Real rate[3];
    rolling_rate(contact, rate);
    const Real arm = c.rolling_friction * contact.effective_radius;
    const Real stiffness = Real(2.25) * normal.stiffness * arm * arm, limit = arm * magnitude(normal.force);
    turn_into_plane(history.angle, contact.normal);
    const Real read = dt * share_of_step(c.least_share, stiffness * dt * dt / contact.rolling_inertia),
               rest = dt - read;
    Real angle[3];
    for (int d = 0; d < 3; ++d) angle[d] = history.angle[d] + read * rate[d];
    const Real trial = stiffness * sqrt(dot(angle, angle));
    const auto slips = trial > limit;
    const Real kept = select(slips, limit / larger(trial, least), one);
    const Real damping =
        select(slips, zero, two * c.damping_ratio * sqrt(contact.rolling_inertia * larger(stiffness, zero)));
    for (int d = 0; d < 3; ++d) {
      torque[d] = zero - (stiffness * kept * angle[d] + damping * rate[d]);
      history.angle[d] = kept * angle[d] + rest * rate[d];
    }
  }
};

}  // namespace silt
