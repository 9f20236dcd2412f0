#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/force_jump.hpp"
#include "particles/materials.hpp"
#include "particles/normal/hertz.hpp"

namespace silt {

/// Hertz spring with a constant dashpot (7.11), Lee & Herrmann 1993, who gave its coefficient as the rate gamma/m_eff.
struct LeeHerrmann {
  static constexpr const char* name = "lee_herrmann";
  static constexpr ModelNote note{
      "(7.11)", "Lee & Herrmann 1993", "F = k x^1.5 + gamma dx/dt, k as of tsuji; gamma or gamma/m_eff is given",
      "the restitution of the scaled equation x'' = -x^1.5 - c x'; faster impacts lose less"};
  static constexpr bool extended = false, hertzian = true, hertz_spring = true, jumps = true;
  std::optional<double> damping, damping_rate;
  bool no_attraction = false;

  void options(OptionGroup& option) {
    option("damping", damping, "kg/s", "dashpot coefficient gamma", non_negative);
    option("damping_rate", damping_rate, "1/s", "gamma/m_eff, in place of damping", non_negative);
    option("no_attraction", no_attraction, "clip the attractive last part of a damped collision");
  }
  void check() const {
    if (damping.has_value() == damping_rate.has_value())
      throw UserError(
          "-normal_type lee_herrmann needs one of -normal_damping (kg/s) and -normal_damping_rate (1/s), not both");
  }

  /// What decides the energy lost in place of the restitution; null where the restitution does.
  const char* loss() const { return damping ? "-normal_damping" : "-normal_damping_rate"; }

  template <class Real>
  struct Constants {
    Real stiffness;     ///< Pa, 4/3 E_eff
    Real damping;       ///< kg/s
    Real damping_rate;  ///< 1/s, gamma = damping + damping_rate m_eff
    Real least_force;   ///< N, 0 to clip, else very negative
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {4.0 / 3.0 * pair.effective_young, damping.value_or(0), damping_rate.value_or(0),
            no_attraction ? 0 : -infinity};
  }

  template <class Real>
  using History = Meeting<Real>;

  template <class Real>
  static SILT_INLINE NormalLoad<Real> load(const Contact<Real>& contact, const Constants<Real>& c,
                                           History<Real>& history) {
    NormalLoad<Real> load;
    const Real zero(0.0), overlap = larger(contact.overlap, zero);
    load.contact_radius = sqrt(contact.effective_radius * overlap);
    const Real stiffness = c.stiffness * load.contact_radius;
    load.stiffness = Real(1.5) * stiffness;
    const Real damping = c.damping + c.damping_rate * contact.effective_mass;
    load.damping = select(overlap > zero, damping, zero);
    const Real spring = hertz_reading(contact, c.stiffness, overlap, load.contact_radius);
    const Real force = larger(spring + load.damping * contact.approach, c.least_force);
    load.force = select(overlap > zero, force, zero);
    load.jump = jump_at_meeting(contact, contact.overlap, larger(damping * contact.approach, c.least_force), history);
    return load;
  }

  static double duration(const Constants<double>& c, const Encounter& e) {
    return std::min(hertz_duration(c.stiffness * std::sqrt(e.radius), e.mass, e.speed),
                    damping_duration(e.mass, c.damping + c.damping_rate * e.mass));
  }
};

}  // namespace silt
