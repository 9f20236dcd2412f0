#pragma once
#include <optional>
#include <string>

#include "base/expression.hpp"
#include "base/options.hpp"
#include "base/vector.hpp"

namespace silt {

/// The options of a moving wall, part of `-wall_<name>_...`.
struct WallMotionOptions {
  std::string velocity = "0, 0, 0", rotation_rate = "0";
  Vec3 rotation_axis = Vec3::Zero();
  std::optional<Vec3> rotation_centre;
  Vec3 oscillation_amplitude = Vec3::Zero();
  double oscillation_frequency = 0, oscillation_phase = 0;
  double servo_force = 0, servo_speed = 0, servo_mass = 0;
  Vec3 servo_direction = Vec3::Zero();

  void options(OptionGroup& option);
};

/// The motion of a rigid wall: a translation (given velocity, oscillation, and what a servo adds: a piston of mass m
/// pressed with the force F_0, m dv/dt = F_0 - F - F_0 v/v_max) and a rotation about an axis through a centre that is
/// carried along. A point that starts at X is at
///
///     x = centre + shift + R(angle) (X - centre),   v = velocity + spin x (x - centre - shift).
///
/// Before time 0 (settling) walls stand still.
class WallMotion {
 public:
  WallMotion() = default;
  /// `prefix` is that of the options, for messages. Throws UserError for options that contradict each other.
  WallMotion(const WallMotionOptions& options, const std::string& prefix);

  bool moves() const { return moves_; }
  bool rotates() const { return rotates_; }
  bool servo() const { return servo_force_ > 0; }
  /// Whether the wall's rotation is about this line.
  bool about(const Vec3& point, const Vec3& axis) const;
  /// Whether its axis is parallel to this direction.
  bool parallel(const Vec3& direction) const { return direction.cross(axis_).norm() <= 1e-9; }

  /// What a restart needs to go on.
  struct State {
    Vec3 travel = Vec3::Zero();  ///< m, integral of the velocity, servo included
    double angle = 0;            ///< rad, integral of the rate
    double servo_speed = 0;      ///< m/s
  };
  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

  /// Moves from time to time + h; `force`: what the wall exerts on all particles (N), for the servo.
  void advance(double time, double h, const Vec3& force);
  /// Brings pose and velocities to this time.
  void pose(double time);

  struct Pose {
    Vec3 shift = Vec3::Zero();  ///< m
    Mat3 turn = Mat3::Identity();
  };
  Pose present() const { return {shift_, turn_}; }
  /// Where a point x that moved with the wall since it had this pose is now.
  Vec3 carried(const Vec3& x, const Pose& since) const {
    return centre_ + shift_ + turn_ * (since.turn.transpose() * (x - centre_ - since.shift));
  }
  const Vec3& shift() const { return shift_; }
  const Vec3& centre() const { return centre_; }
  double angle() const { return state_.angle; }
  /// From where a point is to where it was at the start, and back; directions alike.
  Vec3 to_start(const Vec3& x) const { return centre_ + turn_.transpose() * (x - centre_ - shift_); }
  Vec3 direction_to_present(const Vec3& start) const { return turn_ * start; }
  /// As to_start, but for a shape that its rotation leaves as it is.
  Vec3 to_start_unturned(const Vec3& x) const { return x - shift_; }
  /// m/s, of the wall's material at a point of space.
  Vec3 velocity_at(const Vec3& x) const { return velocity_now_ + spin_.cross(x - centre_ - shift_); }

 private:
  std::optional<VectorExpression> velocity_;
  std::optional<Expression> rate_;
  Vec3 axis_ = Vec3::UnitZ(), centre_ = Vec3::Zero();
  Vec3 amplitude_ = Vec3::Zero();
  double frequency_ = 0, phase_ = 0;  ///< rad/s, rad
  double servo_force_ = 0, servo_limit_ = 0, servo_mass_ = 0;
  Vec3 servo_direction_ = Vec3::Zero();
  bool moves_ = false, rotates_ = false;

  State state_;
  Vec3 shift_ = Vec3::Zero(), velocity_now_ = Vec3::Zero(), spin_ = Vec3::Zero();
  Mat3 turn_ = Mat3::Identity();
};

}  // namespace silt
