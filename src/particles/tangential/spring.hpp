#pragma once
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/tangential/tangential_load.hpp"

namespace silt {

/// Constant spring without a dashpot (7.31-7.32), Cundall & Strack 1979; at the Coulomb limit the spring is cut back
/// (7.36; the print lacks mu).
struct SpringTangential {
  static constexpr const char* name = "spring";
  static constexpr ModelNote note{"(7.31-7.32)", "Cundall & Strack 1979",
                                  "F_t = -min(k_t |zeta|, mu |F_n|) zeta/|zeta|; at the limit zeta = mu |F_n|/k_t",
                                  "frequency sqrt(7/2 k_t/m) of a stuck contact; a heap stands"};
  static constexpr bool extended = false;
  std::optional<double> stiffness;
  void options(OptionGroup& option) {
    option("stiffness", stiffness, "N/m", "tangential spring stiffness k_t; needed by spring", positive);
  }
  void check() const {
    if (!stiffness) throw UserError("-tangential_type spring needs -tangential_stiffness (N/m, positive)");
  }

  template <class Real>
  struct Constants {
    Real stiffness, friction, least_share;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {*stiffness, pair.friction, pair.least_share};
  }

  template <class Real>
  struct History {
    Real spring[3];  ///< m, zeta
  };

  template <class Real>
  static SILT_INLINE SpringLaw<Real> law(const NormalLoad<Real>&, const Constants<Real>& c) {
    return {c.stiffness, Real(0.0)};
  }

  /// Half a swing of a stuck contact, whose slip answers to a force as a mass of 2/7 m_eff. s
  static double swing(const Constants<double>& c, const Encounter& e) {
    return swing_duration(e.mass / 3.5, c.stiffness, 0);
  }
};

}  // namespace silt
