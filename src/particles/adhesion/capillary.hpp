#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Liquid bridges: capillary force (7.54-7.55), Maugis 1987 (the print lacks sigma), or Willett et al. 2000; viscous
/// force (7.57), Matthewson 1988, with the gap not below the roughness. A bridge forms on contact and breaks (7.56) as
/// in Lian et al. 1993 and Pitois et al. 2000, or as printed, or as in Willett et al. 2000; the capillary number Ca of
/// the speed of parting counts at most 1. liquid_exchange.hpp makes and breaks the bridges and keeps account of the
/// liquid.
struct CapillaryBridge {
  static constexpr const char* name = "capillary";
  static constexpr ModelNote note{
      "(7.54-7.57)", "Maugis 1987; Willett et al. 2000; Matthewson 1988; Lian et al. 1993; Pitois et al. 2000",
      "F = -4 pi R_eff sigma cos(theta) C + 6 pi mu R_eff^2 G^2 (dx/dt)/h, C = G = 1 - (1 + V/(pi R_eff h^2))^-0.5, 1 "
      "in contact, or Willett: C = 1/(1 + 1.05 s + 2.5 s^2), s = h (2 R_eff/V)^0.5; breaks at h = (1 + theta/2)(1 + "
      "sqrt(Ca)) V^(1/3), Ca = mu |v_n|/sigma, or with V/(4 R_eff^2) in place of V^(1/3), or Willett: V^(1/3) + 0.1 "
      "V^(2/3)/(2 R_eff)",
      "force and rupture distance of a pair drawn apart; figures of Willett et al.; liquid of films and bridges "
      "constant to round-off on any ranks"};
  static constexpr bool extended = false, jumps = true;
  std::optional<double> surface_tension, roughness, liquid_content;
  double contact_angle = 0, viscosity = 0;
  std::string force_law = "maugis", rupture = "lian";
  void options(OptionGroup& option) {
    option("surface_tension", surface_tension, "N/m", "sigma of the liquid", positive);
    option("contact_angle", contact_angle, "degrees", "theta", Range{0, 90, false, true});
    option("viscosity", viscosity, "Pa s", "mu of the liquid; 0: no viscous force", non_negative);
    option("roughness", roughness, "m", "least gap in the viscous force; needed with viscosity", positive);
    option("liquid_content", liquid_content, "-", "volume of the film of a new particle over the particle's volume",
           positive);
    option("force", force_law, {"maugis", "willett"},
           "capillary force over the gap: Maugis 1987 or Willett et al. 2000");
    option(
        "rupture", rupture, {"lian", "printed", "willett"},
        "distance at which a bridge breaks: with V^(1/3), or with V/(4 R_eff^2) as printed in the book, or Willett's");
  }
  void check() const {
    if (!surface_tension) throw UserError("-bridge_type capillary needs -bridge_surface_tension (N/m, positive)");
    if (!liquid_content)
      throw UserError(
          "-bridge_type capillary needs -bridge_liquid_content (volume of liquid over that of the particle)");
    if (viscosity > 0 && !roughness) throw UserError("-bridge_viscosity needs -bridge_roughness (m, positive)");
  }
  double theta() const { return contact_angle * std::numbers::pi / 180; }

  template <class Real>
  struct Constants {
    Real tension;    ///< N/m, 4 pi sigma cos(theta)
    Real viscosity;  ///< Pa s, 6 pi mu
    Real roughness;  ///< m
    Real willett;    ///< 1 for Willett's force, 0 for Maugis'
  };
  Constants<double> constants(const PairProperties&) const {
    return {4 * std::numbers::pi * *surface_tension * std::cos(theta()), 6 * std::numbers::pi * viscosity,
            roughness.value_or(1e-9), force_law == "willett" ? 1.0 : 0.0};
  }
  template <class Real>
  struct History {
    Real given_i, given_j;  ///< m3, liquid that the partners gave to the bridge; none where there is no bridge
    Real asked;             ///< in the step after touching, when the partners' offers are gathered: 1 and the share of
                            ///< a step since they touched
    Real jump;              ///< N, makes good that the bridge formed or broke within the step (force_jump.hpp)
  };

  template <class Real>
  static SILT_INLINE Real force(const Contact<Real>& contact, const Constants<Real>& c, const History<Real>& history) {
    const Real zero(0.0), one(1.0), radius = contact.effective_radius, volume = history.given_i + history.given_j;
    const Real gap = larger(zero - contact.overlap, Real(1e-9) * radius);
    const Real wide = volume / (Real(std::numbers::pi) * radius * gap * gap);
    const Real shape = select(contact.overlap >= zero, one, one - one / sqrt(one + wide));
    const Real viscous = c.viscosity * radius * radius * shape * shape * contact.approach / larger(gap, c.roughness);
    const Real s = larger(zero - contact.overlap, zero) * sqrt(Real(2.0) * radius / volume);
    const Real pull = select(c.willett > zero, one / (one + s * (Real(1.05) + Real(2.5) * s)), shape);
    return select(volume > zero, viscous - c.tension * radius * pull, zero) + history.jump;
  }

  /// m, gap at which a bridge of volume V between R_eff breaks, at the capillary number Ca.
  double rupture_distance(double volume, double radius, double capillary_number) const {
    const double length = std::cbrt(volume);
    const double size = rupture == "lian"      ? length
                        : rupture == "willett" ? length + 0.1 * length * length / (2 * radius)
                                               : volume / (4 * radius * radius);
    return (1 + theta() / 2) * (1 + std::sqrt(std::min(capillary_number, 1.0))) * size;
  }
  double capillary_number(double speed) const { return viscosity * std::abs(speed) / *surface_tension; }
  /// The share of its film that a particle gives to a bridge: the cap its partner sees (Shi & McCarthy 2008;
  /// docs/theory/particles.md); at a wall (no other radius) one half.
  static double film_share(double own, double other) {
    const double seen = other > 0 ? other / (own + other) : 1;
    return 0.5 * (1 - std::sqrt(1 - seen * seen));
  }
  double full_film(double radius) const {
    return *liquid_content * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  }
  /// Volume of the first bridge between new particles. m3
  double bridge_volume(const Encounter& e) const {
    const double other = e.distance > e.radius_i * (1 + 1e-12) ? e.distance - e.radius_i : 0;
    return film_share(e.radius_i, other) * full_film(e.radius_i) +
           (other > 0 ? film_share(other, e.radius_i) * full_film(other) : 0);
  }
  double reach(const Constants<double>&, const Encounter& e) const {
    return rupture_distance(bridge_volume(e), e.radius, viscosity > 0 ? 1 : 0);
  }
  /// N/m, steepest slope of Maugis' force, at touching; Willett's is nowhere steeper.
  double slope(const Constants<double>& c, const Encounter& e) const {
    return c.tension * e.radius * std::sqrt(std::numbers::pi * e.radius / bridge_volume(e));
  }
  /// kg/s, largest coefficient of the viscous force.
  static double damping(const Constants<double>& c, const Encounter& e) {
    return c.viscosity * e.radius * e.radius / c.roughness;
  }
};

}  // namespace silt
