#pragma once
#include <cmath>
#include <numbers>

#include "gas_box.hpp"

namespace silt {

/// A ball of 1 mm and 1e4 kg/m3 that rests on the plane z = 0 of a box under gravity, with a linear normal spring.
struct BallOnPlane {
  static constexpr double radius = 0.5e-3, stiffness = 1e4, gravity = 9.81;
  double mass = 1e4 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  double weight = mass * gravity, inertia = 0.4 * mass * radius * radius;
  double overlap = weight / stiffness, arm = radius - overlap, contact_radius = std::sqrt(radius * overlap);
  /// 1/kg, how the slip at the contact answers to a force there.
  double mobility = 1 / mass + arm * arm / inertia;
  BoxCase setup;

  explicit BallOnPlane(const char* friction = "0.8") {
    setup.box(Vec3(-5e-3, -5e-3, 0), Vec3(25e-3, 5e-3, 10e-3));
    setup.gravity = {0, 0, -gravity};
    set("material_bead_density", "1e4").set("material_bead_friction", friction).set("material_bead_restitution", "0.8");
    set("normal_type", "linear").set("normal_stiffness", "1e4");
    set("tangential_type", "spring_dashpot").set("tangential_stiffness", "8e3");
  }
  BallOnPlane& set(const std::string& name, const std::string& value) {
    setup.set(name, value);
    return *this;
  }
  /// Sliding speed v (without rolling) or rolling speed (with), and spin about the normal.
  void start(double sliding, double rolling = 0, double twist = 0) {
    run = std::make_unique<BoxRun>(setup);
    run->particles.add(
        {sphere(Vec3(0, 0, radius - overlap), Vec3(sliding + rolling, 0, 0), radius, Vec3(0, rolling / arm, twist))});
  }
  /// Velocity of the ball's material at the contact. m/s
  double slip() const {
    const State state = at();
    return state.v[0] - arm * state.w[1];
  }
  State at() const { return gather(run->particles).at(0); }
  void advance(double time) { run->particles.advance(0, time); }

  std::unique_ptr<BoxRun> run;
};

}  // namespace silt
