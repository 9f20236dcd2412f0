#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "head_on.hpp"
#include "impact.hpp"
#include "law_cases.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi;

/// Restitution of x'' = -x^1.5 - c x^power x', met with speed 1, by the classical Runge-Kutta method.
double scaled_restitution(double c, double power) {
  double x = 0, v = 1;
  const double h = 1e-3;
  const auto rate = [&](double at, double speed) {
    const double depth = std::max(at, 0.0);
    return -std::pow(depth, 1.5) - c * std::pow(depth, power) * speed;
  };
  while (true) {
    const double a1 = rate(x, v), v2 = v + 0.5 * h * a1, a2 = rate(x + 0.5 * h * v, v2);
    const double v3 = v + 0.5 * h * a2, a3 = rate(x + 0.5 * h * v2, v3);
    const double v4 = v + h * a3, a4 = rate(x + h * v3, v4);
    const double next = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    const double change = h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (next <= 0) return -(v + change * x / (x - next));
    x = next, v += change;
  }
}

/// Stiffness of the Hertz spring over sqrt(R_eff) of the one material of a case. Pa
double hertz(const LawRun& run) { return 4.0 / 3.0 * run.materials.pair(0, 0).effective_young; }

}  // namespace

TEST_CASE("Kuwabara-Kono spheres have the restitutions of the scaled equation, and lose v^(1/5) at low speed",
          "[particles]") {
  const double mass = 1e-6, radius = 0.5e-3;
  const LawRun elastic(LawCase().choose("normal", "tsuji"));
  const double k = hertz(elastic) * std::sqrt(radius), speed = 0.5, length = std::pow(mass * speed * speed / k, 0.4);
  const double figures[][2] = {{0.01, .98854}, {0.05, .94426}, {0.1, .89215}, {0.2, .79755}};
  for (const auto& [c, e] : figures) {
    const double gamma = c * mass * speed / std::pow(length, 1.5);
    const LawRun given(LawCase().set("normal_type", "kuwabara_kono").set("normal_root_damping", std::to_string(gamma)));
    CHECK(impact(given, mass, radius, speed, 1e-9).restitution == Approx(e).epsilon(2e-5));
    const LawRun relaxed(LawCase()
                             .set("normal_type", "kuwabara_kono")
                             .set("normal_relaxation_time", fmt::format("{:.15g}", gamma / (1.5 * k))));
    CHECK(impact(relaxed, mass, radius, speed, 1e-9).restitution == Approx(e).epsilon(2e-5));
  }
  const LawRun weak(LawCase().set("normal_type", "kuwabara_kono").set("normal_relaxation_time", "1e-9"));
  const double fast = 1 - impact(weak, mass, radius, 0.32, 1e-9).restitution;
  const double slow = 1 - impact(weak, mass, radius, 0.01, 2e-9).restitution;
  CHECK(fast / slow == Approx(2).epsilon(2e-3));
}

TEST_CASE("Lee-Herrmann spheres have the restitution of the scaled equation, given by gamma or by its rate",
          "[particles]") {
  const double mass = 1e-6, radius = 0.5e-3, speed = 0.5;
  const LawRun elastic(LawCase().choose("normal", "tsuji"));
  const double length = std::pow(mass * speed * speed / (hertz(elastic) * std::sqrt(radius)), 0.4);
  for (const double c : {0.05, 0.3}) {
    const double gamma = c * mass * speed / length, e = scaled_restitution(c, 0);
    const LawRun given(
        LawCase().set("normal_type", "lee_herrmann").set("normal_damping", fmt::format("{:.15g}", gamma)));
    CHECK(impact(given, mass, radius, speed, 1e-9).restitution == Approx(e).epsilon(1e-5));
    const LawRun rate(
        LawCase().set("normal_type", "lee_herrmann").set("normal_damping_rate", fmt::format("{:.15g}", gamma / mass)));
    CHECK(impact(rate, mass, radius, speed, 1e-9).restitution == Approx(e).epsilon(1e-5));
  }
}

TEST_CASE("A Walton-Braun impact has the restitution, duration and residual deformation of its closed form",
          "[particles]") {
  const double mass = 1e-6, radius = 0.5e-3, speed = 0.4, k = 1e4;
  const double quarter = std::sqrt(mass / k);
  for (const double e : {0.9, 0.5}) {
    const double unloading = k / (e * e);
    LawCase by_restitution, by_stiffness;
    by_restitution.choose("normal", "walton_braun").set("material_bead_restitution", std::to_string(e));
    by_stiffness.choose("normal", "walton_braun").set("normal_unloading_stiffness", fmt::format("{:.15g}", unloading));
    for (const auto& setup : {by_restitution, by_stiffness}) {
      const Impact result = impact(LawRun(setup), mass, radius, speed, 1e-9);
      CHECK(result.restitution == Approx(e).epsilon(1e-4));
      CHECK(result.duration == Approx(pi / 2 * (quarter + std::sqrt(mass / unloading))).epsilon(2e-4));
      CHECK(result.residual == Approx(speed * quarter * (1 - e * e)).epsilon(1e-3));
      CHECK(result.largest_force == Approx(k * speed * quarter).epsilon(1e-6));
    }
  }
  const double hardening = 2e3;
  LawCase variable;
  variable.choose("normal", "walton_braun").set("normal_hardening", std::to_string(hardening));
  for (const double v : {0.1, 0.4, 1.6}) {
    const Impact result = impact(LawRun(variable), mass, radius, v, 1e-9);
    CHECK(result.restitution == Approx(1 / std::sqrt(1 + hardening * v * quarter)).epsilon(1e-4));
  }
}

TEST_CASE("A Walton-Braun contact reloads along its unloading line up to the loading line", "[particles]") {
  LawCase setup;
  setup.choose("normal", "walton_braun").set("normal_unloading_stiffness", "4e4");
  const LawRun run(setup);
  double history[8] = {};
  Contact<double> contact{};
  contact.effective_radius = 1e-3, contact.effective_mass = 1e-6;
  const auto force = [&](double x) {
    contact.overlap = x;
    return loads_of(run.laws, contact, run.materials.pair(0, 0), 1e-3, 1e-3, 0, history).normal.force;
  };
  CHECK(force(4e-6) == Approx(1e4 * 4e-6));
  CHECK(force(3.5e-6) == Approx(4e4 * (3.5e-6 - 3e-6)));
  CHECK(force(2e-6) == 0);
  CHECK(force(3.8e-6) == Approx(4e4 * (3.8e-6 - 3e-6)));
  CHECK(force(6e-6) == Approx(1e4 * 6e-6));
  CHECK(force(5e-6) == Approx(4e4 * (5e-6 - 4.5e-6)));
}

TEST_CASE("Thornton's spheres rebound elastically below the yield speed and as his formula tells above it",
          "[particles]") {
  const double mass = 1e-6, radius = 0.5e-3, yield_pressure = 2e5;
  const LawRun run(LawCase().choose("normal", "thornton"));
  const double young = run.materials.pair(0, 0).effective_young;
  const double yield_speed = std::pow(pi / (2 * young), 2) * std::sqrt(8 * pi * std::pow(radius, 3) / (15 * mass)) *
                             std::pow(yield_pressure, 2.5);
  const auto formula = [](double q) {  // q = v_y/v
    return std::sqrt(6 * std::sqrt(3.0) / 5) * std::sqrt(1 - q * q / 6) *
           std::pow(q / (q + 2 * std::sqrt(1.2 - q * q / 5)), 0.25);
  };
  const double overlap = radius * std::pow(pi * yield_pressure / (2 * young), 2);
  const auto step = [&](double v) { return 1e-3 * overlap / yield_speed / std::pow(v / yield_speed, 0.2); };
  CHECK(impact(run, mass, radius, 0.5 * yield_speed, step(0.5 * yield_speed)).restitution == Approx(1).epsilon(1e-4));
  CHECK(impact(run, mass, radius, 0.99 * yield_speed, step(yield_speed)).restitution == Approx(1).epsilon(1e-4));
  const double figures[][2] = {{2, .93063}, {5, .77334}, {10, .65856}, {100, .37430}};
  for (const auto& [ratio, e] : figures) {
    CHECK(formula(1 / ratio) == Approx(e).epsilon(2e-5));
    const Impact result = impact(run, mass, radius, ratio * yield_speed, step(ratio * yield_speed));
    CHECK(result.restitution == Approx(e).epsilon(2e-4));
  }
}

TEST_CASE("A Thornton contact reloads along its unloading curve and then yields on", "[particles]") {
  const LawRun run(LawCase().choose("normal", "thornton"));
  double history[8] = {};
  Contact<double> contact{};
  const double radius = 1e-3, young = run.materials.pair(0, 0).effective_young;
  contact.effective_radius = radius, contact.effective_mass = 1e-6;
  const auto load = [&](double x) {
    contact.overlap = x;
    return loads_of(run.laws, contact, run.materials.pair(0, 0), 1e-3, 1e-3, 0, history).normal;
  };
  const double yield = radius * std::pow(pi * 2e5 / (2 * young), 2), k = 4.0 / 3 * young * std::sqrt(radius);
  CHECK(load(0.5 * yield).force == Approx(k * std::pow(0.5 * yield, 1.5)));
  const auto virgin = [&](double x) { return k * std::pow(yield, 1.5) + pi * 2e5 * radius * (x - yield); };
  CHECK(load(5 * yield).force == Approx(virgin(5 * yield)));
  CHECK(load(5 * yield).contact_radius == Approx(std::sqrt(radius * 5 * yield)));
  const double part_way = load(4.5 * yield).force;
  CHECK(part_way < virgin(4.5 * yield));
  CHECK(load(1.2 * yield).force == 0);
  CHECK(load(4.5 * yield).force == Approx(part_way));
  CHECK(load(5 * yield).force == Approx(virgin(5 * yield)));
  CHECK(load(7 * yield).force == Approx(virgin(7 * yield)));
}

TEST_CASE("Every normal law rebounds in the engine as by itself, to second order in the step", "[particles]") {
  const double radius = 1e-3, speed = 0.05;
  for (const auto& name : NormalModels::names()) {
    // Laws of the distance between the centres, which impact() does not know: test_force_jumps.cpp.
    if (name == "langston" || name == "lennard_jones") continue;
    LawCase setup;
    setup.choose("normal", name);
    const LawRun run(setup);
    const double mass = 0.5 * 2500 * 4.0 / 3.0 * pi * std::pow(radius, 3);
    const double exact = impact(run, mass, radius / 2, 2 * speed, 2e-8).restitution;
    for (const double dt : {2e-6, 5e-7}) {  // 16 times the error
      BoxCase box;
      for (const auto& [option, value] : law_options("normal", name)) box.set(option, value);
      if (setup.damped().options.given("material_bead_restitution")) box.set("material_bead_restitution", "0.8");
      box.set("particles_speed", "0.05");
      box.set("particles_step_override", "yes").set("particles_step", fmt::format("{:g}", dt));
      const double error = std::abs(head_on(box, radius, speed, 0, dt).restitution - exact);
      INFO(name << " dt " << dt << " error " << error << " e " << exact);
      CHECK(error < (dt > 1e-6 ? 1e-3 : 7e-5));
    }
  }
}

TEST_CASE("Laws with two ways to say a parameter take one of them and refuse both", "[particles]") {
  const auto refused = [](LawCase setup, const char* text) {
    try {
      const LawRun run(setup);
      FAIL("accepted, expected: " << text);
    } catch (const UserError& error) {
      CHECK_THAT(error.what(), Catch::Contains(text));
    }
  };
  refused(LawCase().set("normal_type", "lee_herrmann"), "-normal_damping");
  refused(LawCase().set("normal_type", "lee_herrmann").set("normal_damping", "1").set("normal_damping_rate", "1"),
          "not both");
  refused(LawCase().set("normal_type", "kuwabara_kono"), "-normal_root_damping");
  refused(
      LawCase().set("normal_type", "kuwabara_kono").set("normal_root_damping", "1").set("normal_relaxation_time", "1"),
      "not both");
  refused(LawCase().set("normal_type", "walton_braun"), "-normal_stiffness");
  refused(
      LawCase().choose("normal", "walton_braun").set("normal_unloading_stiffness", "2e4").set("normal_hardening", "1"),
      "exclude");
  refused(LawCase().choose("normal", "walton_braun").set("normal_unloading_stiffness", "1e3"), "gain energy");
  refused(LawCase().set("tangential_type", "spring"), "-tangential_stiffness");
  refused(LawCase().set("tangential_type", "viscous"), "-tangential_damping");
  refused(
      LawCase().set("tangential_type", "viscous").set("tangential_damping", "1").set("tangential_damping_ratio", "1"),
      "not both");
  refused(LawCase().set("rolling_type", "viscous_coulomb"), "-rolling_damping");
  refused(LawCase().choose("rolling", "viscous_coulomb").set("rolling_length", "1e-5"), "rolling_friction");
  refused(LawCase()
              .choose("tangential", "spring_dashpot")
              .set("tangential_damping", "1")
              .set("tangential_damping_ratio", "1"),
          "-tangential_damping_ratio");
  refused(LawCase().set("rolling_type", "spring"), "-rolling_stiffness");
  // The restitution beside another damping: two ways to say what a collision loses.
  const std::pair<const char*, std::vector<std::pair<const char*, const char*>>> losses[] = {
      {"-normal_damping", {{"normal_type", "linear"}, {"normal_stiffness", "1e4"}, {"normal_damping", "0.01"}}},
      {"-normal_damping", {{"normal_type", "lee_herrmann"}, {"normal_damping", "0.01"}}},
      {"-normal_damping_rate", {{"normal_type", "lee_herrmann"}, {"normal_damping_rate", "10"}}},
      {"-normal_root_damping", {{"normal_type", "kuwabara_kono"}, {"normal_root_damping", "0.1"}}},
      {"-normal_relaxation_time", {{"normal_type", "kuwabara_kono"}, {"normal_relaxation_time", "1e-6"}}},
      {"-normal_unloading_stiffness",
       {{"normal_type", "walton_braun"}, {"normal_stiffness", "1e4"}, {"normal_unloading_stiffness", "2e4"}}},
      {"-normal_hardening", {{"normal_type", "walton_braun"}, {"normal_stiffness", "1e4"}, {"normal_hardening", "10"}}},
      {"-normal_damping_ratio", {{"normal_type", "langston"}}},
      {"-normal_damping_rate", {{"normal_type", "lennard_jones"}, {"normal_energy", "1e-7"}}},
      {"yield pressure", {{"normal_type", "thornton"}, {"material_bead_yield_pressure", "2e5"}}}};
  for (const auto& [names, given] : losses)
    for (const char* restitution : {"material_bead_restitution", "pair_bead_bead_restitution"}) {
      LawCase setup;
      for (const auto& [option, value] : given) setup.set(option, value);
      CHECK_NOTHROW(LawRun(setup));
      refused(setup.set(restitution, "0.8"), names);
      refused(setup, restitution);
    }
  refused(LawCase().set("normal_type", "linear").set("normal_stiffness", "1e4").set("normal_contact_time", "1e-4"),
          "either -normal_stiffness");
  refused(LawCase().set("normal_type", "linear").set("normal_contact_time", "1e-4").set("normal_damping", "1"),
          "goes with -normal_stiffness");
  refused(LawCase().set("normal_type", "hertz"), "tsuji");
}
