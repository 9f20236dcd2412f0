#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/hertz.hpp"

namespace silt {

/// Viscoelastic spheres (7.15), Kuwabara & Kono 1987; gamma is given or by the material's relaxation time A
/// (Brilliantov et al. 1996). The restitution falls with the fifth root of the impact speed at low speeds.
struct KuwabaraKono {
  static constexpr const char* name = "kuwabara_kono";
  static constexpr ModelNote note{"(7.15)", "Kuwabara & Kono 1987; Brilliantov et al. 1996",
                                  "F = k x^1.5 + gamma x^0.5 dx/dt, k as of tsuji; gamma is given, or gamma = 3/2 A k",
                                  "restitutions .98854, .94426, .89215, .79755 of x'' = -x^1.5 - c x^0.5 x' for c = "
                                  ".01, .05, .1, .2, and 1 - e ~ v^(1/5)"};
  static constexpr bool extended = false, hertzian = true, hertz_spring = true;
  std::optional<double> root_damping, relaxation_time;
  bool no_attraction = false;

  void options(OptionGroup& option) {
    option("root_damping", root_damping, "kg/(s m^0.5)", "gamma, the dashpot coefficient over the root of the overlap",
           non_negative);
    option("relaxation_time", relaxation_time, "s", "A in gamma = 3/2 A k, in place of root_damping", non_negative);
    option("no_attraction", no_attraction, "clip the attractive last part of a damped collision");
  }
  void check() const {
    if (root_damping.has_value() == relaxation_time.has_value())
      throw UserError(
          "-normal_type kuwabara_kono needs one of -normal_root_damping (kg/(s m^0.5)) and -normal_relaxation_time "
          "(s), "
          "not both");
  }

  /// What decides the energy lost in place of the restitution; null where the restitution does.
  const char* loss() const { return root_damping ? "-normal_root_damping" : "-normal_relaxation_time"; }

  template <class Real>
  struct Constants {
    Real stiffness;     ///< Pa, 4/3 E_eff
    Real root_damping;  ///< kg/(s m^0.5)
    Real viscosity;     ///< Pa s, gamma = root_damping + viscosity sqrt(R_eff)
    Real least_force;   ///< N, 0 to clip, else very negative
  };
  Constants<double> constants(const PairProperties& pair) const {
    const double stiffness = 4.0 / 3.0 * pair.effective_young;
    return {stiffness, root_damping.value_or(0), 1.5 * relaxation_time.value_or(0) * stiffness,
            no_attraction ? 0 : -infinity};
  }

  template <class Real>
  struct History {};

  template <class Real>
  static SILT_INLINE NormalLoad<Real> load(const Contact<Real>& contact, const Constants<Real>& c, History<Real>&) {
    NormalLoad<Real> load;
    const Real zero(0.0), overlap = larger(contact.overlap, zero);
    load.contact_radius = sqrt(contact.effective_radius * overlap);
    const Real stiffness = c.stiffness * load.contact_radius;
    load.stiffness = Real(1.5) * stiffness;
    load.damping = c.root_damping * sqrt(overlap) + c.viscosity * load.contact_radius;
    const Real spring = hertz_reading(contact, c.stiffness, overlap, load.contact_radius);
    const Real force = larger(spring + load.damping * contact.approach, c.least_force);
    load.force = select(overlap > zero, force, zero);
    return load;
  }

  static double duration(const Constants<double>& c, const Encounter& e) {
    const double k = c.stiffness * std::sqrt(e.radius);
    const double deepest = std::sqrt(hertz_overlap(k, e.mass, e.speed));
    return std::min(hertz_duration(k, e.mass, e.speed),
                    damping_duration(e.mass, (c.root_damping + c.viscosity * std::sqrt(e.radius)) * deepest));
  }
};

}  // namespace silt
