#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/adhesion/bessel.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Attraction of particles that float at a fluid interface (7.58-7.64), Nicolson 1949, Q their capillary charges. theta
/// is the contact angle, beta the filling angle, d the diameter, r the distance of the centres. Walls do not attract.
struct Interfacial {
  static constexpr const char* name = "nicolson";
  static constexpr ModelNote note{
      "(7.58-7.64)", "Nicolson 1949",
      "F = -2 pi sigma Q_i Q_j q K1(q r), q = sqrt(g drho/sigma), Q = tan(theta - beta)/(q K1(q d sin(beta)/2)); small "
      "Bond number: F = -2 pi sigma Q_i Q_j/r, Q = d/2 sin(beta) tan(theta - beta)",
      "both forms agree as q d -> 0; pi sigma d^2 sin^2(beta) tan^2(theta - beta)/(2 r)"};
  static constexpr bool extended = true;
  std::optional<double> surface_tension, contact_angle, filling_angle, density_difference, cutoff;
  double gravity = 9.81;
  bool small_bond = false;
  void options(OptionGroup& option) {
    option("surface_tension", surface_tension, "N/m", "sigma of the interface", positive);
    option("contact_angle", contact_angle, "degrees", "theta", between(0, 180));
    option("filling_angle", filling_angle, "degrees", "beta", Range{0, 180, true, true});
    option("density_difference", density_difference, "kg/m3", "of the two fluids", positive);
    option("gravity", gravity, "m/s2", "g", positive);
    option("small_bond", small_bond, "the limit of a small Bond number, without density_difference");
    option("cutoff", cutoff, "m", "distance of the centres at which the attraction ends; has no default", positive);
  }
  void check() const {
    for (const auto& [value, given] :
         {std::pair{"surface_tension", surface_tension.has_value()},
          std::pair{"contact_angle", contact_angle.has_value()}, std::pair{"filling_angle", filling_angle.has_value()},
          std::pair{"cutoff", cutoff.has_value()}})
      if (!given) throw UserError(std::string("-interfacial_type nicolson needs -interfacial_") + value);
    if (density_difference.has_value() == small_bond)
      throw UserError(
          "-interfacial_type nicolson needs one of -interfacial_density_difference (kg/m3) and "
          "-interfacial_small_bond");
  }

  template <class Real>
  struct Constants {
    Real strength;  ///< N/m, 2 pi sigma
    Real inverse;   ///< 1/m, q; 0 for the limit of a small Bond number
    Real slope;     ///< -, tan(theta - beta)
    Real ring;      ///< -, sin(beta)
    Real cutoff;    ///< m
  };
  Constants<double> constants(const PairProperties&) const {
    const double degree = std::numbers::pi / 180;
    return {2 * std::numbers::pi * *surface_tension,
            small_bond ? 0 : std::sqrt(gravity * *density_difference / *surface_tension),
            std::tan((*contact_angle - *filling_angle) * degree), std::sin(*filling_angle * degree), *cutoff};
  }
  template <class Real>
  struct History {};

  template <class Real>
  static SILT_INLINE Real force(const Contact<Real>& contact, const Constants<Real>& c, const History<Real>&) {
    const Real zero(0.0), one(1.0), least(1e-300);
    const Real inverse_other = one / contact.effective_radius - one / contact.radius;
    const auto particles = inverse_other > zero;
    const Real other = one / select(particles, inverse_other, one);
    const auto bond = c.inverse > zero;
    const Real q = larger(c.inverse, least);
    // q K1(q x), which is 1/x where q x is small.
    const auto field = [&](Real x) { return select(bond, q * bessel_k1(select(bond, q * x, one)), one / x); };
    const Real charge = c.slope / field(contact.radius * c.ring), other_charge = c.slope / field(other * c.ring);
    const Real full = zero - c.strength * charge * other_charge * field(contact.distance);
    return select(particles, select(contact.distance < c.cutoff, full, zero), zero);
  }
  /// m, gap at which the cut-off is reached.
  double reach(const Constants<double>& c, const Encounter& e) const { return std::max(0.0, c.cutoff - e.distance); }
  double enter(const Constants<double>& c, const Encounter& e) const { return reach(c, e); }
};

}  // namespace silt
