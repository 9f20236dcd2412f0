#pragma once
#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"
#include "particles/rolling/rolling_motion.hpp"

namespace silt {

/// Torque of constant size against the relative rolling rate w_r (7.94), Zhou et al. 1999. At most what stops the
/// rolling within the step.
struct ConstantRolling {
  static constexpr const char* name = "constant";
  static constexpr ModelNote note{"(7.94)", "Zhou et al. 1999", "M = -mu_r R_eff |F_n| w_r/|w_r|",
                                  "a rolling ball stops after v^2/(2 * 5/7 mu_r g)"};
  static constexpr bool extended = true;
  void options(OptionGroup&) {}
  template <class Real>
  struct Constants {
    Real rolling_friction;
  };
  Constants<double> constants(const PairProperties& pair) const { return {pair.rolling_friction}; }
  template <class Real>
  struct History {};
  template <class Real>
  static SILT_INLINE void torque(const Contact<Real>& contact, const NormalLoad<Real>& normal, const Constants<Real>& c,
                                 Real dt, History<Real>&, Real* torque) {
    const Real least(1e-300), zero(0.0);
    Real rate[3];
    rolling_rate(contact, rate);
    const Real length = sqrt(dot(rate, rate));
    const Real full = c.rolling_friction * contact.effective_radius * magnitude(normal.force);
    const Real share = smaller(full, stopping_torque(contact, length, dt)) / larger(length, least);
    for (int d = 0; d < 3; ++d) torque[d] = zero - share * rate[d];
  }
};

}  // namespace silt
