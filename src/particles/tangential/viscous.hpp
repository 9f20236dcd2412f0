#pragma once
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/materials.hpp"
#include "particles/tangential/tangential_load.hpp"

namespace silt {

/// Sliding friction that grows with the slip up to the Coulomb limit (7.30). There is no static friction: a heap
/// collapses.
struct ViscousTangential {
  static constexpr const char* name = "viscous";
  static constexpr ModelNote note{"(7.30)", "Haff & Werner 1986", "F_t = -min(gamma_t |V_t|, mu |F_n|) V_t/|V_t|",
                                  "slip decays as exp(-7/2 gamma_t t/m) below the limit; a heap collapses"};
  static constexpr bool extended = false;
  std::optional<double> damping, damping_ratio;
  void options(OptionGroup& option) {
    option("damping", damping, "kg/s", "tangential dashpot coefficient gamma_t", non_negative);
    option("damping_ratio", damping_ratio, "-", "gamma_t as a share of the normal damping, in place of damping",
           non_negative);
  }
  void check() const {
    if (damping.has_value() == damping_ratio.has_value())
      throw UserError(
          "-tangential_type viscous needs one of -tangential_damping (kg/s) and -tangential_damping_ratio, not both");
  }

  template <class Real>
  struct Constants {
    Real damping, damping_ratio, friction;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {damping.value_or(0), damping_ratio.value_or(0), pair.friction};
  }

  template <class Real>
  struct History {};

  template <class Real>
  static SILT_INLINE void force(const Contact<Real>& contact, const NormalLoad<Real>& normal, const Constants<Real>& c,
                                Real /*dt*/, History<Real>&, Real* force) {
    const Real zero(0.0), least(1e-300);
    const Real speed = sqrt(dot(contact.slip, contact.slip));
    const Real full = (c.damping + c.damping_ratio * normal.damping) * speed;
    const Real share = smaller(full, c.friction * magnitude(normal.force)) / larger(speed, least);
    for (int d = 0; d < 3; ++d) force[d] = zero - share * contact.slip[d];
  }

  /// Half a swing of a stuck contact, whose slip answers to a force as a mass of 2/7 m_eff. s
  static double swing(const Constants<double>& c, const Encounter& e) {
    return swing_duration(e.mass / 3.5, 0, c.damping);
  }
};

}  // namespace silt
