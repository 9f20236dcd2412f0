#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/hertz.hpp"

namespace silt {

/// Elastic, perfectly plastic spheres (7.18, 7.25-7.29), Thornton 1997: Hertz up to x_y, plastic loading beyond, a
/// flatter Hertz contact of radius R_ul back and again.
///
/// The yield pressure p_y of a pair is the smaller of its materials'; one without is elastic.
struct Thornton {
  static constexpr const char* name = "thornton";
  static constexpr ModelNote note{"(7.18), (7.25-7.29)", "Thornton 1997",
                                  "F = k x^1.5 up to x_y = R_eff (pi p_y/(2 E_eff))^2; loading beyond: k x_y^1.5 + pi "
                                  "p_y R_eff (x - x_y); unloading and reloading: k_ul (x - x_p)^1.5, k_ul = 4/3 E_eff "
                                  "sqrt(R_ul), R_ul = R_eff k x_max^1.5/F_max, x_p = x_max - (F_max/k_ul)^(2/3)",
                                  "e = 1 below v_y, above (6 sqrt3/5)^0.5 [1 - (v_y/v)^2/6]^0.5 [(v_y/v)/((v_y/v) + 2 "
                                  "sqrt(6/5 - (v_y/v)^2/5))]^0.25"};
  static constexpr bool extended = false, hertzian = true, hertz_spring = false;
  void options(OptionGroup&) {}

  /// What decides the energy lost in place of the restitution; null where the restitution does.
  const char* loss() const { return "the yield pressure"; }

  template <class Real>
  struct Constants {
    Real stiffness;  ///< Pa, 4/3 E_eff
    Real yield;      ///< -, x_y/R_eff
    Real plastic;    ///< Pa, pi p_y
  };
  Constants<double> constants(const PairProperties& pair) const {
    // Beyond x_y = R_eff nothing yields.
    const double share = std::min(std::numbers::pi * pair.yield_pressure / (2 * pair.effective_young), 1.0);
    return {4.0 / 3.0 * pair.effective_young, share * share, share * 2 * pair.effective_young};
  }

  template <class Real>
  struct History {
    Real deepest;  ///< m, x_max of this contact so far
  };

  template <class Real>
  static SILT_INLINE NormalLoad<Real> load(const Contact<Real>& contact, const Constants<Real>& c,
                                           History<Real>& history) {
    NormalLoad<Real> load;
    const Real zero(0.0), least(1e-300), overlap = larger(contact.overlap, zero);
    history.deepest = select(overlap > zero, larger(history.deepest, overlap), zero);
    const Real radius = contact.effective_radius, k = c.stiffness * sqrt(radius), yield = c.yield * radius;
    const Real deepest = larger(history.deepest, yield);  // a contact that has not yielded unloads as Hertz
    const Real peak = k * yield * sqrt(yield) + c.plastic * radius * (deepest - yield);
    const Real flat = radius * k * deepest * sqrt(deepest) / larger(peak, least);  // R_ul
    const Real unloading = c.stiffness * sqrt(flat);
    const Real root = cbrt(peak / larger(unloading, least));
    const auto yielded = history.deepest > yield;
    const Real depth = select(yielded, larger(overlap - deepest + root * root, zero), overlap);
    load.contact_radius = sqrt(select(yielded, flat, radius) * depth);
    const Real slope = c.stiffness * load.contact_radius;
    load.force = slope * depth;
    load.stiffness =
        select(overlap >= history.deepest, select(yielded, c.plastic * radius, Real(1.5) * slope), Real(1.5) * slope);
    load.damping = zero;
    return load;
  }

  /// The shorter of an elastic collision and of an oscillation on the steepest unloading curve of this impact.
  static double duration(const Constants<double>& c, const Encounter& e) {
    const double k = c.stiffness * std::sqrt(e.radius), yield = c.yield * e.radius;
    const double elastic = hertz_duration(k, e.mass, e.speed);
    const double energy = 0.5 * e.mass * e.speed * e.speed - 0.4 * k * std::pow(yield, 2.5);
    if (energy <= 0) return elastic;
    const double first = k * std::pow(yield, 1.5), slope = c.plastic * e.radius;
    const double beyond = (std::sqrt(first * first + 2 * slope * energy) - first) / slope;
    const double peak = first + slope * beyond, flat = e.radius * k * std::pow(yield + beyond, 1.5) / peak;
    const double unloading = c.stiffness * std::sqrt(flat);
    const double steepest = 1.5 * unloading * std::cbrt(peak / unloading);
    return std::min(elastic, std::numbers::pi * std::sqrt(e.mass / steepest));
  }
};

}  // namespace silt
