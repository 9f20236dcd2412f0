#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <numbers>

#include "base/error.hpp"
#include "coupled_case.hpp"

using namespace silt;
using test::CoupledCase;

namespace {

constexpr double pi = std::numbers::pi;

/// A box 4 x 4 x 4 cm, 8 cells a side, with a prescribed flow and no filter.
CoupledCase given_flow(const std::string& velocity) {
  CoupledCase run;
  run.set("mesh_lower", "-0.02, -0.02, -0.02").set("mesh_upper", "0.02, 0.02, 0.02").set("mesh_cells", "8, 8, 8");
  run.set("fluid_type", "prescribed").set("fluid_velocity", velocity).set("fluid_density", "1000");
  run.set("fluid_viscosity", "1e-3").set("coupling_filter_length", "0").set("drag_type", "none");
  run.set("material_bead_density", "2500").set("particles_speed", "1").set("material_bead_young_modulus", "1e5");
  return run;
}

Seed bead(const Vec3& position, const Vec3& velocity, double diameter, const Vec3& spin = Vec3::Zero()) {
  Seed seed;
  seed.position = position, seed.velocity = velocity, seed.spin = spin, seed.radius = diameter / 2;
  return seed;
}

/// The force of the chosen laws on the only particle, with the flow at the start.
Vec3 reaction(CoupledCase& run) {
  run.coupling->before_particles(1e-4);
  return run.particles->owned() ? Vec3(vec3(run.particles->fluid_action(0).reaction)) : Vec3::Zero();
}

}  // namespace

TEST_CASE("Saffman and Mei's lift drives a particle that lags a shear flow towards the faster fluid", "[forces]") {
  const double G = 20, d = 1e-3, rho = 1000, mu = 1e-3;
  for (const double slip : {1e-3, 0.02, 0.2}) {
    auto run = given_flow("20*y, 0, 0");
    run.set("saffman_type", "saffman_mei");
    run.create({bead(Vec3(1e-3, 5e-3, 2e-3), Vec3(G * 5e-3 - slip, 0, 0), d)});
    const double re = rho * d * slip / mu, b = 0.5 * d * G / slip;
    const double f = re <= 40 ? (1 - 0.3314 * std::sqrt(b)) * std::exp(-re / 10) + 0.3314 * std::sqrt(b)
                              : 0.0524 * std::sqrt(b * re);
    // Saffman's 6.46 (d/2)^2 (rho mu G)^1/2 slip, towards +y.
    const Vec3 expected(0, 6.46 * d * d / 4 * std::sqrt(rho * mu * G) * slip * f, 0);
    CHECK((reaction(run) - expected).norm() < 1e-9 * expected.norm());
  }
}

TEST_CASE("A ball with back spin is lifted: Rubinow and Keller's force, less by Lun and Liu's factor beyond Re = 1",
          "[forces]") {
  const double d = 1e-3, rho = 1000, w = 30, v = 0.05;
  for (const std::string law : {"rubinow_keller", "lun_liu"}) {
    auto run = given_flow("0, 0, 0");
    run.set("magnus_type", law);
    run.create({bead(Vec3::Zero(), Vec3(v, 0, 0), d, Vec3(0, 0, w))});
    const double creeping = pi / 8 * d * d * d * rho * w * v;
    const double factor = law == "lun_liu" ? 0.178 + 0.822 * std::pow(50, -0.522) : 1;
    CHECK((reaction(run) - Vec3(0, factor * creeping, 0)).norm() < 1e-12 * creeping);
  }
  auto turned = given_flow("20*y, 0, 0");  // a particle that turns with the fluid, -G/2, is not lifted
  turned.set("magnus_type", "rubinow_keller");
  turned.create({bead(Vec3::Zero(), Vec3(v, 0, 0), d, Vec3(0, 0, -10))});
  CHECK(reaction(turned).norm() < 1e-18);
}

TEST_CASE("With virtual mass a bubble rises from rest with 2 g and is accelerated thrice as much as the fluid",
          "[forces]") {
  auto rising = given_flow("0, 0, 0");
  rising.gravity = Vec3(0, 0, -9.81);
  rising.set("virtual_mass_coefficient", "0.5").set("material_bead_density", "1e-3");
  rising.create({bead(Vec3::Zero(), Vec3::Zero(), 1e-3)});
  for (int n = 0; n < 5; ++n) rising.step(1e-3);
  const double rise = 9.81 * (1000 - 1e-3) / (1e-3 + 500);
  CHECK(rising.particles->velocity(0)[2] == Approx(rise * 5e-3).epsilon(1e-9));

  // u = a t, p = -rho a x: m dv/dt = V rho a + C rho V (a - dv/dt).
  for (const double density : {1.0, 2500.0}) {
    auto pushed = given_flow("0.5*t, 0, 0");
    pushed.set("fluid_pressure", "-500*x").set("virtual_mass_coefficient", "0.5");
    pushed.set("material_bead_density", fmt::format("{}", density));
    pushed.create({bead(Vec3::Zero(), Vec3::Zero(), 1e-3)});
    for (int n = 0; n < 3; ++n) pushed.step(1e-3);  // du/dt and grad p are known after the first step
    const double before = pushed.particles->velocity(0)[0];
    for (int n = 0; n < 10; ++n) pushed.step(1e-3);
    const double rate = (pushed.particles->velocity(0)[0] - before) / 10e-3;
    CHECK(rate == Approx(0.5 * 1.5 * 1000 / (density + 500)).epsilon(1e-9));
  }
}

TEST_CASE("The spin of a particle relaxes as exp(-60 mu t/(rho_p d^2)) to half the vorticity, whatever the step",
          "[forces]") {
  const double d = 1e-3;
  for (const double dt : {1e-3, 0.1}) {
    auto run = given_flow("20*y, 0, 0");
    run.set("viscous_torque_type", "stokes");
    run.create({bead(Vec3::Zero(), Vec3::Zero(), d, Vec3(3, 0, 50))});
    for (int n = 0; n < 3; ++n) run.step(dt);
    const double left = std::exp(-60 * 1e-3 * 3 * dt / (2500 * d * d));
    CHECK(run.particles->spin(0)[2] == Approx(-10 + 60 * left).epsilon(1e-10));
    CHECK(run.particles->spin(0)[0] == Approx(3 * left).epsilon(1e-10));
  }
  auto fast = given_flow("0, 0, 0");
  fast.set("viscous_torque_type", "dennis");
  fast.create({bead(Vec3::Zero(), Vec3::Zero(), d, Vec3(0, 0, 200))});
  fast.coupling->before_particles(1e-4);
  const double re = 1000 * d * d * 200 / 1e-3;  // 200: M = (rho/2) (d/2)^5 (12.9 Re^-1/2 + 128.4/Re) w^2
  const double torque = 0.5 * 1000 * std::pow(d / 2, 5) * (12.9 / std::sqrt(re) + 128.4 / re) * 200 * 200;
  CHECK(fast.particles->fluid_action(0).spin_exchange * 200 == Approx(torque));
}

TEST_CASE("A particle in a parabolic flow feels V div tau of the flow without it", "[forces]") {
  auto run = given_flow("0, 0, 30*y^2");
  run.set("coupling_viscous_stress", "yes");
  run.create({bead(Vec3(0, 1e-3, 0), Vec3::Zero(), 1e-3)});
  const Vec3 expected(0, 0, 2 * 1e-3 * 30 * pi / 6 * 1e-9);
  CHECK((reaction(run) - expected).norm() < 1e-9 * expected.norm());
}

TEST_CASE("What lift, virtual mass and stress give the particles the fluid loses, to round-off", "[forces][mpi]") {
  CoupledCase run;
  run.set("mesh_upper", "0.02, 0.02, 0.02").set("mesh_cells", "6, 6, 6").set("mesh_periodic", "1, 1, 1");
  run.set("fluid_density", "1000")
      .set("fluid_viscosity", "1e-2")
      .set("fluid_initial_velocity", "0.1*sin(314.159*y), 0, 0.02");
  run.set("saffman_type", "saffman_mei").set("magnus_type", "lun_liu").set("virtual_mass_coefficient", "0.5");
  run.set("viscous_torque_type", "dennis").set("coupling_viscous_stress", "yes").set("drag_type", "schiller_naumann");
  run.set("material_bead_density", "1200").set("material_bead_young_modulus", "1e5").set("particles_speed", "0.5");
  std::vector<Seed> seeds;
  for (int k = 0; k < 64; ++k)
    seeds.push_back(bead(5e-3 * Vec3(k % 4 + 0.5, k / 4 % 4 + 0.5, k / 16 + 0.5), Vec3(0.1 * std::sin(k), 0.05, 0),
                         2e-3, Vec3(0, 10 * std::cos(k), 20)));
  run.create(seeds);
  run.particles->take_impulses();
  Vec3 before = run.particles->momentum();
  double largest = 0;
  for (int n = 0; n < 5; ++n) {
    run.step(2e-3);
    const auto& ledger = run.coupling->ledger();
    CHECK(ledger.residual < 1e-12);
    largest = std::max(largest, ledger.forces_on_particles.norm());
    const auto in = run.particles->take_impulses();
    const Vec3 now = run.particles->momentum(), sum = in.drag + in.fluid_force + in.kicks + in.walls;
    const double scale = in.drag.norm() + in.fluid_force.norm() + in.kicks.norm();
    CHECK((now - before - sum).norm() < 1e-11 * scale);
    CHECK((in.fluid_force - ledger.delivered - ledger.buoyancy - ledger.forces_on_particles).norm() < 1e-11 * scale);
    before = now;
  }
  CHECK(largest > 0);
}

TEST_CASE("A prescribed void fraction is what the drag law sees", "[forces]") {
  auto run = given_flow("0.1, 0, 0");
  run.set("drag_type", "wen_yu").set("fluid_void_fraction", "0.6");
  run.create({bead(Vec3::Zero(), Vec3::Zero(), 1e-3)});
  run.coupling->before_particles(1e-4);
  CHECK(run.particles->fluid_action(0).exchange == Approx(WenYuDrag{}.exchange({1e-3, 0.6, 1000, 1e-3, 0.1})));
  auto wrong = given_flow("0, 0, 0");
  wrong.set("fluid_void_fraction", "1 + x");
  CHECK_THROWS_AS(wrong.create({}), UserError);
}
