#pragma once
#include "base/options.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Constant torque mu_r R_eff |F_n| against the relative rolling rate (7.94).
/// It is limited to what stops the relative rolling within the step (inertia 2/5 m_eff R_eff^2, a lower bound), so that
/// a resting contact is not shaken by a torque that changes sign every step.
struct ConstantRolling {
  static constexpr const char* name = "constant";
  static constexpr bool acts = true;
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
    const Real twist = dot(contact.spin, contact.normal);
    Real rate[3];
    for (int d = 0; d < 3; ++d) rate[d] = contact.spin[d] - twist * contact.normal[d];
    const Real length = sqrt(dot(rate, rate));
    const Real full = c.rolling_friction * contact.effective_radius * larger(normal.force, zero - normal.force);
    const Real stopping = Real(0.4) * contact.effective_mass * contact.effective_radius * contact.effective_radius *
                          length / larger(dt, least);
    const Real share = smaller(full, stopping) / larger(length, least);
    for (int d = 0; d < 3; ++d) torque[d] = zero - share * rate[d];
  }
};

}  // namespace silt
