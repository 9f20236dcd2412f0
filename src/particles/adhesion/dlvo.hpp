#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "base/physical_constants.hpp"
#include "particles/adhesion/dlvo_forces.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// What the parts of the DLVO force share: the gap below which they no longer grow, and where they end.
struct DlvoRange {
  double least_gap = 0.4e-9;
  std::optional<double> cutoff;
  void options(OptionGroup& option) {
    option("least_gap", least_gap, "m", "the force is constant at smaller gaps and in contact", positive);
    option("cutoff", cutoff, "m", "gap at which the force ends; default: where each part is 1e-4 of its peak",
           positive);
  }
  void check() const {
    if (cutoff && *cutoff <= least_gap) throw UserError("-dlvo_cutoff must be larger than -dlvo_least_gap");
  }
};

/// Van der Waals attraction (7.45-7.46), Hamaker 1937; the Hamaker constant belongs to the pair of materials.
struct VdwDlvo {
  static constexpr const char* name = "vdw";
  static constexpr ModelNote note{
      "(7.45-7.46)", "Hamaker 1937",
      "F = -32/3 A r R_i^3 R_j^3/((r^2 - (R_i + R_j)^2)^2 (r^2 - (R_i - R_j)^2)^2), constant below the least gap",
      "-dU/dr of the potential by dual numbers; -A R/(12 h^2) near, wall -2/3 A R^3/(h^2 (2 R + h)^2)"};
  static constexpr bool extended = true;
  DlvoRange range;
  void options(OptionGroup& option) { range.options(option); }
  void check() const { range.check(); }

  template <class Real>
  struct Constants {
    Real hamaker, least_gap, cutoff;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {pair.hamaker, range.least_gap, range.cutoff.value_or(100 * range.least_gap)};
  }
  template <class Real>
  struct History {};

  template <class Real>
  static SILT_INLINE Real force(const Contact<Real>& contact, const Constants<Real>& c, const History<Real>&) {
    const Real zero(0.0), gap = zero - contact.overlap;
    const Real other = Real(1.0) / contact.effective_radius - Real(1.0) / contact.radius;
    const Real full = hamaker_force(c.hamaker, larger(gap, c.least_gap), contact.radius, other);
    return select(gap < c.cutoff, full, zero);
  }
  double reach(const Constants<double>& c, const Encounter&) const { return c.hamaker != 0 ? c.cutoff : 0; }
  double enter(const Constants<double>& c, const Encounter& e) const { return reach(c, e); }
};

/// Repulsion (or attraction of unlike surfaces) of double layers (7.47); the surface potentials belong to the
/// materials.
struct ElectrostaticDlvo {
  static constexpr const char* name = "electrostatic";
  static constexpr ModelNote note{"(7.47)", "Hogg, Healy & Fuerstenau 1966",
                                  "F = 4 pi eps R_eff kappa psi0^2 e/(1 + e), e = exp(-kappa h); unlike potentials: 2 "
                                  "pi eps R_eff kappa e (2 psi_i "
                                  "psi_j - (psi_i^2 + psi_j^2) e)/(1 - e^2)",
                                  "-dU/dh of 2 pi eps R psi0^2 ln(1 + exp(-kappa h)) by dual numbers"};
  static constexpr bool extended = true;
  DlvoRange range;
  double relative_permittivity = 78.4, temperature = 298.15;
  std::optional<double> debye_length, ionic_strength;
  void options(OptionGroup& option) {
    range.options(option);
    option("relative_permittivity", relative_permittivity, "-", "of the liquid; default: water at 298 K", positive);
    option("debye_length", debye_length, "m", "thickness 1/kappa of the double layer", positive);
    option("ionic_strength", ionic_strength, "mol/m3", "of the liquid, in place of debye_length", positive);
    option("temperature", temperature, "K", "of the liquid, for the ionic strength", positive);
  }
  void check() const {
    range.check();
    if (debye_length.has_value() == ionic_strength.has_value())
      throw UserError(
          "the electrostatic part of -dlvo_type needs one of -dlvo_debye_length (m) and -dlvo_ionic_strength (mol/m3), "
          "not both");
  }
  double permittivity() const { return relative_permittivity * vacuum_permittivity; }
  /// 1/kappa = sqrt(eps k_B T/(2 e^2 N_A I)). m
  double length() const {
    if (debye_length) return *debye_length;
    return std::sqrt(permittivity() * boltzmann_constant * temperature /
                     (2 * elementary_charge * elementary_charge * avogadro_constant * *ionic_strength));
  }

  template <class Real>
  struct Constants {
    Real permittivity;  ///< F/m, 2 pi eps
    Real product;       ///< V2, psi_i psi_j
    Real squares;       ///< V2, psi_i^2 + psi_j^2
    Real inverse_length, least_gap, cutoff;
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {2 * std::numbers::pi * permittivity(),
            pair.potential_product,
            pair.potential_squares,
            1 / length(),
            range.least_gap,
            range.cutoff.value_or(range.least_gap + 10 * length())};
  }
  template <class Real>
  struct History {};

  template <class Real>
  static SILT_INLINE Real force(const Contact<Real>& contact, const Constants<Real>& c, const History<Real>&) {
    const Real zero(0.0), gap = zero - contact.overlap;
    const Real full = double_layer_force(c.permittivity, c.product, c.squares, c.inverse_length,
                                         larger(gap, c.least_gap), contact.effective_radius);
    return select(gap < c.cutoff, full, zero);
  }
  double reach(const Constants<double>& c, const Encounter&) const { return c.squares > 0 ? c.cutoff : 0; }
  double enter(const Constants<double>& c, const Encounter& e) const { return reach(c, e); }
};

/// The sum of both (7.45-7.48), with the barrier and the minima that come of it.
struct FullDlvo {
  static constexpr const char* name = "full";
  static constexpr ModelNote note{"(7.45-7.48)", "Derjaguin & Landau 1941; Verwey & Overbeek 1948",
                                  "the sum of vdw and electrostatic",
                                  "barrier of 23.31 kT at 2.14 nm (R 50 nm, A 1e-20 J, 30 mV, 1 mol/m3)"};
  static constexpr bool extended = true;
  ElectrostaticDlvo layer;
  void options(OptionGroup& option) { layer.options(option); }
  void check() const { layer.check(); }
  template <class Real>
  struct Constants {
    VdwDlvo::Constants<Real> vdw;
    ElectrostaticDlvo::Constants<Real> layer;
  };
  Constants<double> constants(const PairProperties& pair) const {
    Constants<double> c{VdwDlvo{layer.range}.constants(pair), layer.constants(pair)};
    c.vdw.cutoff = c.layer.cutoff = std::max(c.vdw.cutoff, c.layer.cutoff);
    return c;
  }
  template <class Real>
  struct History {};
  template <class Real>
  static SILT_INLINE Real force(const Contact<Real>& contact, const Constants<Real>& c, const History<Real>&) {
    return VdwDlvo::force<Real>(contact, c.vdw, {}) + ElectrostaticDlvo::force<Real>(contact, c.layer, {});
  }
  double reach(const Constants<double>& c, const Encounter&) const {
    return c.vdw.hamaker != 0 || c.layer.squares > 0 ? c.layer.cutoff : 0;
  }
  double enter(const Constants<double>& c, const Encounter& e) const { return reach(c, e); }
};

}  // namespace silt
