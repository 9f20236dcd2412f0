#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "gas_box.hpp"
#include "law_cases.hpp"
#include "reference_path.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi, viscosity = 1e-3, radius = 0.5e-3, density = 2500;

/// Two spheres in a film, nothing else; the gap and the speed of approach after `time` in steps of `dt`.
struct Approach {
  double gap, speed;
};
Approach approach(double gap, double speed, double time, double dt, bool shifted) {
  BoxCase setup;
  setup.box(Vec3::Constant(-5e-3), Vec3::Constant(5e-3)).set("particles_speed", "0.1");
  setup.set("lubrication_type", "squeeze")
      .set("lubrication_viscosity", "1e-3")
      .set("lubrication_shifted", shifted ? "yes" : "no");
  setup.set("particles_step", fmt::format("{}", dt)).set("particles_step_override", "yes");
  BoxRun run(setup);
  const Vec3 n = Vec3(2, 1, 2) / 3;
  run.particles.add({sphere(-(radius + gap / 2) * n, 0.5 * speed * n, radius),
                     sphere((radius + gap / 2) * n, -0.5 * speed * n, radius)});
  run.particles.advance(0, time);
  const auto state = gather(run.particles);
  return {(vec3(state.at(1).x) - vec3(state.at(0).x)).norm() - 2 * radius,
          (vec3(state.at(0).v) - vec3(state.at(1).v)).dot(n)};
}

}  // namespace

TEST_CASE("The film between two surfaces resists with 6 pi mu R_eff^2 v/h, above the least gap and up to the outer one",
          "[particles]") {
  for (const bool shifted : {true, false}) {
    LawCase setup;
    setup.set("lubrication_type", "squeeze").set("lubrication_viscosity", "1e-3");
    setup.set("lubrication_least_gap", "1e-6").set("lubrication_outer_gap", "1e-4");
    setup.set("lubrication_shifted", shifted ? "yes" : "no");
    const LawRun run(setup, radius, radius);
    CHECK(run.laws.setup().enter_gap == Approx(1e-4));
    Contact<double> contact{};
    contact.normal[2] = 1, contact.effective_mass = 1e-6, contact.effective_radius = radius / 2;
    std::vector<double> history(run.laws.history_components() + 1);
    const auto pull = [&](double gap, double speed) {
      contact.overlap = -gap, contact.approach = speed;
      return loads_of(run.laws, contact, run.laws.pair(0, 0), 0, 0, 0, history.data()).pull;
    };
    const double factor = 6 * pi * viscosity * radius * radius / 4;
    for (const double gap : {2e-6, 1e-5, 9e-5}) {
      CHECK(pull(gap, 0.02) == Approx(factor * 0.02 * (1 / gap - (shifted ? 1e4 : 0.0))));
      CHECK(pull(gap, -0.02) == Approx(-pull(gap, 0.02)));
    }
    CHECK(pull(1e-7, 0.02) == Approx(pull(1e-6, 0.02)));
    CHECK(pull(1.01e-4, 0.02) == 0);
    // Beginning with a jump of a hundredth of its peak is told of.
    CHECK(run.laws.warnings().size() == (shifted ? 0u : 1u));
  }
}

TEST_CASE(
    "Two spheres that near each other in a film lose speed with the logarithm of the gap, to second order in the "
    "step",
    "[particles]") {
  const double effective_mass = 0.5 * density * 4.0 / 3.0 * pi * std::pow(radius, 3);
  const double rate = 6 * pi * viscosity * radius * radius / 4 / effective_mass, outer = 0.5 * radius / 2;
  const double start = 4e-5, speed = 0.01, time = 3e-3;
  for (const bool shifted : {true, false}) {
    double before = 0;
    for (const double dt : {1e-4, 5e-5, 2.5e-5}) {
      const Approach end = approach(start, speed, time, dt, shifted);
      const double lost = rate * (std::log(start / end.gap) - (shifted ? (start - end.gap) / outer : 0.0));
      const double error = std::abs(end.speed - (speed - lost));
      INFO("dt " << dt << ": gap " << end.gap << ", speed " << end.speed << ", error " << error);
      CHECK(end.gap < 0.6 * start);
      CHECK(error < 1e-3 * speed);
      if (before > 0) CHECK(std::log2(before / error) > 1.7);
      before = error;
    }
  }
}

TEST_CASE("A heavy sphere sinks through its film to a plate exponentially", "[particles][slow]") {
  // Without inertia dh/dt = -W h/(6 pi mu R^2). The number of steps goes with the square of the viscosity; at 3 Pa s
  // inertia still shifts the gap by less than 1e-5.
  BoxCase setup;
  setup.box(Vec3(-5e-3, -5e-3, 0), Vec3(5e-3, 5e-3, 10e-3));
  setup.gravity = {0, 0, -9.81};
  setup.set("lubrication_type", "squeeze").set("lubrication_viscosity", "3").set("lubrication_shifted", "no");
  setup.set("lubrication_least_share", "1e-2");
  BoxRun run(setup);
  const double gap = 5e-5;
  run.particles.add({sphere(Vec3(0, 0, radius + gap), Vec3::Zero(), radius)});
  const double weight = run.particles.mass(0) * 9.81, time = 0.3 * 6 * pi * 3 * radius * radius / weight;
  run.particles.advance(0, time);
  CHECK(gather(run.particles).at(0).x[2] - radius == Approx(gap * std::exp(-0.3)).epsilon(2e-3));
  CHECK(run.particles.time_step_reason().find("lubrication") != std::string::npos);
}

TEST_CASE("Lubrication refuses gaps given twice, and a least gap beyond the outer one", "[particles]") {
  const auto refused = [](std::initializer_list<std::pair<const char*, const char*>> given) {
    LawCase setup;
    setup.set("lubrication_type", "squeeze");
    for (const auto& [name, value] : given) setup.set(name, value);
    CHECK_THROWS_AS(LawRun(setup), UserError);
  };
  refused({});
  refused({{"lubrication_viscosity", "1"}, {"lubrication_outer_gap", "1e-4"}, {"lubrication_outer_share", "0.1"}});
  refused({{"lubrication_viscosity", "1"}, {"lubrication_least_gap", "1e-4"}, {"lubrication_least_share", "0.1"}});
  refused({{"lubrication_viscosity", "1"}, {"lubrication_least_gap", "1e-4"}, {"lubrication_outer_gap", "1e-5"}});
}
