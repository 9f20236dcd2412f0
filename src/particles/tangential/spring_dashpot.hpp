#pragma once
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/tangential/tangential_load.hpp"

namespace silt {

/// Constant spring and dashpot with the Coulomb limit (7.33), Cundall & Strack 1979.
struct SpringDashpot {
  static constexpr const char* name = "spring_dashpot";
  static constexpr ModelNote note{
      "(7.33), (7.36)", "Cundall & Strack 1979",
      "F_t = -(k_t zeta + gamma_t V_t), at most mu |F_n|, zeta = int V_t dt; at the limit zeta is cut back",
      "frequency and decay of a stuck contact"};
  static constexpr bool extended = false;
  std::optional<double> stiffness, damping, damping_ratio;
  void options(OptionGroup& option) {
    option("stiffness", stiffness, "N/m", "tangential spring stiffness k_t; needed by spring_dashpot", positive);
    option("damping", damping, "kg/s", "tangential dashpot coefficient gamma_t", non_negative);
    option("damping_ratio", damping_ratio, "-",
           "gamma_t as a share of the normal damping, in place of damping; default: 0.5", non_negative);
  }
  void check() const {
    if (!stiffness) throw UserError("-tangential_type spring_dashpot needs -tangential_stiffness (N/m, positive)");
    if (damping && damping_ratio)
      throw UserError("-tangential_damping (kg/s) and -tangential_damping_ratio are both given: give one");
  }

  template <class Real>
  struct Constants {
    Real stiffness, damping, damping_ratio, friction, least_share;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {*stiffness, damping.value_or(0), damping ? 0 : damping_ratio.value_or(0.5), pair.friction,
            pair.least_share};
  }

  template <class Real>
  struct History {
    Real spring[3];  ///< m, zeta
  };

  template <class Real>
  static SILT_INLINE SpringLaw<Real> law(const NormalLoad<Real>& normal, const Constants<Real>& c) {
    return {c.stiffness, c.damping + c.damping_ratio * normal.damping};
  }

  /// Half a swing of a stuck contact, whose slip answers to a force as a mass of 2/7 m_eff. s
  static double swing(const Constants<double>& c, const Encounter& e) {
    return swing_duration(e.mass / 3.5, c.stiffness, c.damping);
  }
};

}  // namespace silt
