#pragma once
#include <algorithm>
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

/// Repulsive part of a Lennard-Jones potential f, which vanishes with its force where it ends (7.1-7.3), Aoki & Akiyama
/// 1995. X is the distance of the centres, d the sum of the radii; at a wall the distance to it, and R_i.
struct LennardJones {
  static constexpr const char* name = "lennard_jones";
  static constexpr ModelNote note{"(7.1-7.3)", "Aoki & Akiyama 1995",
                                  "F = -df/dX + m_eff gamma dx/dt = eps [12 d^12/X^13 - 6 d^6/X^7] + m_eff gamma dx/dt "
                                  "for X < 2^(1/6) d, f = eps [(d/X)^12 - (d/X)^6 + 1/4]",
                                  "6 eps/d at X = d; closest approach and energy of an elastic collision"};
  static constexpr bool extended = true, hertzian = false, hertz_spring = false, jumps = true;
  std::optional<double> energy;
  double damping_rate = 0;
  void options(OptionGroup& option) {
    option("energy", energy, "J", "eps of the potential; needed by lennard_jones", positive);
    option("damping_rate", damping_rate, "1/s", "gamma, dashpot coefficient over m_eff", non_negative);
  }
  void check() const {
    if (!energy) throw UserError("-normal_type lennard_jones needs -normal_energy (J, positive)");
  }

  /// What decides the energy lost in place of the restitution; null where the restitution does.
  const char* loss() const { return "-normal_damping_rate"; }

  template <class Real>
  struct Constants {
    Real energy, damping_rate;
  };
  Constants<double> constants(const PairProperties&) const { return {*energy, damping_rate}; }
  template <class Real>
  using History = Meeting<Real>;

  template <class Real>
  static SILT_INLINE NormalLoad<Real> load(const Contact<Real>& contact, const Constants<Real>& c,
                                           History<Real>& history) {
    NormalLoad<Real> load;
    const Real zero(0.0), one(1.0);
    const Real inverse = one / contact.distance, q = (contact.distance + contact.overlap) * inverse;
    const Real cube = q * q * q, six = cube * cube;
    const auto acts = six > Real(0.5);
    const Real scale = c.energy * six * inverse;
    const Real damping = contact.effective_mass * c.damping_rate;
    const Real depth = Real(1.122462048309373) * (contact.distance + contact.overlap) - contact.distance;
    load.damping = select(acts, damping, zero);
    load.jump = jump_at_meeting(contact, depth, damping * contact.approach, history);
    load.force = select(acts, scale * (Real(12.0) * six - Real(6.0)), zero) + load.damping * contact.approach;
    load.stiffness = select(acts, scale * inverse * (Real(156.0) * six - Real(42.0)), zero);
    load.contact_radius = sqrt(contact.effective_radius * larger(contact.overlap, zero));
    return load;
  }

  /// m, gap at which the potential ends.
  double reach(const Constants<double>&, const Encounter& e) const {
    return (std::pow(2.0, 1.0 / 6.0) - 1) * e.distance;
  }
  double enter(const Constants<double>& c, const Encounter& e) const { return reach(c, e); }

  /// Of an oscillation with the stiffness at the closest approach, where (d/X)^6 = 1/2 + sqrt(m_eff v^2/(2 eps)).
  static double duration(const Constants<double>& c, const Encounter& e) {
    const double six = 0.5 + std::sqrt(0.5 * e.mass * e.speed * e.speed / c.energy), at = std::cbrt(six);
    const double stiffness = c.energy * six * at * (156 * six - 42) / (e.distance * e.distance);
    return std::min(std::numbers::pi * std::sqrt(e.mass / std::max(stiffness, 1e-300)),
                    c.damping_rate > 0 ? std::numbers::pi / c.damping_rate : infinity);
  }
};

}  // namespace silt
