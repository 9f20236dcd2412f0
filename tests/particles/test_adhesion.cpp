#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gas_box.hpp"
#include "law_cases.hpp"
#include "particles/adhesion/tabor.hpp"
#include "reference_path.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi;

/// An adhesive contact of effective radius R, pushed and pulled by hand.
struct Pulled {
  LawRun run;
  double radius, young, work;  ///< m; Pa; J/m2 of adhesion
  std::vector<double> history;
  Loads loads;

  explicit Pulled(const LawCase& setup, double r = 1e-4)
      : run(setup, 2 * r, 2 * r), radius(r), history(run.laws.history_components() + 1) {
    const PairProperties pair = run.laws.pair(0, 0);
    young = pair.effective_young, work = 2 * pair.surface_energy;
  }
  double force(double overlap, double slip = 0) {
    Contact<double> contact{};
    contact.normal[2] = 1;
    contact.overlap = overlap, contact.slip[0] = slip;
    contact.effective_radius = radius, contact.effective_mass = 1e-9;
    contact.radius = 2 * radius, contact.distance = 4 * radius - overlap;
    // Without slip as if at rest: no step has led here.
    const double dt = slip != 0 ? 1e-9 : 0;
    loads = loads_of(run.laws, contact, run.laws.pair(0, 0), 2 * radius, 2 * radius, dt, history.data());
    return loads.normal.force + loads.pull;
  }
};

LawCase sticky(const char* adhesion) {
  LawCase setup;
  setup.set("adhesion_type", adhesion).set("material_bead_surface_energy", "0.05");
  return setup.set("material_bead_restitution", "1");
}

/// A sphere of 50 um radius that meets the wall x = 0 at a speed, long after: its distance in radii and its speed as a
/// share of the first.
struct Rebound {
  double distance, speed;
};
Rebound rebound(double speed) {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(1e-3));
  setup.set("adhesion_type", "jkr").set("material_bead_surface_energy", "0.01").set("material_bead_restitution", "1");
  setup.set("particles_speed", "0.1").set("particles_step", "5e-8");
  BoxRun run(setup);
  const double radius = 50e-6;
  run.particles.add({sphere(Vec3(radius + 1e-7, 5e-4, 5e-4), Vec3(-speed, 0, 0), radius)});
  run.particles.advance(0, 3e-4);
  const State state = gather(run.particles).at(0);
  return {state.x[0] / radius, state.v[0] / speed};
}

}  // namespace

TEST_CASE("The JKR force has the figures of Johnson, Kendall and Roberts", "[particles]") {
  Pulled contact(sticky("jkr"));
  const double pull_off = 1.5 * pi * contact.work * contact.radius;
  const double size = std::cbrt(9 * pi * contact.work * std::pow(contact.radius, 2) / (2 * contact.young));
  CHECK(contact.force(-1e-12) == 0);  // nothing before touching
  CHECK(contact.force(0) == Approx(-8.0 / 9.0 * pull_off).epsilon(1e-9));
  CHECK(contact.loads.normal.contact_radius == Approx(size * std::cbrt(4.0 / 9.0)));
  CHECK(std::abs(contact.force(size * size / (3 * contact.radius))) < 1e-9 * pull_off);  // at rest
  CHECK(contact.loads.normal.contact_radius == Approx(size));
  CHECK(contact.loads.normal.stiffness == Approx(1.2 * contact.young * size));
  const double end = 0.75 * std::cbrt(std::pow(pi * contact.work / contact.young, 2) * contact.radius);
  CHECK(contact.run.laws.setup().leave_gap ==
        Approx(1.001 * 0.75 * std::cbrt(std::pow(pi * contact.work / contact.young, 2) * 2 * contact.radius))
            .epsilon(1e-6));
  double least = 0;
  for (int k = 0; k < 10000; ++k) least = std::min(least, contact.force(-end * k / 10000));
  CHECK(least == Approx(-pull_off).epsilon(1e-6));
  CHECK(contact.force(-end * (1 - 1e-9)) == Approx(-5.0 / 9.0 * pull_off).epsilon(1e-4));
  CHECK(contact.force(-end * (1 + 1e-9)) == 0);
  CHECK(contact.force(-0.5 * end) == 0);  // broken until it touches again
  CHECK(contact.force(1e-12) < -0.88 * pull_off);
}

TEST_CASE("A make and break of a JKR contact loses 7.09 (w^5 R^4/E^2)^(1/3), however finely it is followed",
          "[particles]") {
  for (const int steps : {2000, 20000}) {
    Pulled contact(sticky("jkr"));
    const double end = 0.75 * std::cbrt(std::pow(pi * contact.work / contact.young, 2) * contact.radius);
    double lost = 0;
    const double from = -1.5 * end, to = 6 * end, step = (to - from) / steps;
    for (int k = 0; k < steps; ++k) lost += contact.force(from + (k + 0.5) * step) * step;
    for (int k = steps - 1; k >= 0; --k) lost -= contact.force(from + (k + 0.5) * step) * step;
    const double exact =
        7.0922 * std::cbrt(std::pow(contact.work, 5) * std::pow(contact.radius, 4) / std::pow(contact.young, 2));
    CHECK(lost == Approx(exact).epsilon(steps > 10000 ? 1e-3 : 1e-2));
  }
}

TEST_CASE("Without surface energy the JKR force is that of Hertz", "[particles]") {
  Pulled contact(sticky("jkr").set("material_bead_surface_energy", "0")), hertz(LawCase{});
  for (const double overlap : {1e-9, 1e-7, 1e-5}) {
    const double expected = hertz.force(overlap);
    CHECK(contact.force(overlap) == Approx(expected).epsilon(1e-9));
    CHECK(contact.loads.normal.contact_radius == Approx(hertz.loads.normal.contact_radius).epsilon(1e-9));
    CHECK(contact.loads.normal.stiffness == Approx(hertz.loads.normal.stiffness).epsilon(1e-6));
  }
  CHECK(contact.force(-1e-9) == 0);
}

TEST_CASE("The DMT force is that of Hertz less 4 pi g R, and gives back what it took", "[particles]") {
  Pulled contact(sticky("dmt")), hertz(sticky("none"));
  const double pull_off = 2 * pi * contact.work * contact.radius;
  for (const double overlap : {1e-12, 1e-7, 1e-6})
    CHECK(contact.force(overlap) == Approx(hertz.force(overlap) - pull_off).epsilon(1e-9));
  CHECK(contact.force(-1e-12) == 0);
  double cycle = 0;
  for (int k = 0; k < 1000; ++k) cycle += contact.force((k + 0.5) * 1e-9);
  for (int k = 999; k >= 0; --k) cycle -= contact.force((k + 0.5) * 1e-9);
  CHECK(std::abs(cycle) < 1e-9 * pull_off * 1000);
}

TEST_CASE("Adhesive friction is limited by mu |F + 2 F_c|, or by mu |F| if asked", "[particles]") {
  for (const char* adhesion : {"jkr", "dmt"})
    for (const bool thornton : {true, false}) {
      Pulled contact(sticky(adhesion)
                         .set("material_bead_friction", "0.3")
                         .set("adhesion_friction", thornton ? "thornton_yin" : "net"));
      const double pull_off = (adhesion[0] == 'j' ? 1.5 : 2) * pi * contact.work * contact.radius;
      contact.force(3e-7);
      const double net = contact.force(3e-7, 1e6);  // slides far beyond the limit
      CHECK(contact.loads.force[0] == Approx(-0.3 * std::abs(net + (thornton ? 2 * pull_off : 0))).epsilon(1e-9));
      CHECK(contact.loads.force[2] == Approx(net));
    }
}

TEST_CASE("The automatic choice takes DMT for hard small spheres and JKR for soft large ones, and says so",
          "[particles]") {
  CHECK(tabor_parameter(1e-6, 0.05, 1e9, 0.4e-9) == Approx(std::cbrt(4e-6 * 0.0025 / (1e18 * 6.4e-29))));
  for (const bool hard : {true, false}) {
    const char* young = hard ? "1e12" : "1e7";
    const double radius = hard ? 1e-8 : 1e-4;
    Pulled automatic(sticky("auto").set("material_bead_young_modulus", young), radius);
    Pulled expected(sticky(hard ? "dmt" : "jkr").set("material_bead_young_modulus", young), radius);
    for (const double overlap : {0.0, 1e-4 * radius, 3e-4 * radius, -1e-6 * radius})
      CHECK(automatic.force(overlap) == expected.force(overlap));
    REQUIRE(automatic.run.laws.notices().size() == 1);
    CHECK_THAT(automatic.run.laws.notices()[0], Catch::Contains(hard ? "where dmt holds" : "where jkr holds"));
  }
}

TEST_CASE("Adhesion with a spring that is not Hertz's is refused with the reason", "[particles]") {
  for (const char* normal : {"linear", "walton_braun", "thornton", "langston", "lennard_jones"}) {
    LawCase setup = sticky("jkr").choose("normal", normal);
    CHECK_THROWS_WITH(LawRun(setup), Catch::Contains("Hertz spring"));
  }
  CHECK_THROWS_WITH(LawRun(sticky("dmt").set("normal_no_attraction", "yes")), Catch::Contains("exclude"));
}

TEST_CASE("A sphere sticks to a wall below the sticking speed and bounces above it as the energy lost tells",
          "[particles]") {
  const double radius = 50e-6, work = 0.02, young = 0.5 * 1e7 / (1 - 0.09), density = 2500;
  const double sticking =
      1.8402 * std::pow(std::pow(work, 5) / (std::pow(radius, 5) * young * young * std::pow(density, 3)), 1.0 / 6);
  CHECK(rebound(0.9 * sticking).distance < 1.01);
  for (const double ratio : {1.5, 3.0}) {
    CHECK(rebound(ratio * sticking).speed == Approx(std::sqrt(1 - 1 / (ratio * ratio))).epsilon(1e-2));
  }
}

TEST_CASE("A rolling neck has the stiffness 4 F_c (a/a0)^1.5 over the rolling displacement", "[particles]") {
  Pulled contact(sticky("jkr").set("rolling_type", "spring").set("rolling_critical_angle", "1e9"));
  const double size = std::cbrt(9 * pi * contact.work * std::pow(contact.radius, 2) / (2 * contact.young));
  Contact<double> pair{};
  pair.normal[2] = 1;
  pair.overlap = 3e-7, pair.spin[1] = 2;
  pair.effective_radius = contact.radius, pair.effective_mass = 1e-9, pair.radius = 2 * contact.radius;
  pair.distance = 4 * contact.radius, pair.rolling_inertia = 1;
  const double dt = 1e-6;
  Loads loads;
  for (int k = 0; k < 2; ++k)
    loads = loads_of(contact.run.laws, pair, contact.run.laws.pair(0, 0), 0, 0, dt, contact.history.data());
  const double ratio = loads.normal.contact_radius / size, pull_off = 1.5 * pi * contact.work * contact.radius;
  const double displacement = 1.5 * dt * 2 * contact.radius;
  CHECK(loads.torque_i[1] == Approx(-4 * pull_off * std::pow(ratio, 1.5) * displacement).epsilon(1e-6));
}

TEST_CASE("A stuck pair keeps its neck through rebuilds and periodic sides", "[particles][mpi]") {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(1e-3)).periodic();
  setup.set("adhesion_type", "jkr").set("material_bead_surface_energy", "0.01").set("material_bead_restitution", "1");
  BoxRun run(setup);
  const double radius = 50e-6, work = 0.02, young = 0.5 * 1e7 / (1 - 0.09), effective = radius / 2;
  const double size = std::cbrt(9 * pi * work * effective * effective / (2 * young));
  const double end = size * size / (2 * std::cbrt(6.0) * effective);
  const Vec3 drift(0.5, 0.35, 0.2), axis(0, 0.6, 0.8);
  // Pulled apart to about half of what breaks it: it swings beyond touching, where a pair that forgot would part.
  const double gap = -0.2 * end;
  run.particles.add({sphere(Vec3::Constant(9e-4), drift, radius),
                     sphere(Vec3::Constant(9e-4) + (2 * radius + gap) * axis, drift + 0.018 * axis, radius)});
  double widest = 0;
  int rebuilds = 0;
  for (int n = 0; n < 40; ++n) {
    rebuilds += run.particles.advance(n * 1e-4, 1e-4).rebuilds;
    const auto state = gather(run.particles);
    Vec3 apart = vec3(state.at(0).x) - vec3(state.at(1).x);
    for (int d = 0; d < 3; ++d) apart[d] -= 1e-3 * std::nearbyint(apart[d] / 1e-3);
    widest = std::max(widest, apart.norm() - 2 * radius);
  }
  CHECK(rebuilds > 20);
  CHECK(widest > 0.1 * end);  // it lives on the neck
  CHECK(widest < end);
}
