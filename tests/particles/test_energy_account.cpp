#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gas_box.hpp"

using namespace silt;
using Account = Particles::EnergyAccount;

namespace {

constexpr double spacing = 2e-3;

BoxCase elastic_gas(int side) {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(side * spacing)).periodic();
  setup.set("material_bead_young_modulus", "1e6").set("material_bead_restitution", "1");
  setup.set("material_bead_friction", "0").set("particles_energy", "yes");
  return setup;
}

/// Largest change of kinetic + stored energy over `time`, as a share of the energy, of side^3 spheres; steps a `share`
/// of the automatic.
double energy_error(double share, int automatic_steps, const std::string& integrator = "velocity_verlet",
                    int side = 6) {
  BoxCase setup = elastic_gas(side);
  setup.set("particles_step_fraction", std::to_string(0.05 * share)).set("particles_integrator", integrator);
  setup.set("particles_rayleigh_fraction", std::to_string(0.2 * share)).set("particles_speed", "0.6");
  BoxRun run(setup);
  run.particles.add(gas(side, Vec3::Zero(), Vec3::Constant(side * spacing), 0.85e-3, 0.3));
  const double h = run.particles.time_step() / share, start = run.particles.energy_account().kinetic;
  double largest = 0;
  for (int n = 0; n < automatic_steps; ++n) {
    run.particles.advance(n * h, h);
    const auto account = run.particles.energy_account();
    largest = std::max(largest, std::abs(account.kinetic + account.stored - start));
  }
  return largest / start;
}

double relative(double a, double b) { return std::abs(a - b) / std::abs(b); }

}  // namespace

TEST_CASE("An elastic frictionless gas keeps its energy at the automatic step, at second order in the step") {
  const double whole = energy_error(1, 1500), half = energy_error(0.5, 1500), quarter = energy_error(0.25, 1500);
  INFO(whole << " " << half << " " << quarter);
  CHECK(whole < 1e-3);
  CHECK(std::log2(whole / quarter) / 2 == Approx(2).margin(0.3));
}

TEST_CASE("An elastic frictionless gas keeps its energy to a thousandth over 1e5 automatic steps", "[slow]") {
  // Where collisions gain or lose by the place of the steps in them, 216 spheres end beyond it (1.6e-3).
  CHECK(energy_error(1, 100000) < 1e-3);
}

TEST_CASE("With semi-implicit Euler the energy of an elastic gas swings at first order, and does not drift") {
  CHECK(energy_error(1, 500, "semi_implicit_euler") < 0.1);
  CHECK(energy_error(1, 4000, "semi_implicit_euler") < 0.1);
  CHECK(energy_error(0.25, 1000, "semi_implicit_euler") < 0.03);
}

TEST_CASE("In a dissipative pack the energy ledger closes to a thousandth of what is dissipated, on any rank count",
          "[particles][mpi]") {
  for (const std::string integrator : {"velocity_verlet", "leapfrog", "semi_implicit_euler"}) {
    BoxCase setup;
    setup.gravity = {0, 0, -9.81};
    setup.box(Vec3::Zero(), Vec3::Constant(8e-3));
    setup.set("material_bead_young_modulus", "1e6").set("material_bead_restitution", "0.7");
    setup.set("material_bead_friction", "0.4").set("material_bead_rolling_friction", "0.05");
    setup.set("rolling_type", "epsd").set("twisting_type", "twisting").set("particles_speed", "1");
    setup.set("particles_energy", "yes").set("particles_integrator", integrator);
    BoxRun run(setup);
    run.particles.add(gas(5, Vec3::Zero(), Vec3::Constant(8e-3), 0.72e-3, 0.3, 0.1));
    const double dt = 1e-3;
    double largest = 0;
    Account account;
    for (int n = 0; n < 60; ++n) {
      run.particles.advance(n * dt, dt);
      account = run.particles.energy_account();
      largest = std::max(largest, std::abs(account.residual()));
    }
    INFO(integrator << ": residual " << largest << " of " << account.dissipated());
    CHECK(account.dissipated() > 0.5 * account.work[Account::added]);
    CHECK(largest < (integrator == "semi_implicit_euler" ? 2e-2 : 1e-3) * account.dissipated());
    for (const auto m : {Account::damping, Account::friction, Account::rolling}) CHECK(account.work[m] < 0);
    CHECK(account.work[Account::gravity] > 0);
    CHECK(account.work[Account::walls] == 0);
    CHECK(account.work[Account::fluid] == 0);
  }
}

TEST_CASE("A ball that comes to roll gives 2/7 of its energy to friction, and gravity does m g h in a fall") {
  BoxCase setup;
  setup.gravity = {0, 0, -9.81};
  setup.box({-0.02, -0.02, 0}, {0.06, 0.02, 0.04});
  setup.set("material_bead_young_modulus", "1e7").set("material_bead_friction", "0.3").set("particles_energy", "yes");
  const double radius = 1e-3, speed = 0.2;
  BoxRun run(setup);
  const double mass = 2500 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  // Where its weight is carried: k x^1.5 = m g with k = 4/3 E/(2 (1 - nu^2)) sqrt(R); it starts a little too high.
  run.particles.add({sphere({0, 0, 0.999999 * radius}, {speed, 0, 0}, radius)});
  for (int n = 0; n < 60; ++n) run.particles.advance(n * 1e-3, 1e-3);
  const auto account = run.particles.energy_account();
  CHECK(run.particles.velocity(0)[0] == Approx(5.0 / 7 * speed).epsilon(2e-3));
  CHECK(account.work[Account::friction] == Approx(-mass * speed * speed / 7).epsilon(5e-3));
  CHECK(std::abs(account.residual()) < 1e-4 * account.dissipated());

  BoxRun fall(setup);
  fall.particles.add({sphere({0, 0, 0.03}, Vec3::Zero(), radius)});
  for (int n = 0; n < 40; ++n) fall.particles.advance(n * 1e-3, 1e-3);
  const double height = 0.03 - fall.particles.position(0)[2];
  CHECK(fall.particles.energy_account().work[Account::gravity] == Approx(mass * 9.81 * height).epsilon(1e-10));
}

TEST_CASE("A moving wall that hits a ball at rest does the work 2 m V^2, and an elastic spring gives all back") {
  BoxCase setup;
  setup.box(Vec3::Constant(-0.02), Vec3::Constant(0.02));
  setup.set("material_bead_young_modulus", "1e6").set("material_bead_restitution", "1").set("particles_energy", "yes");
  setup.set("material_bead_friction", "0");
  setup.set("wall_piston_type", "plane").set("wall_piston_point", "-0.012, 0, 0").set("wall_piston_normal", "1, 0, 0");
  setup.set("wall_piston_velocity", "0.3, 0, 0");
  const double radius = 1e-3, speed = 0.3, mass = 2500 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  setup.set("particles_speed", "0.6");
  BoxRun run(setup);
  run.particles.add({sphere({-0.0105, 0, 0}, Vec3::Zero(), radius)});
  for (int n = 0; n < 20; ++n) run.particles.advance(n * 1e-3, 1e-3);
  const auto account = run.particles.energy_account();
  CHECK(run.particles.velocity(0)[0] == Approx(2 * speed).epsilon(1e-3));
  CHECK(relative(account.work[Account::walls], 2 * mass * speed * speed) < 2e-3);
  CHECK(account.stored == 0);
  CHECK(std::abs(account.work[Account::elastic]) < 1e-3 * account.kinetic);
  CHECK(std::abs(account.residual()) < 1e-3 * account.kinetic);
}

TEST_CASE("What the fluid gives, and what comes and goes, is in the account of energy") {
  BoxCase setup;
  setup.box(Vec3::Constant(-0.02), Vec3::Constant(0.02));
  setup.set("material_bead_young_modulus", "1e6").set("particles_energy", "yes").set("particles_speed", "1");
  setup.set("boundary_x_max_particles", "outlet");
  const double radius = 1e-3, mass = 2500 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  BoxRun run(setup);
  run.particles.add({sphere({0.015, 0, 0}, {1, 0, 0}, radius), sphere({-0.015, 0, 0}, Vec3::Zero(), radius)});
  CHECK(run.particles.energy_account().work[Account::added] == Approx(0.5 * mass).epsilon(1e-12));
  for (int i = 0; i < 2; ++i) {
    FluidAction& action = run.particles.fluid_action(i);
    action.exchange = run.particles.id(i) == 1 ? 100 * mass : 0;
    action.velocity[0] = 0.5;
  }
  for (int n = 0; n < 10; ++n) run.particles.advance(n * 1e-3, 1e-3);
  const auto account = run.particles.energy_account();
  REQUIRE(run.particles.total() == 1);
  CHECK(account.work[Account::removed] == Approx(0.5 * mass).epsilon(1e-12));
  const double speed = 0.5 * -std::expm1(-1.0);
  CHECK(account.work[Account::fluid] == Approx(0.5 * mass * speed * speed).epsilon(1e-9));
  CHECK(std::abs(account.residual()) < 1e-12 * account.work[Account::added]);
}
