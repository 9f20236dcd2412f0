#pragma once
#include <cmath>
#include <optional>

#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"
#include "particles/tangential/tangential_load.hpp"

namespace silt {

/// Twisting resistance (7.39-7.40), Marshall 2009, W_t the relative spin along the normal, a the contact radius; at the
/// limit the spring is cut back. Unless they are given, stiffness and dashpot are those of a disc of radius a that is
/// held by the no-slip stiffness and dashpot of `mindlin`.
struct Twisting {
  static constexpr const char* name = "twisting";
  static constexpr ModelNote note{
      "(7.39-7.40)", "Marshall 2009",
      "M_t = -(k_q int W_t dt + gamma_q W_t) n, W_t = (w_i - w_j).n, at most 2/3 mu |F_n| a; unless given k_q = k_t "
      "a^2/2 = 4 G_eff a^3 and gamma_q = gamma_t a^2/2",
      "frequency sqrt(k_q (1/I_i + 1/I_j)); a spinning ball on a plane stops after I w/(2/3 mu m g a)"};
  static constexpr bool extended = true;
  std::optional<double> stiffness, damping;
  void options(OptionGroup& option) {
    option("stiffness", stiffness, "N m", "twisting stiffness k_q; default: 4 G_eff a^3, a the contact radius",
           positive);
    option("damping", damping, "N m s", "twisting dashpot gamma_q; default: sqrt(G_eff/E_eff) gamma_n a^2",
           non_negative);
  }

  template <class Real>
  struct Constants {
    Real stiffness;      ///< N m
    Real shear;          ///< Pa, k_q = stiffness + shear a^3
    Real damping;        ///< N m s
    Real damping_ratio;  ///< -, gamma_q = damping + damping_ratio gamma_n a^2
    Real friction, least_share;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {stiffness.value_or(0), stiffness ? 0 : 4 * pair.effective_shear,
            damping.value_or(0),   damping ? 0 : std::sqrt(pair.effective_shear / pair.effective_young),
            pair.friction,         pair.least_share};
  }

  template <class Real>
  struct History {
    Real angle;  ///< rad, int W_t dt, as it will be after the rest of the step (share_of_step)
  };

  /// N m, along the normal.
  template <class Real>
  static SILT_INLINE Real torque(const Contact<Real>& contact, const NormalLoad<Real>& normal, const Constants<Real>& c,
                                 Real dt, History<Real>& history) {
    const Real zero(0.0), least(1e-300), a = normal.contact_radius;
    const Real rate = dot(contact.spin, contact.normal);
    const Real stiffness = c.stiffness + c.shear * a * a * a;
    const Real damping = c.damping + c.damping_ratio * normal.damping * a * a;
    const Real inertia = Real(0.4) * contact.effective_mass * contact.effective_radius * contact.effective_radius;
    const Real read = dt * share_of_step(c.least_share, stiffness * dt * dt / inertia);
    const Real trial = stiffness * (history.angle + read * rate) + damping * rate;
    const Real limit = Real(2.0 / 3.0) * c.friction * magnitude(normal.force) * a;
    const Real kept = larger(smaller(trial, limit), zero - limit);
    const Real cut = select(magnitude(trial) > limit, (trial - kept) / larger(stiffness, least), zero);
    history.angle = history.angle + dt * rate - cut;
    return zero - kept;
  }

  /// Half a swing on the stiffness and dashpot given; those of the contact's radius are softer than its normal force. s
  static double swing(const Constants<double>& c, const Encounter& e) {
    return swing_duration(e.rolling_inertia / 3.5, c.stiffness, c.damping);
  }
};

}  // namespace silt
