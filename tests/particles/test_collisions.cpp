#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gas_box.hpp"
#include "head_on.hpp"
#include "particles/materials.hpp"

using namespace silt;

TEST_CASE("A linear collision has the given restitution and duration, to second order in the step", "[particles]") {
  double previous_e = 0, previous_t = 0;
  for (const int steps : {32, 64, 128}) {
    BoxCase setup;
    setup.set("normal_type", "linear").set("normal_contact_time", "1e-4").set("material_bead_restitution", "0.7");
    setup.set("particles_step_fraction", "0.05").set("tangential_type", "mindlin");
    // They touch, and part, in any phase of a step.
    double error_restitution = 0, error_time = 0;
    for (const double phase : {0.1, 0.37, 0.5, 0.77, 0.95}) {
      const double dt = 1e-4 / steps;
      setup.set("particles_step", fmt::format("{:.17g}", dt));
      const HeadOn result = head_on(setup, 1e-3, 1.0, (2 + phase) * 2 * dt, dt);
      error_restitution = std::max(error_restitution, std::abs(result.restitution - 0.7));
      error_time = std::max(error_time, std::abs(result.duration - 1e-4) / 1e-4);
    }
    INFO("steps " << steps << " e error " << error_restitution << " t error " << error_time);
    CHECK(error_restitution < 20.0 / (steps * steps));
    CHECK(error_time < 20.0 / (steps * steps));
    if (previous_e > 0) {
      CHECK(previous_e / error_restitution > 3.4);
      CHECK(previous_t / error_time > 3.4);
    }
    previous_e = error_restitution, previous_t = error_time;
  }
}

TEST_CASE("Hertz spheres of glass and limestone meet as Chung and Ooi's test 1 tells", "[particles]") {
  struct Figure {
    const char *young, *poisson, *density;
    double overlap, duration;
  };
  for (const Figure& f :
       {Figure{"48e9", "0.20", "2800", 274.11e-6, 40.34e-6}, Figure{"20e9", "0.25", "2500", 368.30e-6, 54.20e-6}}) {
    BoxCase setup;
    setup.set("material_bead_young_modulus", f.young).set("material_bead_poisson_ratio", f.poisson);
    setup.set("material_bead_density", f.density).set("material_bead_restitution", "1");
    setup.set("particles_rayleigh_fraction", "0.5");
    const HeadOn result = head_on(setup, 10e-3, 10, 0, 2e-7);
    CHECK(result.largest_overlap == Approx(f.overlap).epsilon(1e-3));
    CHECK(result.duration == Approx(f.duration).epsilon(2e-3));
    CHECK(result.restitution == Approx(1.0).epsilon(1e-4));
  }
}

TEST_CASE("The Tsuji damping gives the restitution asked for at any impact speed", "[particles]") {
  for (const double e : {0.9, 0.7, 0.5})
    for (const double speed : {0.01, 1.0}) {
      BoxCase setup;
      setup.set("material_bead_restitution", std::to_string(e)).set("material_bead_young_modulus", "1e7");
      setup.set("particles_speed", "2").set("particles_overlap_limit", "0.5");
      const double step = speed > 0.1 ? 2e-7 : 5e-7;
      const HeadOn result = head_on(setup, 1e-3, speed, 0, step);
      CHECK(result.restitution == Approx(e).epsilon(2e-3));
    }
}

TEST_CASE("A sliding ball comes to roll at five sevenths of its speed after 2/7 v/(mu g)", "[particles]") {
  for (const char* friction : {"0.2", "0.6"}) {
    const double mu = std::stod(friction), radius = 0.5e-3, v0 = 0.1;
    BoxCase setup;
    setup.box(Vec3(-5e-3, -5e-3, 0), Vec3(25e-3, 5e-3, 10e-3));
    setup.gravity = {0, 0, -9.81};
    setup.set("material_bead_density", "1e4").set("material_bead_friction", friction);
    setup.set("material_bead_young_modulus", "1e8");
    BoxRun run(setup);
    // Resting overlap under gravity: 4/3 E_eff sqrt(R) x^1.5 = m g.
    const PairProperties& pair = run.particles.materials().pair(0, 0);
    const double mass = 1e4 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    const double rest = std::pow(mass * 9.81 / (4.0 / 3.0 * pair.effective_young * std::sqrt(radius)), 2.0 / 3.0);
    run.particles.add({sphere(Vec3(0, 0, radius - rest), Vec3(v0, 0, 0), radius)});
    const double rolling = 2.0 / 7.0 * v0 / (mu * 9.81);
    run.particles.advance(0, 0.9 * rolling);
    auto state = gather(run.particles).at(0);
    CHECK(state.v[0] == Approx(v0 - mu * 9.81 * 0.9 * rolling).epsilon(2e-3));
    run.particles.advance(0.9 * rolling, 0.4 * rolling);
    state = gather(run.particles).at(0);
    CHECK(state.v[0] == Approx(5.0 / 7.0 * v0).epsilon(2e-3));
    CHECK(state.w[1] * radius == Approx(5.0 / 7.0 * v0).epsilon(2e-3));
  }
}

TEST_CASE(
    "A soft ball comes to roll over the arm to the contact point, or over its radius where the slip is taken there",
    "[particles]") {
  const double radius = 0.5e-3, v0 = 0.01;
  for (const bool at_radius : {false, true}) {
    BoxCase setup;
    setup.box(Vec3(-5e-3, -5e-3, 0), Vec3(25e-3, 5e-3, 10e-3));
    setup.gravity = {0, 0, -9.81};
    setup.set("material_bead_density", "1e4").set("material_bead_friction", "0.5");
    setup.set("material_bead_young_modulus", "1e4").set("material_bead_restitution", "0.2");
    if (at_radius) setup.set("particles_slip_arm", "radius");
    BoxRun run(setup);
    const PairProperties& pair = run.particles.materials().pair(0, 0);
    const double mass = 1e4 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    const double rest = std::pow(mass * 9.81 / (4.0 / 3.0 * pair.effective_young * std::sqrt(radius)), 2.0 / 3.0);
    REQUIRE(rest > 0.05 * radius);
    run.particles.add({sphere(Vec3(0, 0, radius - rest), Vec3(v0, 0, 0), radius)});
    run.particles.advance(0, 0.1);
    const auto state = gather(run.particles).at(0);
    // Friction at the arm a turns the ball: w = (v0 - v) m a/I; it ends where v = w times the arm of the slip.
    const double arm = radius - rest, slip = at_radius ? radius : arm, share = 2.5 * arm * slip / (radius * radius);
    CHECK(state.v[0] == Approx(v0 * share / (1 + share)).epsilon(2e-3));
    CHECK(state.v[0] == Approx(state.w[1] * slip).epsilon(1e-3));
  }
}

TEST_CASE("A ball that slides all through an oblique impact loses mu (1 + e) of its normal speed tangentially",
          "[particles]") {
  // Chung & Ooi test 4, sliding branch: aluminium oxide, 3.9 m/s, e 0.98, mu 0.092; the angle is to the normal.
  const double radius = 2.5e-3, v = 3.9, e = 0.98, mu = 0.092;
  for (const double degrees : {50.0, 70.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    const double vn = v * std::cos(angle), vt = v * std::sin(angle);
    BoxCase setup;
    setup.box(Vec3(-25e-3, -25e-3, 0), Vec3(25e-3, 25e-3, 50e-3));
    setup.set("material_bead_density", "4000").set("material_bead_young_modulus", "3.8e11");
    setup.set("material_bead_poisson_ratio", "0.23").set("material_bead_restitution", "0.98");
    setup.set("material_bead_friction", "0.092");
    BoxRun run(setup);
    run.particles.add({sphere(Vec3(0, 0, radius), Vec3(vt, 0, -vn), radius)});
    run.particles.advance(0, 60e-6);
    const auto state = gather(run.particles).at(0);
    CHECK(state.v[2] == Approx(e * vn).epsilon(2e-3));
    CHECK(state.v[0] / vt == Approx(1 - mu * (1 + e) * vn / vt).epsilon(1e-3));
    CHECK(state.w[1] == Approx(2.5 * mu * (1 + e) * vn / radius).epsilon(5e-3));
  }
}

TEST_CASE("Friction in a strongly damped oblique impact opposes the slip from the first touch on, at any step",
          "[particles]") {
  // At the first touch the tangential dashpot alone is above mu F_n, and the tangential stiffness still small.
  const double radius = 5e-3, vt = 0.4, vn = 0.2;
  double before[2] = {};
  for (const double step : {2e-5, 5e-6, 1.25e-6}) {
    BoxCase setup;
    setup.box(Vec3(-25e-3, -25e-3, 0), Vec3(25e-3, 25e-3, 50e-3));
    setup.set("material_bead_density", "2500").set("material_bead_young_modulus", "1e8");
    setup.set("material_bead_restitution", "0.6").set("material_bead_friction", "0.4");
    setup.set("particles_speed", "1").set("particles_step", std::to_string(step));
    BoxRun run(setup);
    run.particles.add({sphere(Vec3(0, 0, 1.0005 * radius), Vec3(vt, 0, -vn), radius)});
    double fastest = vt;
    for (int k = 0; k < 50; ++k) {
      run.particles.advance(k * 20e-6, 20e-6);
      const auto state = gather(run.particles).at(0);
      // Until the contact point has come to rest, which takes 2/7 of the slip, the ball only slows down.
      if (state.v[0] - state.w[1] * radius > 0.05 * vt) CHECK(state.v[0] <= fastest + 1e-9);
      fastest = std::min(fastest, state.v[0]);
    }
    const auto state = gather(run.particles).at(0);
    INFO("step " << step << ": " << state.v[0] << " m/s, " << state.w[1] << " rad/s");
    CHECK(state.v[2] > 0.5 * vn);
    if (before[0] > 0) {
      CHECK(state.v[0] == Approx(before[0]).epsilon(1e-3));
      CHECK(state.w[1] == Approx(before[1]).epsilon(2e-3));
    }
    before[0] = state.v[0], before[1] = state.w[1];
  }
}

TEST_CASE("Constant rolling friction stops a rolling ball after v^2 / (2 mu_r g 5/7)", "[particles]") {
  const double radius = 0.5e-3, v0 = 0.05, rolling_friction = 0.05;
  BoxCase setup;
  setup.box(Vec3(-5e-3, -5e-3, 0), Vec3(25e-3, 5e-3, 10e-3));
  setup.gravity = {0, 0, -9.81};
  setup.set("material_bead_density", "1e4").set("material_bead_friction", "0.8");
  setup.set("material_bead_young_modulus", "1e8").set("material_bead_rolling_friction", "0.05");
  setup.set("rolling_type", "constant");
  BoxRun run(setup);
  const PairProperties& pair = run.particles.materials().pair(0, 0);
  const double mass = 1e4 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  const double rest = std::pow(mass * 9.81 / (4.0 / 3.0 * pair.effective_young * std::sqrt(radius)), 2.0 / 3.0);
  run.particles.add({sphere(Vec3(0, 0, radius - rest), Vec3(v0, 0, 0), radius, Vec3(0, v0 / radius, 0))});
  // Rolling: m a = -f, I alpha = f R - mu_r R m g, a = alpha R: a = -5/7 mu_r g.
  const double deceleration = 5.0 / 7.0 * rolling_friction * 9.81;
  run.particles.advance(0, 0.5 * v0 / deceleration);
  auto state = gather(run.particles).at(0);
  CHECK(state.v[0] == Approx(0.5 * v0).epsilon(5e-3));
  run.particles.advance(0, 0.7 * v0 / deceleration);
  state = gather(run.particles).at(0);
  CHECK(std::abs(state.v[0]) < 1e-3 * v0);
  CHECK(state.x[0] == Approx(0.5 * v0 * v0 / deceleration).epsilon(1e-2));
}
