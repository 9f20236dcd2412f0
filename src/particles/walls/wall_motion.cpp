#include "particles/walls/wall_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"

namespace silt {

void WallMotionOptions::options(OptionGroup& option) {
  option("velocity", velocity, "m/s, velocity with which the wall is moved: formulas in t");
  option("rotation_rate", rotation_rate, "rad/s, rate at which the wall turns about its rotation axis: formula in t");
  option("rotation_axis", rotation_axis, "-", "direction of the axis about which the wall turns");
  option("rotation_centre", rotation_centre, "m",
         "a point of the axis of rotation, which is carried along by the translation; torques are about it; default: "
         "the wall's point, or the middle of its box");
  option("oscillation_amplitude", oscillation_amplitude, "m", "amplitude of a sinusoidal displacement");
  option("oscillation_frequency", oscillation_frequency, "Hz", "frequency of the oscillation", non_negative);
  option("oscillation_phase", oscillation_phase, "degrees", "phase of the oscillation at time 0");
  option("servo_force", servo_force, "N",
         "the wall is pressed along servo_direction with this force, as a piston is, until the particles carry it",
         non_negative);
  option("servo_direction", servo_direction, "-", "direction in which a servo wall presses");
  option("servo_speed", servo_speed, "m/s", "speed that a servo wall reaches without resistance", non_negative);
  option("servo_mass", servo_mass, "kg",
         "mass of a servo wall, its inertia; 0: that which weighs the servo force on Earth", non_negative);
}

WallMotion::WallMotion(const WallMotionOptions& options, const std::string& prefix) {
  const auto refuse = [&](const char* name, const std::string& text) {
    throw UserError(
        fmt::format("option -{}_{}: '{}' depends on the place; a wall moves as a whole", prefix, name, text));
  };
  VectorExpression velocity(prefix + "_velocity", options.velocity);
  if (!velocity.uniform()) refuse("velocity", options.velocity);
  if (!velocity.constant() || velocity(Vec3::Zero(), 0).norm() > 0) velocity_ = std::move(velocity);
  Expression rate(prefix + "_rotation_rate", options.rotation_rate);
  if (!rate.uniform()) refuse("rotation_rate", options.rotation_rate);
  if (!rate.constant() || rate(Vec3::Zero(), 0) != 0) rate_ = std::move(rate);
  if (rate_ && options.rotation_axis.norm() == 0)
    throw UserError(fmt::format("-{0}_rotation_axis is missing: -{0}_rotation_rate needs it", prefix));
  if (options.rotation_axis.norm() > 0) axis_ = options.rotation_axis.normalized();
  centre_ = options.rotation_centre.value_or(Vec3::Zero());
  if ((options.oscillation_amplitude.norm() > 0) != (options.oscillation_frequency > 0))
    throw UserError(
        fmt::format("-{0}: give both -{0}_oscillation_amplitude and -{0}_oscillation_frequency, or neither", prefix));
  amplitude_ = options.oscillation_amplitude;
  frequency_ = 2 * std::numbers::pi * options.oscillation_frequency;
  phase_ = options.oscillation_phase * std::numbers::pi / 180;
  const int given = (options.servo_force > 0) + (options.servo_speed > 0) + (options.servo_direction.norm() > 0);
  if (given != 0 && given != 3)
    throw UserError(
        fmt::format("-{0}: a servo needs all of -{0}_servo_force, -{0}_servo_direction and -{0}_servo_speed", prefix));
  if (given) {
    servo_force_ = options.servo_force;
    servo_limit_ = options.servo_speed;
    servo_mass_ = options.servo_mass > 0 ? options.servo_mass : options.servo_force / 9.81;
    servo_direction_ = options.servo_direction.normalized();
  }
  rotates_ = rate_.has_value();
  moves_ = velocity_ || rotates_ || frequency_ > 0 || given;
}

bool WallMotion::about(const Vec3& point, const Vec3& axis) const {
  if (!parallel(axis)) return false;
  const Vec3 apart = point - centre_;
  return (apart - apart.dot(axis_) * axis_).norm() <= 1e-9 * std::max(apart.norm(), centre_.norm());
}

void WallMotion::advance(double time, double h, const Vec3& force) {
  if (!moves_ || time < 0) return;
  const double middle = time + 0.5 * h;
  if (velocity_) state_.travel += h * (*velocity_)(Vec3::Zero(), middle);
  if (rate_) state_.angle += h * (*rate_)(Vec3::Zero(), middle);
  if (servo_force_ > 0) {
    const double missing = servo_force_ - force.dot(servo_direction_), damping = servo_force_ / servo_limit_;
    state_.servo_speed =
        (state_.servo_speed + h * missing / servo_mass_) / (1 + h * damping / servo_mass_);  // implicit in the damping
    state_.travel += h * state_.servo_speed * servo_direction_;
  }
  pose(time + h);
}

void WallMotion::pose(double time) {
  shift_ = state_.travel;
  velocity_now_ = spin_ = Vec3::Zero();
  turn_ = Eigen::AngleAxisd(state_.angle, axis_).toRotationMatrix();
  if (time < 0) return;
  if (velocity_) velocity_now_ += (*velocity_)(Vec3::Zero(), time);
  if (rate_) spin_ = (*rate_)(Vec3::Zero(), time) * axis_;
  velocity_now_ += state_.servo_speed * servo_direction_;
  if (frequency_ > 0) {
    shift_ += (std::sin(frequency_ * time + phase_) - std::sin(phase_)) * amplitude_;
    velocity_now_ += frequency_ * std::cos(frequency_ * time + phase_) * amplitude_;
  }
}

}  // namespace silt
