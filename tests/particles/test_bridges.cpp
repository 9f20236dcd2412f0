#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gas_box.hpp"
#include "law_cases.hpp"
#include "reference_path.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi;

BoxCase& wet(BoxCase& setup) {
  setup.set("bridge_type", "capillary").set("bridge_surface_tension", "0.07").set("bridge_contact_angle", "20");
  return setup.set("bridge_viscosity", "1e-3").set("bridge_roughness", "1e-6").set("bridge_liquid_content", "0.01");
}

double ball(double radius) { return 4.0 / 3.0 * pi * radius * radius * radius; }

}  // namespace

TEST_CASE("A liquid bridge pulls with 4 pi R sigma cos(theta) in contact, less as it stretches, and resists the flow",
          "[particles]") {
  const LawRun run(LawCase().choose("bridge", "capillary"), 1e-3, 1e-3);
  const double radius = 0.5e-3, volume = 2e-12, tension = 4 * pi * 0.07 * std::cos(20 * pi / 180);
  std::vector<double> history(run.laws.history_components() + 1);
  history[run.laws.setup().bridge.first_history] = 0.5 * volume;
  history[run.laws.setup().bridge.first_history + 1] = 0.5 * volume;
  const auto pull = [&](double gap, double approach) {
    Contact<double> contact{};
    contact.normal[2] = 1;
    contact.overlap = -gap, contact.approach = approach, contact.radius = 1e-3, contact.distance = 2e-3 + gap;
    contact.effective_radius = radius, contact.effective_mass = 1e-6;
    return loads_of(run.laws, contact, run.laws.pair(0, 0), 1e-3, 1e-3, 0, history.data()).pull;
  };
  CHECK(pull(-1e-7, 0) == Approx(-tension * radius));
  for (const double gap : {1e-6, 2e-5, 1e-4}) {
    const double shape = 1 - 1 / std::sqrt(1 + volume / (pi * radius * gap * gap));
    CHECK(pull(gap, 0) == Approx(-tension * radius * shape));
    const double viscous = 6 * pi * 0.01 * radius * radius * shape * shape * 0.02 / gap;
    CHECK(pull(gap, 0.02) - pull(gap, 0) == Approx(viscous));
    CHECK(pull(gap, -0.02) - pull(gap, 0) == Approx(-viscous));
  }
  CHECK(pull(-1e-7, 0.02) - pull(-1e-7, 0) == Approx(6 * pi * 0.01 * radius * radius * 0.02 / 1e-6));
  history.assign(history.size(), 0.0);
  CHECK(pull(1e-5, 0.02) == 0);  // dry
}

TEST_CASE("Willett's bridge has the forces and the rupture distance of his formulas, and the force of Yade's check",
          "[particles]") {
  struct Spheres {
    double r1, r2, volume, tension, degrees;
  };
  const auto check = [](const Spheres& s, const std::vector<std::pair<double, double>>& forces) {
    const double radius = s.r1 * s.r2 / (s.r1 + s.r2);
    CapillaryBridge law;
    law.surface_tension = s.tension, law.liquid_content = 0.01, law.contact_angle = s.degrees;
    law.force_law = law.rupture = "willett";
    const auto constants = law.constants({});
    for (const auto& [gap, force] : forces) {
      Contact<double> contact{};
      contact.overlap = -gap, contact.effective_radius = radius;
      CHECK(CapillaryBridge::force<double>(contact, constants, {0.5 * s.volume, 0.5 * s.volume, 0, 0}) ==
            Approx(-force).epsilon(2e-5));
    }
    return law.rupture_distance(s.volume, radius, 0);
  };
  // Willett et al. 2000, eq. 12, in the values of Yade's check, and spheres of 1 mm with 0.01 ul of water.
  check({19e-6, 32.5e-6, 1.2e-18, 0.024, 10}, {{2.49e-7 - 1e-5 * 51.5e-6, 6.78192e-7}});
  CHECK(check({1e-3, 1e-3, 1e-11, 0.0728, 0},
              {{0, 4.5742e-4}, {1e-5, 4.0479e-4}, {5e-5, 2.1275e-4}, {1e-4, 1.0053e-4}}) ==
        Approx(2.2009e-4).epsilon(2.5e-5));
}

TEST_CASE("A bridge takes its liquid from both films and gives it back where it breaks", "[particles]") {
  for (const bool printed : {false, true}) {
    BoxCase setup;
    setup.box(Vec3::Zero(), Vec3::Constant(10e-3));
    wet(setup).set("bridge_rupture", printed ? "printed" : "lian").set("particles_speed", "0.3");
    BoxRun run(setup);
    const double r0 = 0.5e-3, r1 = 0.8e-3, radius = r0 * r1 / (r0 + r1), speed = 0.3;
    run.particles.add({sphere(Vec3(5e-3, 5e-3, 5e-3), Vec3::Zero(), r0),
                       sphere(Vec3(5e-3 + r0 + r1 - 1e-8, 5e-3, 5e-3), Vec3(speed, 0, 0), r1)});
    const int film = run.particles.columns().find("film");
    REQUIRE(film >= 0);
    const double full0 = 0.01 * ball(r0), full1 = 0.01 * ball(r1);
    const auto share = [](double own, double other) {
      return 0.5 * (1 - std::sqrt(1 - std::pow(other / (own + other), 2)));
    };
    const double volume = share(r0, r1) * full0 + share(r1, r0) * full1;
    const auto film_of = [&](std::int64_t id) {
      for (int i = 0; i < 2; ++i)
        if (run.particles.id(i) == id) return *run.particles.columns().row(film, i);
      return -1.0;
    };
    const double dt = run.particles.time_step();
    bool bridged = false, broken = false;
    double before = 0;
    for (int n = 0; n < 20000 && !broken; ++n) {
      run.particles.advance(n * dt, dt);
      const auto state = gather(run.particles);
      const Vec3 apart = vec3(state.at(1).x) - vec3(state.at(0).x);
      const double gap = apart.norm() - r0 - r1;
      const double rate = (vec3(state.at(1).v) - vec3(state.at(0).v)).dot(apart.normalized());
      CHECK(run.particles.liquid_volume() == Approx(full0 + full1).epsilon(1e-14));
      if (film_of(0) < full0 * (1 - 1e-9)) {
        bridged = true;
        CHECK(film_of(0) == Approx(full0 * (1 - share(r0, r1))));
        CHECK(film_of(1) == Approx(full1 * (1 - share(r1, r0))));
      } else if (bridged) {
        broken = true;
        const double size = printed ? volume / (4 * radius * radius) : std::cbrt(volume);
        const double end = (1 + 10 * pi / 180) * (1 + std::sqrt(1e-3 * std::abs(rate) / 0.07)) * size;
        CHECK(gap == Approx(end).margin(2 * speed * dt));
        CHECK(before < end);
      }
      before = gap;
    }
    CHECK(broken);
  }
}

TEST_CASE("A wet pair too slow to break its bridge swings and stays together", "[particles]") {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(10e-3));
  wet(setup).set("particles_speed", "0.1");
  BoxRun run(setup);
  const double radius = 0.5e-3;
  run.particles.add({sphere(Vec3(5e-3, 5e-3, 5e-3), Vec3(-0.01, 0, 0), radius),
                     sphere(Vec3(6e-3 - 1e-8, 5e-3, 5e-3), Vec3(0.01, 0, 0), radius)});
  double widest = 0;
  for (int n = 0; n < 2000; ++n) {
    run.particles.advance(n * 5e-6, 5e-6);
    const auto state = gather(run.particles);
    widest = std::max(widest, (vec3(state.at(1).x) - vec3(state.at(0).x)).norm() - 2 * radius);
  }
  CHECK(widest > 1e-7);
  CHECK(widest < 1e-4);
}

TEST_CASE("The liquid of films and bridges is constant to round-off while bridges form and break on any ranks",
          "[particles][mpi]") {
  for (const bool walls : {false, true}) {
    BoxCase setup;
    const double radius = 0.5e-3, side = 7e-3;
    setup.box(Vec3::Zero(), Vec3::Constant(side));
    if (!walls) setup.periodic();
    wet(setup).set("particles_speed", "1").set("bridge_surface_tension", "0.01");
    BoxRun run(setup);
    run.particles.add(gas(6, Vec3::Zero(), Vec3::Constant(side), radius, 0.5, 0.1));
    const double liquid = run.particles.liquid_volume();
    CHECK(liquid > 0.009 * 216 * ball(radius));
    const int film = run.particles.columns().find("film");
    double least = 1;
    for (int n = 0; n < 10; ++n) {
      run.particles.advance(n * 1e-3, 1e-3);
      CHECK(std::abs(run.particles.liquid_volume() - liquid) < 1e-13 * liquid);
      for (int i = 0; i < run.particles.owned(); ++i)
        least = std::min(least, *run.particles.columns().row(film, i) / (0.01 * run.particles.volume(i)));
    }
    CHECK(mpi_max(-least) > -0.95);  // bridges there are
    CHECK(mpi_max(-least) < 0);      // and no film is overdrawn
  }
}

TEST_CASE("Bridges without tension, content or roughness are refused", "[particles]") {
  CHECK_THROWS_WITH(LawRun(LawCase().set("bridge_type", "capillary")), Catch::Contains("-bridge_surface_tension"));
  CHECK_THROWS_WITH(LawRun(LawCase().set("bridge_type", "capillary").set("bridge_surface_tension", "0.07")),
                    Catch::Contains("-bridge_liquid_content"));
  CHECK_THROWS_WITH(LawRun(LawCase()
                               .set("bridge_type", "capillary")
                               .set("bridge_surface_tension", "0.07")
                               .set("bridge_liquid_content", "0.01")
                               .set("bridge_viscosity", "1")),
                    Catch::Contains("-bridge_roughness"));
}
