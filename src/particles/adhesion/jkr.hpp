#pragma once
#include <cmath>
#include <numbers>

#include "base/models.hpp"
#include "particles/adhesion/adhesion_options.hpp"
#include "particles/contact.hpp"
#include "particles/force_jump.hpp"
#include "particles/materials.hpp"
#include "particles/normal/hertz.hpp"

namespace silt {

/// Adhesion of soft spheres (7.49-7.50, 7.88-7.90), Johnson, Kendall & Roberts 1971, in the place of the Hertz spring:
/// F_c the pull-off force, g the surface energy of the pair (work of adhesion 2 g). The neck is made at touching and
/// breaks beyond it. The dissipation is that of the normal law.
struct Jkr {
  static constexpr const char* name = "jkr";
  static constexpr ModelNote note{
      "(7.49-7.50), (7.88-7.90)", "Johnson, Kendall & Roberts 1971; Thornton & Yin 1991",
      "F = 4 F_c [(a/a0)^3 - (a/a0)^1.5], x = a0^2/(2 R_eff) [2 (a/a0)^2 - 4/3 (a/a0)^0.5], F_c = 3 pi g R_eff, a0 = "
      "(9 pi "
      "g R_eff^2/E_eff)^(1/3); made at x = 0, broken at x = -a0^2/(2 6^(1/3) R_eff)",
      "pull-off 3 pi g R_eff; -(8/9) of it at x = 0, -(5/9) at the break; work 7.09 (w^5 R_eff^4/E_eff^2)^(1/3) lost a "
      "cycle, sticking speed"};
  static constexpr bool extended = false, jumps = true;
  AdhesionOptions shared;
  void options(OptionGroup& option) { shared.options(option); }

  template <class Real>
  struct Constants {
    Real spring;          ///< Pa, 4/3 E_eff
    Real pull_off;        ///< N/m, F_c/R_eff
    Real neck;            ///< m^(1/3), a0/R_eff^(2/3)
    Real friction_share;  ///< -, of F_c in the load that limits friction
  };
  Constants<double> constants(const PairProperties& pair) const {
    const double g = std::numbers::pi * pair.surface_energy;
    return {4.0 / 3.0 * pair.effective_young, 3 * g, std::cbrt(9 * g / pair.effective_young), shared.friction_share()};
  }

  template <class Real>
  struct History {
    Real made;  ///< 1 while the neck holds
  };

  /// u, the root of a/a0, from y, the overlap x over a0^2/(2 R_eff): u^4 - 2/3 u = y/2, solved in closed form by
  /// u = (w + sqrt(4/(3 w) - w^2))/2 with w^2 the real root of z^3 + 2 y z = 4/9.
  template <class Real>
  static SILT_INLINE Real root_of_neck(Real y) {
    // z = s - t with s t = 2 y/3 and s^3 - t^3 = 4/9 (Cardano), written without the difference.
    const Real third = Real(2.0 / 3.0) * y, zero(0.0), half(0.5);
    const Real s = cbrt(Real(2.0 / 9.0) + sqrt(larger(third * third * third + Real(4.0 / 81.0), zero)));
    const Real t = third / s;
    const Real w = sqrt(Real(4.0 / 9.0) / (s * s + third + t * t));
    return half * (w + sqrt(larger(Real(4.0 / 3.0) / w - w * w, zero)));
  }

  template <class Real>
  static SILT_INLINE void adhere(const Contact<Real>& contact, const Constants<Real>& c, History<Real>& history,
                                 NormalLoad<Real>& load, Real& pull) {
    const Real zero(0.0), one(1.0), radius = contact.effective_radius, x = contact.overlap;
    const Real size = c.neck * cbrt(radius * radius);                        // a0
    const Real square = larger(size * size, Real(1e-20) * radius * radius);  // without surface energy: Hertz
    const Real y = Real(2.0) * radius * x / square;
    const Real least(-0.5503212081491045);  // -6^(-1/3), where the neck breaks
    const Real before = history.made;
    history.made = select(x >= zero, one, select(y < least, zero, before));
    const auto holds = history.made > zero;
    const Real u = root_of_neck(larger(y, least));
    const Real a = sqrt(square) * u * u, cube = u * u * u, pull_off = c.pull_off * radius;
    const Real neck = c.spring * a * a * a / radius - Real(4.0) * pull_off * cube;
    const Real deep = larger(x, zero), hertz = hertz_reading(contact, c.spring, deep, sqrt(radius * deep));
    const Real net = load.force - hertz + select(holds, neck, zero);
    load.contact_radius = select(holds, a, zero);
    load.pull_off = select(holds, pull_off, zero);
    // dF/da over dx/da; the slope is infinite at the break and is bounded there.
    const Real rise = Real(3.0) * c.spring * a * a / radius - Real(6.0) * pull_off * cube / a;
    const Real widen = Real(2.0) * a / radius * larger(one - Real(1.0 / 6.0) / cube, Real(0.05));
    load.stiffness = select(holds, rise / widen, zero);
    split_load(load, net, c.friction_share, pull);
    // It is made with -(8/9) F_c and breaks at -(5/9) F_c, within a step.
    const Real past = select(holds, x, Real(0.5) * square / radius * (least - y));
    const Real jump =
        Real(-8.0 / 9.0) * larger(history.made - before, zero) + Real(5.0 / 9.0) * larger(before - history.made, zero);
    pull = pull + made_good(jump * pull_off, past, magnitude(contact.approach), contact.dt);
  }

  /// m, gap to which a neck stretches.
  double reach(const Constants<double>& c, const Encounter& e) const {
    const double size = c.neck * std::cbrt(e.radius * e.radius);
    return size * size / (2 * std::cbrt(6.0) * e.radius);
  }
  /// Slope of the force where it vanishes, 6/5 E_eff a0. N/m
  static double stiffness(const Constants<double>& c, const Encounter& e) {
    return 1.2 * 0.75 * c.spring * c.neck * std::cbrt(e.radius * e.radius);
  }
};

}  // namespace silt
