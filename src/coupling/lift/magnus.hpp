#pragma once
#include <cmath>
#include <numbers>

#include "base/models.hpp"
#include "coupling/lift/shear_flow.hpp"

namespace silt {

struct NoMagnusLift {
  static constexpr const char* name = "none";
  static constexpr ModelNote note = {"", "", "F = 0", ""};
  void options(OptionGroup&) {}
  Vec3 force(const ShearFlow&) const { return Vec3::Zero(); }
};

/// Lift of a spinning sphere in creeping flow (Rubinow & Keller 1961).
struct RubinowKellerLift {
  static constexpr const char* name = "rubinow_keller";
  static constexpr ModelNote note = {"", "Rubinow & Keller 1961", "F = (pi/8) d^3 rho (curl u/2 - w) x (u - v)",
                                     "force on a ball with back spin; its circular path"};
  void options(OptionGroup&) {}
  Vec3 force(const ShearFlow& flow) const {
    return std::numbers::pi / 8 * std::pow(flow.diameter, 3) * flow.density * flow.relative_spin().cross(flow.slip);
  }
};

/// The same with the lift coefficient of Lun & Liu (1997) above a Reynolds number of 1.
struct LunLiuLift {
  static constexpr const char* name = "lun_liu";
  static constexpr ModelNote note = {"", "Lun & Liu 1997",
                                     "Rubinow & Keller times 0.178 + 0.822 Re^-0.522 above Re = 1",
                                     "force on a ball with back spin; its circular path"};
  void options(OptionGroup&) {}
  Vec3 force(const ShearFlow& flow) const {
    const double reynolds = flow.reynolds();
    return (reynolds > 1 ? 0.178 + 0.822 * std::pow(reynolds, -0.522) : 1) * RubinowKellerLift{}.force(flow);
  }
};

/// Lift by spin, `-magnus_type`.
using MagnusModels = Models<NoMagnusLift, RubinowKellerLift, LunLiuLift>;

}  // namespace silt
