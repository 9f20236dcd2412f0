#pragma once
#include "particles/adhesion/dmt.hpp"
#include "particles/adhesion/jkr.hpp"
#include "particles/adhesion/tabor.hpp"

namespace silt {

/// Dmt for a pair of materials whose Tabor parameter (7.53) is below 0.1 for all its sizes, Jkr for all others.
struct AutomaticAdhesion {
  static constexpr const char* name = "auto";
  static constexpr ModelNote note{
      "(7.53)", "Tabor 1977", "dmt where mu_T = (4 R_eff g^2/(E_eff^2 D^3))^(1/3) < 0.1, else jkr (a notice below 3)",
      "takes dmt and jkr on their sides"};
  static constexpr bool extended = false, jumps = true;
  AdhesionOptions shared;
  void options(OptionGroup& option) { shared.options(option); }

  template <class Real>
  struct Constants {
    Jkr::Constants<Real> soft;
    Dmt::Constants<Real> hard;
    Real is_hard;
  };
  Constants<double> constants(const PairProperties& pair) const {
    const double tabor =
        tabor_parameter(pair.largest_radius, pair.surface_energy, pair.effective_young, shared.distance);
    return {Jkr{shared}.constants(pair), Dmt{shared}.constants(pair), tabor < tabor_hard ? 1.0 : 0.0};
  }
  template <class Real>
  struct History {
    Jkr::History<Real> soft;
    Dmt::History<Real> hard;
  };

  template <class Real>
  static SILT_INLINE void adhere(const Contact<Real>& contact, const Constants<Real>& c, History<Real>& history,
                                 NormalLoad<Real>& load, Real& pull) {
    NormalLoad<Real> hard = load;
    Real hard_pull;
    Dmt::adhere(contact, c.hard, history.hard, hard, hard_pull);
    Jkr::adhere(contact, c.soft, history.soft, load, pull);
    const auto is_hard = c.is_hard > Real(0.0);
    load.force = select(is_hard, hard.force, load.force);
    load.contact_radius = select(is_hard, hard.contact_radius, load.contact_radius);
    load.stiffness = select(is_hard, hard.stiffness, load.stiffness);
    load.pull_off = select(is_hard, hard.pull_off, load.pull_off);
    pull = select(is_hard, hard_pull, pull);
  }
  double reach(const Constants<double>& c, const Encounter& e) const {
    return c.is_hard > 0 ? 0 : Jkr{shared}.reach(c.soft, e);
  }
  static double stiffness(const Constants<double>& c, const Encounter& e) {
    return c.is_hard > 0 ? 0 : Jkr::stiffness(c.soft, e);
  }
};

}  // namespace silt
