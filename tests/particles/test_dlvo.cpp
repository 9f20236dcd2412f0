#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gas_box.hpp"
#include "law_cases.hpp"
#include "particles/adhesion/bessel.hpp"
#include "particles/adhesion/dlvo_forces.hpp"
#include "reference_path.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi;

/// Hamaker's potential of two spheres (7.46).
double hamaker_potential(double a, double r, double r1, double r2) {
  const double outer = r * r - (r1 + r2) * (r1 + r2), inner = r * r - (r1 - r2) * (r1 - r2);
  return -a / 6 * (2 * r1 * r2 / outer + 2 * r1 * r2 / inner + std::log(outer / inner));
}

/// Force of the law of one slot on a contact at a gap between spheres of radii r1 and r2 (r2 = 0: a wall).
double pull(const LawRun& run, double gap, double r1, double r2) {
  Contact<double> contact{};
  contact.normal[2] = 1;
  contact.overlap = -gap, contact.radius = r1;
  contact.effective_radius = r2 > 0 ? r1 * r2 / (r1 + r2) : r1;
  contact.effective_mass = 1, contact.distance = r1 + r2 + gap, contact.rolling_inertia = 1;
  std::vector<double> history(run.laws.history_components() + 1);
  return loads_of(run.laws, contact, run.laws.pair(0, 0), r1, r2, 0, history.data()).pull;
}

LawCase double_layer() {
  LawCase setup;
  setup.set("dlvo_type", "electrostatic").set("dlvo_ionic_strength", "1");
  return setup.set("material_bead_surface_potential", "0.03");
}

}  // namespace

TEST_CASE("The van der Waals force is minus the slope of Hamaker's potential, for any two radii", "[particles]") {
  for (const auto& [r1, r2] : {std::pair{1e-6, 1e-6}, {1e-6, 0.3e-6}, {0.2e-6, 5e-6}})
    for (const double gap : {2e-8, 1e-7, 1e-6}) {
      const double a = 1e-20, r = r1 + r2 + gap, h = 1e-4 * gap;
      const double slope = (hamaker_potential(a, r + h, r1, r2) - hamaker_potential(a, r - h, r1, r2)) / (2 * h);
      CHECK(hamaker_force(a, gap, r1, 1 / r2) == Approx(-slope).epsilon(1e-5));
      CHECK(hamaker_force(a, gap, r1, 1 / r2) == Approx(hamaker_force(a, gap, r2, 1 / r1)).epsilon(1e-12));
    }
  const double a = 1e-20, radius = 1e-6, gap = 2e-8, r = 2 * radius + gap;
  CHECK(hamaker_force(a, gap, radius, 1 / radius) ==
        Approx(-32 * a * std::pow(radius, 6) / (3 * std::pow(r, 3) * std::pow(r * r - 4 * radius * radius, 2)))
            .epsilon(1e-10));
  CHECK(hamaker_force(a, gap, radius, 0.0) ==
        Approx(-2.0 / 3.0 * a * std::pow(radius, 3) / std::pow(gap * (2 * radius + gap), 2)));
  CHECK(hamaker_force(a, 1e-10, radius, 1 / radius) == Approx(-a * radius / (12 * 1e-20)).epsilon(1e-3));
}

TEST_CASE("The van der Waals force is constant below the least gap and in contact", "[particles]") {
  const LawRun run(LawCase().set("dlvo_type", "vdw").set("material_bead_hamaker", "1e-20"), 1e-6, 1e-6);
  const double at_least = pull(run, 0.4e-9, 1e-6, 1e-6);
  CHECK(at_least == Approx(hamaker_force(1e-20, 0.4e-9, 1e-6, 1e6)));
  CHECK(pull(run, 0.1e-9, 1e-6, 1e-6) == at_least);
  CHECK(pull(run, -1e-8, 1e-6, 1e-6) == at_least);
  CHECK(pull(run, 41e-9, 1e-6, 1e-6) == 0);
  CHECK(run.laws.setup().leave_gap == Approx(40.04e-9));
  CHECK(run.laws.setup().enter_gap == Approx(40e-9));
  CHECK(run.laws.warnings().empty());
}

TEST_CASE("The double-layer force is minus the slope of its potential; unlike surfaces attract when near",
          "[particles]") {
  const LawRun run(double_layer(), 1e-6, 1e-6);
  const double eps = 78.4 * 8.8541878128e-12;
  const double length = std::sqrt(eps * 1.380649e-23 * 298.15 / (2 * std::pow(1.602176634e-19, 2) * 6.02214076e23));
  CHECK(length == Approx(9.614e-9).epsilon(1e-3));
  const auto potential = [&](double h) { return 2 * pi * eps * 1e-6 * 9e-4 * std::log(1 + std::exp(-h / length)); };
  for (const double gap : {1e-9, 1e-8, 5e-8}) {
    const double h = 1e-4 * gap;
    CHECK(pull(run, gap, 1e-6, 1e-6) == Approx(-(potential(gap + h) - potential(gap - h)) / (2 * h)).epsilon(1e-6));
  }
  // Unlike radii: 2 R_eff in place of R; at a wall 2 R.
  CHECK(pull(run, 1e-8, 1e-6, 0.25e-6) == Approx(0.4 * pull(run, 1e-8, 1e-6, 1e-6)));
  CHECK(pull(run, 1e-8, 1e-6, 0) == Approx(2 * pull(run, 1e-8, 1e-6, 1e-6)));
  // Hogg, Healy & Fuerstenau: with potentials of one sign and unlike size the force turns to attraction.
  const double squares = 0.03 * 0.03 + 0.01 * 0.01, turn = length * std::log(squares / (2 * 0.03 * 0.01));
  CHECK(double_layer_force(1.0, 3e-4, squares, 1 / length, 1.01 * turn, 1.0) > 0);
  CHECK(double_layer_force(1.0, 3e-4, squares, 1 / length, 0.99 * turn, 1.0) < 0);
}

TEST_CASE("The sum has the barrier of 23.31 kT at 2.14 nm for 50 nm spheres in a solution of 1 mol/m3", "[particles]") {
  // The figures hold in Derjaguin's limit, where everything is proportional to the radius: taken at 50 um.
  const double radius = 50e-6, thermal = 1.380649e-23 * 298.15;
  LawCase setup = double_layer();
  const LawRun run(setup.set("dlvo_type", "full").set("material_bead_hamaker", "1e-20"), radius, radius);
  // The force changes sign at the barrier; its height is the work from where the forces end.
  double low = 1e-9, high = 4e-9;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (pull(run, middle, radius, radius) < 0 ? low : high) = middle;
  }
  CHECK(low == Approx(2.14e-9).epsilon(3e-3));
  double height = 0;
  const double end = run.laws.setup().enter_gap;
  constexpr int steps = 20000;
  for (int k = 0; k < steps; ++k)
    height += pull(run, low + (end - low) * (k + 0.5) / steps, radius, radius) * (end - low) / steps;
  CHECK(height / (1000 * thermal) == Approx(23.31).epsilon(1e-2));
}

TEST_CASE("A force cut off above a thousandth of its peak is warned about", "[particles]") {
  LawCase vdw;
  vdw.set("dlvo_type", "vdw").set("material_bead_hamaker", "1e-20").set("dlvo_cutoff", "2e-9");
  const LawRun run(vdw, 1e-6, 1e-6);
  REQUIRE(run.laws.warnings().size() == 1);
  CHECK_THAT(run.laws.warnings()[0], Catch::Contains("cut off at 0.04"));
  CHECK_THROWS_WITH(LawRun(LawCase().set("dlvo_type", "electrostatic")), Catch::Contains("-dlvo_debye_length"));
  CHECK_THROWS_WITH(LawRun(double_layer().set("dlvo_debye_length", "1e-8")), Catch::Contains("not both"));
}

TEST_CASE("Floating particles attract by Nicolson's force, whose two forms agree where the Bond number is small",
          "[particles]") {
  for (const double x : {1e-3, 0.1, 1.0, 1.99, 2.01, 5.0, 20.0})
    CHECK(bessel_k1(x) == Approx(std::cyl_bessel_k(1.0, x)).epsilon(1e-6));
  LawCase full;
  full.choose("interfacial", "nicolson")
      .set("interfacial_filling_angle", "100")
      .set("interfacial_contact_angle", "120");
  LawCase limit = full;
  limit.options = Options();
  limit = LawCase();
  limit.set("interfacial_type", "nicolson")
      .set("interfacial_surface_tension", "0.07")
      .set("interfacial_small_bond", "yes");
  limit.set("interfacial_filling_angle", "100")
      .set("interfacial_contact_angle", "120")
      .set("interfacial_cutoff", "5e-3");
  const LawRun run(full, 1e-6, 1e-4), small(limit, 1e-6, 1e-4);
  const double beta = 100 * pi / 180, slope = std::tan(20 * pi / 180);
  const double d = 2e-6, r = 1e-5;
  const double closed = pi * 0.07 * d * d * std::pow(std::sin(beta) * slope, 2) / (2 * r);
  CHECK(pull(small, r - d, d / 2, d / 2) == Approx(-closed).epsilon(1e-9));
  CHECK(pull(run, r - d, d / 2, d / 2) == Approx(-closed).epsilon(1e-4));
  const double q = std::sqrt(9.81 * 1000 / 0.07), far = 3e-3, big = 2e-4;
  const double charge = slope / (q * std::cyl_bessel_k(1.0, q * big * std::sin(beta) / 2));
  CHECK(pull(run, far - big, big / 2, big / 2) ==
        Approx(-2 * pi * 0.07 * charge * charge * q * std::cyl_bessel_k(1.0, q * far)).epsilon(1e-5));
  CHECK(pull(run, 5.1e-3, big / 2, big / 2) == 0);
  CHECK(pull(run, 1e-3, big / 2, 0) == 0);  // a wall
  CHECK(run.laws.warnings().size() == 1);
}
