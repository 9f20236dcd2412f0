#pragma once
#include "base/models.hpp"
#include "base/options.hpp"
#include "coupling/drag/flow_around.hpp"

namespace silt {

/// The coefficients b1 to b4 of Haider & Levenspiel (1989) for a sphericity p (7.85-7.87).
struct HaiderLevenspielCoefficients {
  double b1, b2, b3, b4;
  explicit HaiderLevenspielCoefficients(double p)
      : b1(std::exp(2.3288 - 6.4581 * p + 2.4486 * p * p)),
        b2(0.0964 + 0.5565 * p),
        b3(std::exp(4.905 - 13.8944 * p + 18.4222 * p * p - 10.2599 * p * p * p)),
        b4(std::exp(1.4681 + 12.2584 * p - 20.7322 * p * p + 15.8855 * p * p * p)) {}
  double factor(double reynolds) const {
    return 1 + b1 * std::pow(reynolds, b2) + b3 * reynolds * reynolds / (24 * (b4 + reynolds));
  }
};

/// A single body of any shape by its sphericity, the surface of the sphere of the same volume over its own; d is the
/// diameter of that sphere (7.84), Haider & Levenspiel 1989. Fitted for p >= 0.67 (and disks down to 0.026).
struct HaiderLevenspielDrag {
  static constexpr const char* name = "haider_levenspiel";
  static constexpr ModelNote note = {
      "(7.84-7.87)", "Haider & Levenspiel 1989",
      "C_D = 24/Re (1 + b1 Re^b2) + b3 Re/(b4 + Re); of the sphericity p, b1 = exp(2.3288 - "
      "6.4581 p + 2.4486 p^2), b2 = 0.0964 + 0.5565 p, b3 = exp(4.905 - 13.8944 p + 18.4222 p^2 - "
      "10.2599 p^3), b4 = exp(1.4681 + 12.2584 p - 20.7322 p^2 + 15.8855 p^3)",
      "C_D at Re 0.01, 1, 100, 1000 for sphericity 0.6, 0.8, 1; terminal velocity"};
  double sphericity = 1;
  void options(OptionGroup& option) {
    option("sphericity", sphericity, "-", "surface of the sphere of equal volume over the particle's surface",
           Range{0, 1, true, false});
    coefficients = HaiderLevenspielCoefficients(sphericity);
  }
  HaiderLevenspielCoefficients coefficients{1};
  double exchange(const FlowAround& flow) const { return flow.stokes() * coefficients.factor(flow.reynolds()); }
};

}  // namespace silt
