#pragma once
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"
#include "particles/rolling/rolling_motion.hpp"

namespace silt {

/// Rolling torque that grows with the relative rolling rate w_r up to a limit (7.44), g_r a length. At most what stops
/// the rolling within the step.
struct ViscousCoulombRolling {
  static constexpr const char* name = "viscous_coulomb";
  static constexpr ModelNote note{"(7.44)", "Brilliantov & Poschel 1998; Iwashita & Oda 1998",
                                  "M = -min(k_rw |w_r|, g_r |F_n|) w_r/|w_r|",
                                  "rolling decays exponentially below the limit, linearly at it"};
  static constexpr bool extended = true;
  std::optional<double> damping, length;
  void options(OptionGroup& option) {
    option("damping", damping, "N m s", "k_rw, torque over rolling rate; needed by viscous_coulomb", positive);
    option("length", length, "m", "g_r, largest torque over normal force; default: mu_r R_eff", non_negative);
  }
  void check() const {
    if (!damping) throw UserError("-rolling_type viscous_coulomb needs -rolling_damping (N m s, positive)");
  }
  template <class Real>
  struct Constants {
    Real damping, length, rolling_friction;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {*damping, length.value_or(0), length ? 0 : pair.rolling_friction};
  }
  template <class Real>
  struct History {};
  template <class Real>
  static SILT_INLINE void torque(const Contact<Real>& contact, const NormalLoad<Real>& normal, const Constants<Real>& c,
                                 Real dt, History<Real>&, Real* torque) {
    const Real least(1e-300), zero(0.0);
    Real rate[3];
    rolling_rate(contact, rate);
    const Real size = sqrt(dot(rate, rate));
    const Real limit = (c.length + c.rolling_friction * contact.effective_radius) * magnitude(normal.force);
    const Real full = smaller(c.damping * size, limit);
    const Real share = smaller(full, stopping_torque(contact, size, dt)) / larger(size, least);
    for (int d = 0; d < 3; ++d) torque[d] = zero - share * rate[d];
  }
};

}  // namespace silt
