#pragma once
#include <algorithm>
#include <cmath>

#include "base/models.hpp"
#include "coupling/lift/shear_flow.hpp"

namespace silt {

struct NoSaffmanLift {
  static constexpr const char* name = "none";
  static constexpr ModelNote note = {"", "", "F = 0", ""};
  void options(OptionGroup&) {}
  Vec3 force(const ShearFlow&) const { return Vec3::Zero(); }
};

/// Lift by shear on a sphere that leads or lags (Saffman 1965), beyond its small Reynolds numbers as Mei (1992) fitted.
struct SaffmanMeiLift {
  static constexpr const char* name = "saffman_mei";
  static constexpr ModelNote note = {
      "", "Saffman 1965; Mei 1992",
      "F = 1.615 d^2 (rho mu/|curl u|)^1/2 f (u - v) x curl u; b = d |curl u|/(2 |u - v|), f = (1 - "
      "0.3314 b^0.5) exp(-Re/10) + 0.3314 b^0.5 for Re <= 40, 0.0524 (b Re)^0.5 above",
      "force at three slips in a shear flow; path of a sinking particle"};
  void options(OptionGroup&) {}
  static double correction(double reynolds, double b) {
    if (reynolds > 40) return 0.0524 * std::sqrt(b * reynolds);
    return (1 - 0.3314 * std::sqrt(b)) * std::exp(-reynolds / 10) + 0.3314 * std::sqrt(b);
  }
  Vec3 force(const ShearFlow& flow) const {
    const double rate = flow.vorticity.norm(), speed = flow.slip.norm();
    if (!(rate > 0 && speed > 0)) return Vec3::Zero();
    const double f = correction(flow.reynolds(), 0.5 * flow.diameter * rate / speed);
    return 1.615 * flow.diameter * flow.diameter * std::sqrt(flow.density * flow.viscosity / rate) * f *
           flow.slip.cross(flow.vorticity);
  }
};

/// Lift by shear, `-saffman_type`.
using SaffmanModels = Models<NoSaffmanLift, SaffmanMeiLift>;

}  // namespace silt
