#pragma once
#include <algorithm>
#include <string>

#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"
#include "coupling/drag/haider_levenspiel.hpp"
#include "coupling/drag/stokes_cunningham.hpp"

namespace silt {

/// Drag of a single sphere in the superficial velocity, times a power of the void fraction (Di Felice 1994; 7.92-7.93).
/// Single sphere: Dallavalle's law as in the paper, or any other.
struct DiFeliceDrag {
  static constexpr const char* name = "di_felice";
  static constexpr ModelNote note = {
      "(7.92-7.93)", "Di Felice 1994",
      "single-particle drag (Dallavalle's C_D = (0.63 + 4.8 Re^-0.5)^2, or another) in a (u - v), times a^-chi, chi = "
      "3.7 - 0.65 exp(-(1.5 - log10 Re)^2/2), Re = a rho d |u-v|/mu",
      "chi in both limits and at Re = 10^1.5; terminal velocity"};
  enum class Single { dallavalle, schiller_naumann, haider_levenspiel, stokes_cunningham };
  void options(OptionGroup& option) {
    std::string law = "dallavalle";
    double sphericity = 1;
    option("single", law, {"dallavalle", "schiller_naumann", "haider_levenspiel", "stokes_cunningham"},
           "drag law of the single particle that Di Felice's law multiplies");
    option("sphericity", sphericity, "-",
           "with single haider_levenspiel: surface of the sphere of equal volume over "
           "the particle's surface",
           Range{0, 1, true, false});
    option("mean_free_path", mean_free_path, "m", "with single stokes_cunningham: mean free path of the gas",
           non_negative);
    single = law == "dallavalle"          ? Single::dallavalle
             : law == "schiller_naumann"  ? Single::schiller_naumann
             : law == "haider_levenspiel" ? Single::haider_levenspiel
                                          : Single::stokes_cunningham;
    coefficients = HaiderLevenspielCoefficients(sphericity);
  }
  Single single = Single::dallavalle;
  double mean_free_path = 0;
  HaiderLevenspielCoefficients coefficients{1};

  /// The power of the void fraction at the Reynolds number of the superficial velocity.
  static double crowding(double void_fraction, double reynolds) {
    // At rest log10 Re is -infinity and chi its creeping-flow limit, 3.7.
    const double distance = 1.5 - std::log10(std::max(reynolds, 1e-30));
    return std::pow(void_fraction, -(3.7 - 0.65 * std::exp(-0.5 * distance * distance)));
  }
  /// The single particle's drag over Stokes'.
  double factor(double reynolds, double diameter) const {
    switch (single) {
      case Single::schiller_naumann:
        return schiller_naumann_factor(reynolds);
      case Single::haider_levenspiel:
        return coefficients.factor(reynolds);
      case Single::stokes_cunningham:
        return 1 / cunningham(mean_free_path, diameter);
      default:
        return dallavalle_factor(reynolds);
    }
  }
  double exchange(const FlowAround& flow) const {
    const double reynolds = flow.superficial_reynolds();
    return flow.stokes() * factor(reynolds, flow.diameter) * flow.void_fraction *
           crowding(flow.void_fraction, reynolds);
  }
};

}  // namespace silt
