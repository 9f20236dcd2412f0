#pragma once
#include <cmath>
#include <numbers>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Partially latching spring (7.17, 7.19-7.24), Walton & Braun 1986: stiffer back and again than on first loading; x_f
/// is the residual deformation.
///
/// The unloading stiffness is given; or it follows from the pair's restitution; or it grows with the largest force
/// (7.22), and then the restitution falls with the speed (7.23 as derived; the print lacks the plus sign).
struct WaltonBraun {
  static constexpr const char* name = "walton_braun";
  static constexpr ModelNote note{
      "(7.17), (7.19-7.24)", "Walton & Braun 1986",
      "F = k_l x loading, k_ul (x - x_f) unloading and reloading, never below 0; x_f = x_max (1 - k_l/k_ul); k_ul "
      "given, or k_l/e^2, or k_l + s F_max",
      "e = sqrt(k_l/k_ul), x_f = v sqrt(m_eff/k_l)(1 - k_l/k_ul), duration (pi/2)(sqrt(m_eff/k_l) + sqrt(m_eff/k_ul)); "
      "variable: e = (1 + s v sqrt(m_eff/k_l))^-1/2"};
  static constexpr bool extended = false, hertzian = false, hertz_spring = false;
  std::optional<double> stiffness, unloading_stiffness, hardening;

  void options(OptionGroup& option) {
    option("stiffness", stiffness, "N/m", "loading stiffness k_l; needed by walton_braun", positive);
    option("unloading_stiffness", unloading_stiffness, "N/m", "k_ul; default: k_l/e^2", positive);
    option("hardening", hardening, "1/m", "s in k_ul = k_l + s F_max, in place of unloading_stiffness", positive);
  }
  void check() const {
    if (!stiffness) throw UserError("-normal_type walton_braun needs -normal_stiffness (N/m, positive)");
    if (unloading_stiffness && hardening)
      throw UserError("-normal_unloading_stiffness and -normal_hardening exclude each other");
    if (unloading_stiffness && *unloading_stiffness < *stiffness)
      throw UserError("-normal_unloading_stiffness must not be below -normal_stiffness: the contact would gain energy");
  }

  /// What decides the energy lost in place of the restitution; null where the restitution does.
  const char* loss() const {
    return unloading_stiffness ? "-normal_unloading_stiffness" : hardening ? "-normal_hardening" : nullptr;
  }

  template <class Real>
  struct Constants {
    Real loading;    ///< N/m, k_l
    Real unloading;  ///< N/m, k_ul at no overlap
    Real hardening;  ///< N/m2, k_ul = unloading + hardening x_max
  };
  Constants<double> constants(const PairProperties& pair) const {
    const double given = unloading_stiffness.value_or(*stiffness / (pair.restitution * pair.restitution));
    return {*stiffness, hardening ? *stiffness : given, hardening.value_or(0) * *stiffness};
  }

  template <class Real>
  struct History {
    Real deepest;  ///< m, x_max of this contact so far
  };

  template <class Real>
  static SILT_INLINE NormalLoad<Real> load(const Contact<Real>& contact, const Constants<Real>& c,
                                           History<Real>& history) {
    NormalLoad<Real> load;
    const Real zero(0.0), one(1.0), overlap = larger(contact.overlap, zero);
    history.deepest = select(overlap > zero, larger(history.deepest, overlap), zero);
    const Real unloading = c.unloading + c.hardening * history.deepest;
    const Real residual = history.deepest * (one - c.loading / unloading);
    const Real virgin = c.loading * overlap, back = unloading * (overlap - residual);
    load.force = larger(smaller(virgin, back), zero);
    load.stiffness = select(overlap >= history.deepest, c.loading, select(back > zero, unloading, zero));
    load.damping = zero;
    load.contact_radius = sqrt(contact.effective_radius * overlap);
    return load;
  }

  /// Of an oscillation on the unloading line, the stiffest part.
  static double duration(const Constants<double>& c, const Encounter& e) {
    const double deepest = e.speed * std::sqrt(e.mass / c.loading);
    return std::numbers::pi * std::sqrt(e.mass / (c.unloading + c.hardening * deepest));
  }
};

}  // namespace silt
