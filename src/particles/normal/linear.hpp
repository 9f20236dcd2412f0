#pragma once
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/force_jump.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Linear spring and dashpot (7.7-7.10), Tsuji et al. 1993; Schafer et al. 1996.
///
/// Either stiffness and damping are given; or the pair's restitution e with the stiffness or the contact time t_n.
struct Linear {
  static constexpr const char* name = "linear";
  static constexpr ModelNote note{"(7.7-7.10)", "Tsuji et al. 1993; Schafer et al. 1996",
                                  "F = k x + gamma dx/dt; given k and gamma, or e with k or t_n: e = exp(-pi gamma/(2 "
                                  "m_eff w)), t_n = pi/w, w^2 = k/m_eff - (gamma/(2 m_eff))^2",
                                  "restitution and contact time as given, to second order in the step"};
  static constexpr bool extended = false, hertzian = false, hertz_spring = false, jumps = true;
  std::optional<double> stiffness, damping, contact_time;
  bool no_attraction = false;

  void options(OptionGroup& option) {
    option("stiffness", stiffness, "N/m", "spring stiffness k; or give contact_time", positive);
    option("contact_time", contact_time, "s", "duration t_n of a collision, in place of stiffness", positive);
    option("damping", damping, "kg/s", "dashpot coefficient gamma; default: from the restitution", non_negative);
    option("no_attraction", no_attraction, "clip the attractive last part of a damped collision");
  }
  void check() const {
    if (stiffness.has_value() == contact_time.has_value())
      throw UserError("-normal_type linear needs either -normal_stiffness (N/m) or -normal_contact_time (s)");
    if (contact_time && damping)
      throw UserError("-normal_damping goes with -normal_stiffness, not -normal_contact_time");
  }

  /// What decides the energy lost in place of the restitution; null where the restitution does.
  const char* loss() const { return damping ? "-normal_damping" : nullptr; }

  template <class Real>
  struct Constants {
    Real stiffness;           ///< N/m
    Real stiffness_per_mass;  ///< 1/s2, k = stiffness + stiffness_per_mass m_eff
    Real damping;             ///< kg/s
    Real damping_ratio;       ///< gamma = damping + damping_ratio sqrt(k m_eff)
    Real least_force;         ///< N, 0 to clip, else very negative
  };
  Constants<double> constants(const PairProperties& pair) const {
    Constants<double> c{};
    const double log_e = std::log(pair.restitution),
                 root = std::sqrt(log_e * log_e + std::numbers::pi * std::numbers::pi);
    if (contact_time)
      c.stiffness_per_mass = (root / *contact_time) * (root / *contact_time);
    else
      c.stiffness = *stiffness;
    if (damping)
      c.damping = *damping;
    else
      c.damping_ratio = -2 * log_e / root;
    c.least_force = no_attraction ? 0 : -infinity;
    return c;
  }

  template <class Real>
  using History = Meeting<Real>;

  template <class Real>
  static SILT_INLINE NormalLoad<Real> load(const Contact<Real>& contact, const Constants<Real>& c,
                                           History<Real>& history) {
    NormalLoad<Real> load;
    const Real zero(0.0), overlap = larger(contact.overlap, zero);
    const Real k = c.stiffness + c.stiffness_per_mass * contact.effective_mass;
    const Real damping = c.damping + c.damping_ratio * sqrt(k * contact.effective_mass);
    load.stiffness = k;
    load.damping = select(overlap > zero, damping, zero);
    const Real force = larger(k * overlap + load.damping * contact.approach, c.least_force);
    load.force = select(overlap > zero, force, zero);
    load.jump = jump_at_meeting(contact, contact.overlap, larger(damping * contact.approach, c.least_force), history);
    load.contact_radius = sqrt(contact.effective_radius * overlap);
    return load;
  }

  /// (7.9)
  static double duration(const Constants<double>& c, const Encounter& e) {
    const double k = c.stiffness + c.stiffness_per_mass * e.mass;
    const double gamma = c.damping + c.damping_ratio * std::sqrt(k * e.mass);
    const double square = k / e.mass - gamma * gamma / (4 * e.mass * e.mass);
    // An overdamped contact never swings back; its fastest rate is then what the step must resolve.
    return square > 0 ? std::numbers::pi / std::sqrt(square) : std::numbers::pi * e.mass / gamma;
  }
};

}  // namespace silt
