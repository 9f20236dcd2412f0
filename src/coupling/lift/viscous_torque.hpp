#pragma once
#include <cmath>
#include <numbers>

#include "base/models.hpp"
#include "coupling/lift/shear_flow.hpp"

namespace silt {

struct NoViscousTorque {
  static constexpr const char* name = "none";
  static constexpr ModelNote note = {"", "", "M = 0", ""};
  void options(OptionGroup&) {}
  double exchange(const ShearFlow&) const { return 0; }
};

/// The fluid's hold on a sphere's spin (3.289). `exchange` is the torque over the relative spin, N m s.
struct StokesTorque {
  static constexpr const char* name = "stokes";
  static constexpr ModelNote note = {"(3.289)", "Lamb 1932", "M = pi mu d^3 (curl u/2 - w)",
                                     "exponential approach to half the vorticity, any step"};
  void options(OptionGroup&) {}
  double exchange(const ShearFlow& flow) const {
    return std::numbers::pi * flow.viscosity * std::pow(flow.diameter, 3);
  }
};

/// The same beyond creeping flow (Dennis, Singh & Ingham 1980).
struct DennisTorque {
  static constexpr const char* name = "dennis";
  static constexpr ModelNote note = {
      "(3.289)", "Dennis, Singh & Ingham 1980",
      "M = (rho/2) (d/2)^5 C_R |W| W, W = curl u/2 - w, Re_R = rho d^2 |W|/mu, C_R = 64 pi/Re_R "
      "up to 32, 12.9 Re_R^-0.5 + 128.4/Re_R above",
      "torque at Re_R = 200; decay of a fast spin"};
  void options(OptionGroup&) {}
  double exchange(const ShearFlow& flow) const {
    const double reynolds = flow.density * flow.diameter * flow.diameter * flow.relative_spin().norm() / flow.viscosity;
    const double factor = reynolds > 32 ? (12.9 * std::sqrt(reynolds) + 128.4) / (64 * std::numbers::pi) : 1;
    return factor * StokesTorque{}.exchange(flow);
  }
};

/// Viscous torque, `-viscous_torque_type`.
using ViscousTorqueModels = Models<NoViscousTorque, StokesTorque, DennisTorque>;

}  // namespace silt
