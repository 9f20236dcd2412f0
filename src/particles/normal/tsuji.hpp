#pragma once
#include <cmath>
#include <numbers>

#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/hertz.hpp"

namespace silt {

/// Hertz spring with a dashpot that makes the restitution e independent of the impact speed (7.12, 7.16), Tsuji et al.
/// 1992, its coefficient by Antypov & Elliott 2011.
struct Tsuji {
  static constexpr const char* name = "tsuji";
  static constexpr ModelNote note{
      "(7.12), (7.16)", "Tsuji et al. 1992; Antypov & Elliott 2011",
      "F = k x^1.5 + gamma x^0.25 dx/dt, k = 4/3 E_eff sqrt(R_eff), gamma = alpha sqrt(m_eff k), alpha = -sqrt(5) ln e "
      "/ "
      "sqrt(ln^2 e + pi^2)",
      "restitution e at any speed; elastic limit: largest overlap (5 m_eff v^2/(4 k))^(2/5), duration 2.943 x_max/v"};
  static constexpr bool extended = false;
  static constexpr bool hertzian = true;      ///< waves in the particles limit the step
  static constexpr bool hertz_spring = true;  ///< the spring is Hertz's, which JKR and DMT build on
  bool no_attraction = false;
  void options(OptionGroup& option) {
    option("no_attraction", no_attraction, "clip the attractive last part of a damped collision");
  }

  template <class Real>
  struct Constants {
    Real stiffness;    ///< Pa, 4/3 E_eff
    Real damping;      ///< alpha
    Real least_force;  ///< N, 0 to clip, else very negative
  };
  Constants<double> constants(const PairProperties& pair) const {
    const double log_e = std::log(pair.restitution);
    return {4.0 / 3.0 * pair.effective_young,
            -std::sqrt(5.0) * log_e / std::sqrt(log_e * log_e + std::numbers::pi * std::numbers::pi),
            no_attraction ? 0 : -infinity};
  }

  template <class Real>
  struct History {};

  template <class Real>
  static SILT_INLINE NormalLoad<Real> load(const Contact<Real>& contact, const Constants<Real>& c, History<Real>&) {
    NormalLoad<Real> load;
    const Real zero(0.0), overlap = larger(contact.overlap, zero);
    load.contact_radius = sqrt(contact.effective_radius * overlap);
    const Real stiffness = c.stiffness * load.contact_radius;  // k sqrt(x)
    load.stiffness = Real(1.5) * stiffness;
    load.damping = c.damping * sqrt(contact.effective_mass * stiffness);
    const Real spring = hertz_reading(contact, c.stiffness, overlap, load.contact_radius);
    const Real force = larger(spring + load.damping * contact.approach, c.least_force);
    load.force = select(overlap > zero, force, zero);
    return load;
  }

  static double duration(const Constants<double>& c, const Encounter& e) {
    return hertz_duration(c.stiffness * std::sqrt(e.radius), e.mass, e.speed);
  }
};

}  // namespace silt
