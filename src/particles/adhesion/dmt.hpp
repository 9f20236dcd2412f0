#pragma once
#include <cmath>
#include <numbers>

#include "base/models.hpp"
#include "particles/adhesion/adhesion_options.hpp"
#include "particles/contact.hpp"
#include "particles/force_jump.hpp"
#include "particles/materials.hpp"

namespace silt {

/// Adhesion of hard spheres (7.51-7.52), Derjaguin, Muller & Toporov 1975, with the spring and the dissipation of the
/// normal law; g the surface energy of the pair.
struct Dmt {
  static constexpr const char* name = "dmt";
  static constexpr ModelNote note{"(7.51-7.52)", "Derjaguin, Muller & Toporov 1975; Thornton & Yin 1991",
                                  "F = k x^1.5 - 4 pi g R_eff, a = sqrt(R_eff x)",
                                  "pull-off 4 pi g R_eff; no energy lost a cycle without damping"};
  static constexpr bool extended = false, jumps = true;
  AdhesionOptions shared;
  void options(OptionGroup& option) { shared.options(option); }

  template <class Real>
  struct Constants {
    Real pull_off;        ///< N/m, F_c/R_eff
    Real friction_share;  ///< -, of F_c in the load that limits friction
  };
  Constants<double> constants(const PairProperties& pair) const {
    return {4 * std::numbers::pi * pair.surface_energy, shared.friction_share()};
  }
  template <class Real>
  using History = Meeting<Real>;

  template <class Real>
  static SILT_INLINE void adhere(const Contact<Real>& contact, const Constants<Real>& c, History<Real>& history,
                                 NormalLoad<Real>& load, Real& pull) {
    const Real zero(0.0), pull_off = c.pull_off * contact.effective_radius;
    load.pull_off = select(contact.overlap > zero, pull_off, zero);
    split_load(load, load.force - load.pull_off, c.friction_share, pull);
    pull = pull + jump_at_meeting(contact, contact.overlap, zero - pull_off, history);
  }
};

}  // namespace silt
