#pragma once
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Lubrication: the fluid that two near surfaces squeeze out of their gap, or draw into it, resists (Reynolds 1886; the
/// leading term of Jeffrey & Onishi 1984, less its value at the outer gap h_o as in Nguyen & Ladd 2002, because drag
/// laws know of what is further away); h counts not below the least gap, the height of the roughness. Without `shifted`
/// the term 1/h_o is left out, and the force begins with a jump. Both gaps are given as lengths or as shares of R_eff.
struct SqueezeFilm {
  static constexpr const char* name = "squeeze";
  static constexpr ModelNote note{"", "Reynolds 1886; Jeffrey & Onishi 1984; Nguyen & Ladd 2002",
                                  "F = 6 pi mu R_eff^2 (dx/dt) (1/h - 1/h_o) for h < h_o, h not below the least gap",
                                  "speed lost on the way from gap to gap, 6 pi mu R_eff^2/m_eff [ln(h_1/h_2) - (h_1 - "
                                  "h_2)/h_o]; sinking to a wall"};
  static constexpr bool extended = false;
  std::optional<double> viscosity, outer_gap, least_gap, outer_share, least_share;
  bool shifted = true;
  void options(OptionGroup& option) {
    option("viscosity", viscosity, "Pa s", "mu of the fluid between the particles; default: that of -fluid_viscosity",
           positive);
    option("outer_gap", outer_gap, "m", "h_o, gap at which the force begins", positive);
    option("outer_share", outer_share, "-", "h_o over R_eff, in place of outer_gap; default: 0.5", positive);
    option("least_gap", least_gap, "m", "the force is that of this gap at smaller ones and in contact", positive);
    option("least_share", least_share, "-", "least gap over R_eff, in place of least_gap; default: 1e-3", positive);
    option("shifted", shifted, "the force is less by its value at the outer gap, so that it begins without a jump");
  }
  void check() const {
    if (!viscosity) throw UserError("-lubrication_type squeeze needs -lubrication_viscosity (Pa s), or a fluid");
    if (outer_gap && outer_share)
      throw UserError("-lubrication_outer_gap and -lubrication_outer_share are both given: give one");
    if (least_gap && least_share)
      throw UserError("-lubrication_least_gap and -lubrication_least_share are both given: give one");
    const bool lengths = outer_gap && least_gap, shares = !outer_gap && !least_gap;
    if ((lengths && *least_gap >= *outer_gap) ||
        (shares && least_share.value_or(default_least) >= outer_share.value_or(default_outer)))
      throw UserError("the least gap of -lubrication_type squeeze must be smaller than its outer gap");
  }
  static constexpr double default_outer = 0.5, default_least = 1e-3;

  template <class Real>
  struct Constants {
    Real viscosity;           ///< Pa s, 6 pi mu
    Real outer, outer_share;  ///< h_o = outer + outer_share R_eff, m
    Real least, least_share;  ///< as those
    Real shift;               ///< 1 when shifted, else 0
  };
  Constants<double> constants(const PairProperties&) const {
    return {6 * std::numbers::pi * viscosity.value_or(0),        outer_gap.value_or(0),
            outer_gap ? 0 : outer_share.value_or(default_outer), least_gap.value_or(0),
            least_gap ? 0 : least_share.value_or(default_least), shifted ? 1.0 : 0.0};
  }
  template <class Real>
  struct History {};

  template <class Real>
  static SILT_INLINE Real force(const Contact<Real>& contact, const Constants<Real>& c, const History<Real>&) {
    const Real zero(0.0), one(1.0), radius = contact.effective_radius, gap = zero - contact.overlap;
    const Real outer = c.outer + c.outer_share * radius, near = larger(gap, c.least + c.least_share * radius);
    const Real full = c.viscosity * radius * radius * contact.approach * (one / near - c.shift / outer);
    return select(near < outer, full, zero);
  }
  double reach(const Constants<double>& c, const Encounter& e) const { return c.outer + c.outer_share * e.radius; }
  double enter(const Constants<double>& c, const Encounter& e) const { return reach(c, e); }
  /// kg/s, largest coefficient of the speed.
  static double damping(const Constants<double>& c, const Encounter& e) {
    return c.viscosity * e.radius * e.radius / (c.least + c.least_share * e.radius);
  }
};

}  // namespace silt
