#pragma once
#include <cmath>
#include <optional>

#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/tangential/tangential_load.hpp"

namespace silt {

/// No-slip stiffness with the Coulomb limit (7.34-7.36), Mindlin & Deresiewicz 1953; Tsuji et al. 1992. The dashpot
/// follows from the same restitution as the normal one.
struct Mindlin {
  static constexpr const char* name = "mindlin";
  static constexpr ModelNote note{
      "(7.34-7.36)", "Mindlin & Deresiewicz 1953; Tsuji et al. 1992",
      "F_t as of spring_dashpot, at most mu |F_n|; k_t = 8 G_eff sqrt(R_eff x), gamma_t = 2 sqrt(G_eff/E_eff) gamma",
      "Chung & Ooi's oblique impacts; a sliding ball rolls at 5/7 of its speed after 2/7 v/(mu g)"};
  static constexpr bool extended = false;
  std::optional<double> damping_ratio;
  void options(OptionGroup& option) {
    option("damping_ratio", damping_ratio, "-", "gamma_t/gamma_n; default: from the restitution", non_negative);
  }

  template <class Real>
  struct Constants {
    Real stiffness;  ///< Pa, 8 G_eff
    Real damping_ratio, friction, least_share;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {8 * pair.effective_shear,
            damping_ratio.value_or(2 * std::sqrt(pair.effective_shear / pair.effective_young)), pair.friction,
            pair.least_share};
  }

  template <class Real>
  struct History {
    Real spring[3];  ///< m, zeta
  };

  template <class Real>
  static SILT_INLINE SpringLaw<Real> law(const NormalLoad<Real>& normal, const Constants<Real>& c) {
    return {c.stiffness * normal.contact_radius, c.damping_ratio * normal.damping};
  }
};

}  // namespace silt
