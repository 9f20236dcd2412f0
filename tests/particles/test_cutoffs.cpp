#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <sstream>

#include "base/error.hpp"
#include "gas_box.hpp"
#include "law_cases.hpp"
#include "particles/law_table.hpp"

using namespace silt;

namespace {

/// Warnings for two beads of 1 mm with the options of a law.
std::vector<std::string> warnings(std::initializer_list<std::pair<const char*, const char*>> given) {
  BoxCase setup;
  setup.box(Vec3::Constant(-20e-3), Vec3::Constant(20e-3)).set("particles_speed", "0.1");
  for (const auto& [name, value] : given) setup.set(name, value);
  BoxRun run(setup);
  run.particles.add({sphere(Vec3(-1e-3, 0, 0), Vec3::Zero(), 0.5e-3), sphere(Vec3(1e-3, 0, 0), Vec3::Zero(), 0.5e-3)});
  run.particles.advance(0, 1e-9);
  return run.particles.warnings();
}

/// The rows of a table of two columns.
std::vector<std::pair<double, double>> rows_of(const std::string& text) {
  std::vector<std::pair<double, double>> rows;
  for (size_t at = text.find('\n') + 1; at < text.size(); at = text.find('\n', at) + 1) {
    char* end = nullptr;
    const double first = std::strtod(text.c_str() + at, &end);
    rows.emplace_back(first, std::strtod(end + 1, nullptr));
  }
  return rows;
}

}  // namespace

TEST_CASE("Every force at a distance that is cut off at more than a thousandth of its size in contact is warned about",
          "[particles]") {
  using Given = std::initializer_list<std::pair<const char*, const char*>>;
  const auto told = [](Given given) {
    const auto lines = warnings(given);
    return lines.size() == 1 && lines[0].find("cut off at") != std::string::npos;
  };
  // Coulomb falls as r^-2: to a thousandth at 31.6 diameters; dipoles as r^-4: at 5.6 diameters.
  CHECK(told({{"electric_type", "dc"},
              {"electric_coulomb", "yes"},
              {"electric_charge", "1e-12"},
              {"electric_cutoff", "31e-3"}}));
  CHECK(warnings({{"electric_type", "dc"},
                  {"electric_coulomb", "yes"},
                  {"electric_charge", "1e-12"},
                  {"electric_cutoff", "32e-3"}})
            .empty());
  CHECK(warnings({{"electric_type", "dc"}, {"electric_coulomb", "yes"}, {"electric_charge", "1e-12"}}).empty());
  CHECK(told({{"magnetic_type", "fixed"}, {"magnetic_magnetisation", "1e3"}, {"magnetic_cutoff", "5.5e-3"}}));
  CHECK(
      warnings({{"magnetic_type", "fixed"}, {"magnetic_magnetisation", "1e3"}, {"magnetic_cutoff", "5.7e-3"}}).empty());
  CHECK(warnings({{"magnetic_type", "fixed"}, {"magnetic_magnetisation", "1e3"}}).empty());
  // Van der Waals falls as h^-2 from the least gap, a double layer exponentially.
  CHECK(told(
      {{"dlvo_type", "vdw"}, {"material_bead_hamaker", "1e-19"}, {"dlvo_least_gap", "1e-6"}, {"dlvo_cutoff", "3e-5"}}));
  CHECK(warnings({{"dlvo_type", "vdw"},
                  {"material_bead_hamaker", "1e-19"},
                  {"dlvo_least_gap", "1e-6"},
                  {"dlvo_cutoff", "3.2e-5"}})
            .empty());
  CHECK(told({{"dlvo_type", "electrostatic"},
              {"material_bead_surface_potential", "0.1"},
              {"dlvo_debye_length", "1e-6"},
              {"dlvo_cutoff", "5e-6"}}));
  CHECK(warnings({{"dlvo_type", "electrostatic"},
                  {"material_bead_surface_potential", "0.1"},
                  {"dlvo_debye_length", "1e-6"},
                  {"dlvo_cutoff", "7.7e-6"}})
            .empty());
  const auto floats = [&](const char* cutoff) {
    return warnings({{"interfacial_type", "nicolson"},
                     {"interfacial_surface_tension", "0.07"},
                     {"interfacial_contact_angle", "120"},
                     {"interfacial_filling_angle", "100"},
                     {"interfacial_density_difference", "1e5"},
                     {"interfacial_cutoff", cutoff}})
        .size();
  };
  CHECK(floats("2e-3") == 1);
  CHECK(floats("5e-3") == 0);
  CHECK(told({{"lubrication_type", "squeeze"}, {"lubrication_viscosity", "1e-3"}, {"lubrication_shifted", "no"}}));
  CHECK(warnings({{"lubrication_type", "squeeze"}, {"lubrication_viscosity", "1e-3"}}).empty());
}

TEST_CASE("A table of a law gives the law's force over gap and over slip, and refuses what it cannot draw",
          "[particles]") {
  LawCase setup;
  setup.choose("normal", "linear").choose("tangential", "spring").set("material_bead_restitution", "1");
  setup.set("law_table_radius", "1e-3").set("law_table_depth", "1e-5").set("law_table_rows", "50");
  LawCase normal = setup;
  normal.set("law_table_motion", "normal");
  const auto in_and_out = rows_of(law_table(normal.options));
  REQUIRE(in_and_out.size() == 100);
  CHECK(in_and_out[49].first == Approx(-1e-5));
  for (const auto& [gap, force] : in_and_out) CHECK(force == Approx(1e4 * std::max(0.0, -gap)).margin(1e-12));
  LawCase slide = setup;
  slide.set("law_table_motion", "tangential").set("law_table_amplitude", "1e-5");
  const auto to_and_fro = rows_of(law_table(slide.options));
  REQUIRE(to_and_fro.size() == 250);
  double largest = 0;
  for (const auto& row : to_and_fro) largest = std::max(largest, std::abs(row.second));
  CHECK(largest == Approx(3e3 * 1e-5).epsilon(0.02));  // below the limit of 0.5 * 1e4 * 1e-5
  LawCase without = setup;
  without.set("law_table_motion", "rolling");
  CHECK_THROWS_AS(law_table(without.options), UserError);
}

TEST_CASE("A table of a field gives the forces of dipoles head to tail, side by side and oblique, and of charges",
          "[particles]") {
  const auto table = [](LawCase setup, double angle) {
    setup.set("law_table_motion", "field").set("law_table_radius", "1e-3").set("law_table_rows", "5");
    setup.set("law_table_angle", std::to_string(angle));
    std::string text = law_table(setup.options);
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream lines(text.substr(text.find('\n')));
    std::vector<std::array<double, 4>> rows(5);
    for (auto& row : rows)
      for (double& value : row) lines >> value;
    return rows;
  };
  const double pi = std::numbers::pi, moment = 1e5 * 4.0 / 3.0 * pi * 1e-9;
  for (const double angle : {0.0, 30.0, 54.7356103172, 90.0}) {
    LawCase dipoles;
    dipoles.set("magnetic_type", "fixed").set("magnetic_magnetisation", "1e5").set("magnetic_direction", "0, 0, 1");
    const double theta = angle * pi / 180;
    for (const auto& [distance, radial, across, torque] : table(dipoles, angle)) {
      const double size = 3 * 4e-7 * pi * moment * moment / (4 * pi * std::pow(distance, 4));
      CHECK(radial == Approx(size * (1 - 3 * std::cos(theta) * std::cos(theta))).margin(1e-6 * size));
      CHECK(across == Approx(-size * std::sin(2 * theta)).margin(1e-6 * size));
      CHECK(torque == 0);
    }
    LawCase turning;
    turning.set("magnetic_type", "permanent").set("magnetic_magnetisation", "1e5");
    turning.set("magnetic_direction", "0, 0, 1");
    for (const auto& [distance, radial, across, torque] : table(turning, angle)) {
      const double size = 3 * 4e-7 * pi * moment * moment / (8 * pi * std::pow(distance, 3));
      CHECK(torque == Approx(size * std::sin(2 * theta)).margin(1e-6 * size));
    }
  }
  LawCase charges;
  charges.set("electric_type", "dc").set("electric_charge", "2e-12").set("electric_coulomb", "yes");
  charges.set("electric_fluid_permittivity", "2");
  for (const auto& [distance, radial, across, torque] : table(charges, 20)) {
    CHECK(radial == Approx(4e-24 / (4 * pi * 2 * 8.8541878128e-12 * distance * distance)).epsilon(1e-6));
    CHECK(std::abs(across) < 1e-12 * radial);
    CHECK(torque == 0);
  }
  LawCase none;
  CHECK_THROWS_WITH(law_table(none.set("law_table_motion", "field").options), Catch::Contains("-magnetic_type"));
}
