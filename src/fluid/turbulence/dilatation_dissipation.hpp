#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace silt {

/// Dilatation dissipation: what the fluctuating compression of a turbulence that is not slow beside sound dissipates on
/// top of the solenoidal epsilon (docs/theory/turbulence.md, T8, T9). M_t = sqrt(2 k)/c is the turbulent Mach number.
struct DilatationDissipation {
  enum class Law { none, sarkar, zeman, wilcox };
  static inline const std::vector<std::string> names = {"none", "sarkar", "zeman", "wilcox"};
  Law law = Law::none;

  DilatationDissipation() = default;
  /// One of `names`.
  explicit DilatationDissipation(const std::string& name)
      : law(static_cast<Law>(std::find(names.begin(), names.end(), name) - names.begin())) {}

  /// epsilon_d/epsilon; k in m2/s2, sound = c in m/s, heat_ratio = gamma.
  double ratio(double k, double sound, double heat_ratio) const {
    if (law == Law::none || !(sound > 0)) return 0;
    const double mach2 = 2 * std::max(k, 0.0) / (sound * sound);
    switch (law) {
      case Law::sarkar:  // Sarkar, Erlebacher, Hussaini & Kreiss, J. Fluid Mech. 227 (1991) 473
        return mach2;
      case Law::zeman: {  // Zeman, Phys. Fluids A 2 (1990) 178, free shear flows
        constexpr double xi = 0.75, width = 0.6;
        const double beyond = std::sqrt(mach2) - 0.1 * std::sqrt(2 / (heat_ratio + 1));
        if (beyond <= 0) return 0;
        return xi * (1 - std::exp(-0.5 * (heat_ratio + 1) * beyond * beyond / (width * width)));
      }
      default: {  // Wilcox, AIAA J. 30 (1992) 2639
        constexpr double xi = 1.5, least = 0.25;
        return xi * std::max(0.0, mach2 - least * least);
      }
    }
  }
};

}  // namespace silt
