#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gas_box.hpp"
#include "particles/tangential/tangential_load.hpp"

using namespace silt;

namespace {

BoxCase wide_box() {
  BoxCase setup;
  setup.box(Vec3::Constant(-0.02), Vec3::Constant(0.02));
  setup.set("material_bead_young_modulus", "1e6").set("particles_speed", "1");
  return setup;
}

/// How far one of two spheres on a linear spring, let go at rest with an overlap, is after a third of a period from the
/// harmonic oscillator, as a share of its amplitude.
double spring_error(const std::string& integrator, int steps) {
  constexpr double radius = 1e-3, overlap = 1e-5, stiffness = 100;
  const double mass = 2500 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  const double frequency = std::sqrt(2 * stiffness / mass), time = std::numbers::pi / 3 / frequency;
  BoxCase setup = wide_box();
  setup.set("normal_type", "linear").set("normal_stiffness", std::to_string(stiffness));
  setup.set("material_bead_restitution", "1").set("particles_integrator", integrator);
  setup.set("particles_step_fraction", "0.2");
  BoxRun run(setup);
  run.particles.add({sphere({-radius + overlap / 2, 0, 0}, Vec3::Zero(), radius),
                     sphere({radius - overlap / 2, 0, 0}, Vec3::Zero(), radius)});
  for (int n = 0; n < steps; ++n) {
    const auto step = run.particles.advance(n * time / steps, time / steps);
    REQUIRE(step.substeps == 1);
  }
  const double exact = radius - 0.5 * overlap * std::cos(frequency * time);
  return std::abs(run.particles.position(1)[0] - exact) / (0.5 * overlap);
}

}  // namespace

TEST_CASE("Velocity Verlet and leapfrog follow a spring to second order in the step, semi-implicit Euler to first") {
  for (const auto& [integrator, order] :
       {std::pair("velocity_verlet", 2.0), std::pair("leapfrog", 2.0), std::pair("semi_implicit_euler", 1.0)}) {
    const double coarse = spring_error(integrator, 20), fine = spring_error(integrator, 80);
    INFO(integrator << ": " << coarse << " " << fine);
    CHECK(std::log(coarse / fine) / std::log(4.0) == Approx(order).margin(0.15));
    CHECK(fine < 0.02);
  }
}

TEST_CASE("A tangential spring without dashpot neither gains nor loses energy with semi-implicit Euler") {
  constexpr double mass = 2e-6, stiffness = 50, angle = 0.1;
  const double frequency = std::sqrt(3.5 * stiffness / mass), step = angle / frequency;
  Contact<double> contact{};
  contact.normal[2] = 1;
  contact.effective_mass = mass;
  double velocity = 0.01, spring[3] = {}, force[3] = {}, largest[2] = {0, 0};
  for (int n = 0; n < 200000; ++n) {
    velocity += step * 3.5 * force[0] / mass;
    contact.slip[0] = velocity;
    const double rest = grow_spring(contact, stiffness, 1.0, step, spring);
    limit_spring(contact, 1.0, 1e9, SpringLaw<double>{stiffness, 0}, rest, spring, force);
    double& seen = largest[n < 1000 ? 0 : 1];
    seen = std::max(seen, n < 1000 || n >= 199000 ? std::abs(spring[0]) : 0);
  }
  CHECK(largest[0] == Approx(0.01 / frequency).epsilon(angle));
  CHECK(largest[1] == Approx(largest[0]).epsilon(1e-3));
}

TEST_CASE(
    "With leapfrog a dashpot sees the velocities half a step before, with velocity Verlet those of its own time") {
  // In a pack the jumps where contacts begin are long past: two spheres that overlap from the start on.
  constexpr double radius = 1e-3, overlap = 1e-5, stiffness = 100, h = 2e-5;
  const double mass = 2500 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  const double ratio = -std::log(0.5) / std::sqrt(std::pow(std::numbers::pi, 2) + std::pow(std::log(0.5), 2));
  const double dashpot = 2 * ratio * std::sqrt(stiffness * mass / 2);
  for (const bool leapfrog : {false, true}) {
    BoxCase setup = wide_box();
    setup.set("normal_type", "linear").set("normal_stiffness", std::to_string(stiffness));
    setup.set("material_bead_restitution", "0.5").set("particles_step_fraction", "0.5");
    setup.set("particles_integrator", leapfrog ? "leapfrog" : "velocity_verlet");
    BoxRun run(setup);
    run.particles.add({sphere({-radius + overlap / 2, 0, 0}, {0.01, 0, 0}, radius),
                       sphere({radius - overlap / 2, 0, 0}, {-0.01, 0, 0}, radius)});
    double x = overlap / 2, v = 0.01;  // of the left sphere, to the right; the overlap is 2 x
    const auto force = [&](double seen) { return -stiffness * 2 * x - dashpot * 2 * seen; };
    double f = force(v);
    for (int n = 0; n < 4; ++n) {
      REQUIRE(run.particles.advance(n * h, h).substeps == 1);
      const double half = v + 0.5 * h * f / mass, before = f;
      x += h * half;
      f = force(leapfrog ? half : v + h * before / mass);
      v = half + 0.5 * h * f / mass;
      INFO(n);
      CHECK(run.particles.velocity(0)[0] == Approx(v).epsilon(1e-11));
      CHECK(run.particles.position(0)[0] == Approx(x - radius).epsilon(1e-14));
    }
  }
}

TEST_CASE("With every integrator the impulses add up to the change of momentum, walls, weight and drag included",
          "[particles][mpi]") {
  for (const std::string integrator : {"velocity_verlet", "leapfrog", "semi_implicit_euler"}) {
    BoxCase setup;
    setup.gravity = {0, 0, -9.81};
    setup.box(Vec3::Zero(), Vec3::Constant(8e-3));
    setup.set("material_bead_young_modulus", "1e6").set("material_bead_friction", "0.4").set("particles_speed", "1");
    setup.set("particles_integrator", integrator);
    BoxRun run(setup);
    run.particles.add(gas(5, Vec3::Zero(), Vec3::Constant(8e-3), 0.7e-3, 0.3));
    for (int i = 0; i < run.particles.owned(); ++i) {
      FluidAction& action = run.particles.fluid_action(i);
      action.exchange = 50 * run.particles.mass(i);
      action.velocity[2] = 0.2;
    }
    run.particles.take_impulses();
    const Vec3 before = run.particles.momentum();
    const double h = run.particles.time_step();
    for (int n = 0; n < 40; ++n) run.particles.advance(10 * n * h, 10 * h);
    const auto in = run.particles.take_impulses();
    const Vec3 change = run.particles.momentum() - before;
    const double size = in.walls.norm() + in.gravity.norm() + in.drag.norm();
    CHECK(in.walls.norm() > 0.1 * in.gravity.norm());
    CHECK((change - in.walls - in.gravity - in.drag).norm() < 1e-12 * size);
  }
}

TEST_CASE("A free spinning sphere is back in its orientation after a turn, and its quaternion keeps its length") {
  for (const std::string integrator : {"velocity_verlet", "leapfrog", "semi_implicit_euler"}) {
    BoxRun run(wide_box().set("particles_orientation", "yes").set("particles_integrator", integrator));
    const Vec3 axis = Vec3(1, -2, 2) / 3;
    const double rate = 700;
    run.particles.add({sphere(Vec3::Zero(), Vec3::Zero(), 1e-3, rate * axis)});
    const int column = run.particles.columns().find("orientation");
    REQUIRE(column >= 0);
    const double* q = run.particles.columns().row(column, 0);
    CHECK(q[0] == 1);
    constexpr int steps = 1000;
    const double dt = 2 * std::numbers::pi / rate / steps;
    for (int n = 0; n < steps / 2; ++n) run.particles.advance(n * dt, dt);
    q = run.particles.columns().row(column, 0);
    CHECK(q[0] == Approx(0).margin(1e-11));  // half a turn: the axis itself
    for (int d = 0; d < 3; ++d) CHECK(q[1 + d] == Approx(axis[d]).epsilon(1e-11));
    for (int n = steps / 2; n < steps; ++n) run.particles.advance(n * dt, dt);
    q = run.particles.columns().row(column, 0);
    CHECK(q[0] == Approx(-1).epsilon(1e-11));  // -1 and 1 are the same orientation
    for (int d = 0; d < 3; ++d) CHECK(q[1 + d] == Approx(0).margin(1e-11));
    double square = 0;
    for (int k = 0; k < 4; ++k) square += q[k] * q[k];
    CHECK(square == Approx(1).epsilon(1e-14));
  }
}

TEST_CASE("The turn of a sphere whose spin decays is exact, for steps below and beyond its response time") {
  const double rate = 2000, start = 300, time = 5e-3, exact = start / rate * -std::expm1(-rate * time);
  for (const int steps : {4, 700}) {
    BoxRun run(wide_box()
                   .set("particles_orientation", "yes")
                   .set("particles_step", "2e-3")
                   .set("particles_step_override", "yes"));
    run.particles.add({sphere(Vec3::Zero(), Vec3::Zero(), 1e-3, {0, 0, start})});
    run.particles.fluid_action(0).spin_exchange = rate * 0.4 * run.particles.mass(0) * 1e-6;
    for (int n = 0; n < steps; ++n) REQUIRE(run.particles.advance(0, time / steps).substeps == 1);
    const double* q = run.particles.columns().row(run.particles.columns().find("orientation"), 0);
    CHECK(2 * std::atan2(q[3], q[0]) == Approx(exact).epsilon(1e-12));
  }
}
