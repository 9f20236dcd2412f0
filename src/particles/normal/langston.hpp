#pragma once
#include <cmath>
#include <numbers>

#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/force_jump.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Contact spring from a continuous potential (7.4-7.6), Langston, Tuzun & Heyes 1994. X is the distance of the
/// centres, d the sum of the radii (at a wall: the distance to it, and R_i), m the effective mass, beta the damping
/// ratio.
struct Langston {
  static constexpr const char* name = "langston";
  static constexpr ModelNote note{
      "(7.4-7.6)", "Langston, Tuzun & Heyes 1994",
      "F = k(X) x + 2 beta sqrt(m k) dx/dt, k = f'' = m g (c + 1) d^(c+1)/X^(c+2) of the potential f = m g (d/c) "
      "(d/X)^c, m = m_eff",
      "k = m g (c + 1)/d at X = d; restitution exp(-pi beta/sqrt(1 - beta^2)) of soft contacts"};
  static constexpr bool extended = true, hertzian = false, hertz_spring = false, jumps = true;
  double exponent = 36, gravity = 9.81, damping_ratio = 0.05;
  void options(OptionGroup& option) {
    option("exponent", exponent, "-", "c of the potential", at_least(1));
    option("gravity", gravity, "m/s2", "g, which with the mass sets the scale of the potential", positive);
    option("damping_ratio", damping_ratio, "-", "beta, damping as a share of critical", non_negative);
  }
  /// What decides the energy lost in place of the restitution; null where the restitution does.
  const char* loss() const { return "-normal_damping_ratio"; }

  template <class Real>
  struct Constants {
    Real exponent, gravity, damping_ratio;
  };
  Constants<double> constants(const PairProperties&) const { return {exponent, gravity, damping_ratio}; }
  template <class Real>
  using History = Meeting<Real>;

  template <class Real>
  static SILT_INLINE NormalLoad<Real> load(const Contact<Real>& contact, const Constants<Real>& c,
                                           History<Real>& history) {
    NormalLoad<Real> load;
    const Real zero(0.0), one(1.0), overlap = larger(contact.overlap, zero), inverse = one / contact.distance;
    const auto touches = overlap > zero;
    const Real power = exp((c.exponent + one) * log((contact.distance + overlap) * inverse));
    const Real k = contact.effective_mass * c.gravity * (c.exponent + one) * power * inverse;
    const Real damping = Real(2.0) * c.damping_ratio * sqrt(contact.effective_mass * k);
    load.damping = select(touches, damping, zero);
    load.force = select(touches, k * overlap + load.damping * contact.approach, zero);
    load.stiffness = select(touches, k * (one + (c.exponent + Real(2.0)) * overlap * inverse), zero);
    load.jump = jump_at_meeting(contact, contact.overlap, damping * contact.approach, history);
    load.contact_radius = sqrt(contact.effective_radius * overlap);
    return load;
  }

  /// At the largest overlap of the impact, from the energy of the spring (by bisection).
  static double duration(const Constants<double>& c, const Encounter& e) {
    const auto stiffness = [&](double x) {
      const double distance = e.distance - x;
      const double k =
          e.mass * c.gravity * (c.exponent + 1) * std::pow(e.distance / distance, c.exponent + 1) / distance;
      return k * (1 + (c.exponent + 2) * x / distance);
    };
    double low = 0, high = 0.9 * e.distance;
    for (int n = 0; n < 60; ++n) {
      const double x = 0.5 * (low + high);
      double energy = 0;  // work of the spring up to x
      for (int s = 0; s < 64; ++s) {
        const double at = x * (s + 0.5) / 64, distance = e.distance - at;
        energy += e.mass * c.gravity * (c.exponent + 1) * std::pow(e.distance / distance, c.exponent + 1) / distance *
                  at * x / 64;
      }
      (energy < 0.5 * e.mass * e.speed * e.speed ? low : high) = x;
    }
    return std::numbers::pi * std::sqrt(e.mass / stiffness(high));
  }
};

}  // namespace silt
