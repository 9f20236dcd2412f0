#pragma once
#include <cmath>

#include "base/models.hpp"

namespace silt {

/// What a heat transfer law needs to know of the flow around one particle.
struct HeatFlow {
  double reynolds;       ///< rho d |u - v| / mu
  double prandtl;        ///< mu c_p / lambda
  double void_fraction;  ///< alpha
};

/// A single sphere (7.97), Ranz & Marshall 1952.
struct RanzMarshallNusselt {
  static constexpr const char* name = "ranz_marshall";
  static constexpr ModelNote note = {"(7.97)", "Ranz & Marshall 1952", "Nu = 2 + 0.6 Re^1/2 Pr^1/3",
                                     "cooling of a sphere (MFiX)"};
  void options(OptionGroup&) {}
  double nusselt(const HeatFlow& flow) const { return 2 + 0.6 * std::sqrt(flow.reynolds) * std::cbrt(flow.prandtl); }
};

/// Beds and suspensions of a void fraction above 0.35 (Gunn 1978).
struct GunnNusselt {
  static constexpr const char* name = "gunn";
  static constexpr ModelNote note = {
      "", "Gunn 1978",
      "Nu = (7 - 10a + 5a^2)(1 + 0.7 Re^0.2 Pr^1/3) + (1.33 - 2.4a + 1.2a^2) Re^0.7 Pr^1/3, Re = a rho d |u-v|/mu",
      "limits; cooling of a sphere"};
  void options(OptionGroup&) {}
  double nusselt(const HeatFlow& flow) const {
    const double a = flow.void_fraction, re = a * flow.reynolds, third = std::cbrt(flow.prandtl);
    return (7 - 10 * a + 5 * a * a) * (1 + 0.7 * std::pow(re, 0.2) * third) +
           (1.33 - 2.4 * a + 1.2 * a * a) * std::pow(re, 0.7) * third;
  }
};

/// A single sphere, Whitaker 1972, with the viscosity at the surface that of the flow.
struct WhitakerNusselt {
  static constexpr const char* name = "whitaker";
  static constexpr ModelNote note = {"", "Whitaker 1972", "Nu = 2 + (0.4 Re^1/2 + 0.06 Re^2/3) Pr^0.4",
                                     "cooling of a sphere"};
  void options(OptionGroup&) {}
  double nusselt(const HeatFlow& flow) const {
    return 2 + (0.4 * std::sqrt(flow.reynolds) + 0.06 * std::pow(flow.reynolds, 2.0 / 3)) * std::pow(flow.prandtl, 0.4);
  }
};

/// Heat transfer between fluid and particle, `-nusselt_type`.
using NusseltModels = Models<RanzMarshallNusselt, GunnNusselt, WhitakerNusselt>;

}  // namespace silt
