#pragma once
#include <memory>
#include <string>

#include "base/expression.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"

namespace silt {

/// The options `-fluid_drive_...`: what drives the flow through a periodic box.
struct DriveOptions {
  std::string direction, pressure_gradient, velocity, mass_flow;
  void options(OptionGroup& option) {
    option("direction", direction, {"x", "y", "z"},
           "periodic direction along which the flow is driven: the pressure falls from one period to the next; give "
           "one of pressure_gradient, velocity and mass_flow");
    option("pressure_gradient", pressure_gradient,
           "Pa/m, formula in t: fall of the mean pressure along the direction (positive drives along it)");
    option("velocity", velocity,
           "m/s, formula in t: superficial velocity (void fraction times velocity) along the direction, mean over the "
           "domain; the pressure gradient that gives it is found in every step");
    option("mass_flow", mass_flow,
           "kg/s (per metre of depth in 2D), formula in t: mass flow along the direction, mean over its length; the "
           "pressure gradient that gives it is found in every step");
  }
};

/// What drives a periodic flow: the mean pressure falls by G per metre along one periodic direction,
///   p = p' - G x_d  with p' periodic,                                                                       (F7)
/// so the fluid gets P G per volume beside -P grad p' (P = alpha in model A, 1 in model B) and the particles the rest.
/// G is given, or it is the one with which the mean over the domain of alpha u_d is what the user asks for.
class Drive {
 public:
  /// Null when `-fluid_drive_direction` is not given. Throws UserError for options that do not fit each other or the
  /// mesh.
  static std::unique_ptr<Drive> create(const Mesh& mesh, Options& options, double density);
  /// Throws UserError when a drive is asked for though the flow knows none.
  static void refuse(const Options& options, const std::string& reason);

  int direction() const { return direction_; }
  /// True when the flow is given and the gradient has to be found.
  bool controlled() const { return controlled_; }
  /// Pa/m at time t, when it is given.
  double gradient(double t) const { return (*formula_)(Vec3::Zero(), t); }
  /// m/s at time t, mean superficial velocity asked for, when the flow is given.
  double velocity(double t) const { return factor_ * (*formula_)(Vec3::Zero(), t); }

 private:
  Drive() = default;
  int direction_ = 0;
  bool controlled_ = false;
  double factor_ = 1;
  std::unique_ptr<Expression> formula_;
};

}  // namespace silt
