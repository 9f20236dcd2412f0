#include <catch2/catch.hpp>
#include <numbers>

#include "base/error.hpp"
#include "gas_box.hpp"
#include "particles/materials.hpp"

using namespace silt;

namespace {

double mass_of(double diameter, double density = 2500) {
  return density * std::numbers::pi / 6 * diameter * diameter * diameter;
}

/// A box of 60 mm with gravity and whatever more is given.
BoxCase vessel(const std::vector<std::pair<std::string, std::string>>& given) {
  BoxCase setup;
  setup.box({0, 0, 0}, {0.06, 0.06, 0.06});
  setup.gravity = Vec3(0, 0, -9.81);
  setup.set("material_bead_young_modulus", "2e7");
  for (const auto& [name, value] : given) setup.set(name, value);
  return setup;
}

void run(Particles& particles, double from, double to, int steps) {
  for (int k = 0; k < steps; ++k) {
    const double dt = (to - from) / steps, time = from + k * dt;
    particles.supply(time, dt);
    particles.advance(time, dt);
  }
}

std::string refused(const std::vector<std::pair<std::string, std::string>>& given) {
  try {
    BoxRun box(vessel(given));
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("A stream brings its mass rate to half a particle, and its momentum is in the account", "[insertion][mpi]") {
  BoxRun box(vessel({{"insertion_a_type", "stream"},
                     {"insertion_a_diameter", "2e-3"},
                     {"insertion_a_diameter_distribution", "uniform"},
                     {"insertion_a_diameter_deviation", "5e-4"},
                     {"insertion_a_mass_rate", "0.01"},
                     {"insertion_a_start", "0.02"},
                     {"insertion_a_centre", "0.03, 0.03, 0.05"},
                     {"insertion_a_normal", "0, 0, 1"},
                     {"insertion_a_radius", "0.02"},
                     {"insertion_a_velocity", "0, 0, -0.5"},
                     {"insertion_a_velocity_scatter", "0.02"}}));
  CHECK(box.particles.total() == 0);
  run(box.particles, 0, 0.02, 4);
  CHECK(box.particles.total() == 0);
  const Vec3 before = box.particles.momentum();
  box.particles.take_impulses();
  run(box.particles, 0.02, 0.22, 40);
  const double mass = box.particles.total_mass();
  CHECK(std::abs(mass - 0.01 * 0.2) <= 0.5 * mass_of(2.5e-3) * 1.0001);
  const auto in = box.particles.take_impulses();
  CHECK(in.added_mass == Approx(mass).epsilon(1e-12));
  CHECK(in.added[2] == Approx(-0.5 * mass).epsilon(0.02));
  const Vec3 sum = in.gravity + in.walls + in.added + in.removed;
  CHECK((box.particles.momentum() - before - sum).norm() < 1e-12 * in.walls.norm());
}

TEST_CASE("A batch comes at its instant, whole and without overlaps, and no more than the count", "[insertion][mpi]") {
  BoxRun box(vessel({{"insertion_a_type", "stream"},
                     {"insertion_a_diameter", "2e-3"},
                     {"insertion_a_number_rate", "1000"},
                     {"insertion_a_interval", "0.05"},
                     {"insertion_a_count", "120"},
                     {"insertion_a_lower", "0, 0, 0.04"},
                     {"insertion_a_upper", "0.06, 0.06, 0.06"}}));
  run(box.particles, 0, 0.04, 8);
  CHECK(box.particles.total() == 0);
  run(box.particles, 0.04, 0.06, 4);
  CHECK(box.particles.total() == 50);
  run(box.particles, 0.06, 0.31, 50);
  CHECK(box.particles.total() == 120);
}

TEST_CASE("Particles that come between steps have felt no drag of steps before them", "[insertion][mpi]") {
  BoxRun box(vessel({{"insertion_a_type", "stream"},
                     {"insertion_a_diameter", "2e-3"},
                     {"insertion_a_number_rate", "2000"},
                     {"insertion_a_interval", "0.05"},
                     {"insertion_a_lower", "0, 0, 0.04"},
                     {"insertion_a_upper", "0.06, 0.06, 0.06"}}));
  constexpr double exchange = 1e-6;
  for (int batch = 0; batch < 6; ++batch) {  // the store outgrows its arrays several times
    box.particles.supply(0.05 * batch + 0.045, 0.01);
    for (int p = 0; p < box.particles.owned(); ++p) box.particles.fluid_action(p) = FluidAction{.exchange = exchange};
    const Vec3 before = box.particles.momentum();
    box.particles.take_impulses();
    box.particles.advance(0.05 * batch + 0.045, 0.01);
    const auto in = box.particles.take_impulses();
    const Vec3 sum = in.gravity + in.walls + in.drag;
    CHECK((box.particles.momentum() - before - sum).norm() < 1e-12 * in.gravity.norm());
    CHECK(in.drag[2] > 0);  // they fall
  }
  CHECK(box.particles.total() == 600);
}

TEST_CASE("A removal box takes out those in it, which are listed and counted", "[insertion][mpi]") {
  BoxRun box(vessel({{"insertion_a_diameter", "2e-3"},
                     {"insertion_a_count", "500"},
                     {"removal_low_lower", "0, 0, 0"},
                     {"removal_low_upper", "0.03, 0.06, 0.06"},
                     {"removal_low_start", "0.01"}}));
  const auto start = gather(box.particles);
  run(box.particles, 0, 0.01, 1);
  CHECK(box.particles.total() == 500);
  const auto now = gather(box.particles);
  long long inside = 0;
  for (const auto& [id, state] : now) inside += state.x[0] <= 0.03;
  box.particles.take_impulses();
  box.particles.supply(0.01, 0.001);
  const auto step = box.particles.advance(0.01, 0.001);
  CHECK(box.particles.total() == 500 - inside);
  CHECK(step.removed == inside);
  CHECK(mpi_sum(static_cast<long long>(box.particles.departed().size())) == inside);
  CHECK(box.particles.take_impulses().removed_mass == Approx(inside * mass_of(2e-3)).epsilon(1e-12));
}

TEST_CASE("What was removed stays counted when none is left, and takes the work it owes along", "[insertion][mpi]") {
  BoxRun box(vessel({{"insertion_a_diameter", "2e-3"},
                     {"insertion_a_count", "20"},
                     {"removal_all_lower", "0, 0, 0"},
                     {"removal_all_upper", "0.06, 0.06, 0.06"},
                     {"removal_all_start", "0.01"}}));
  run(box.particles, 0, 0.01, 1);
  for (int p = 0; p < box.particles.owned(); ++p) box.particles.fluid_action(p).work = 3;
  box.particles.supply(0.01, 0.001);
  CHECK(box.particles.advance(0.01, 0.001).removed == 20);
  double work = 0;
  for (const Departed& gone : box.particles.departed()) work += gone.action.work;
  CHECK(mpi_sum(work) == Approx(60));
  CHECK(box.particles.total() == 0);
  box.particles.supply(0.011, 0.001);
  CHECK(box.particles.advance(0.011, 0.001).removed == 20);
  CHECK(box.particles.departed().empty());
}

TEST_CASE("Diameters follow a list by mass and a sieve curve by mass", "[insertion]") {
  BoxRun list(vessel({{"insertion_a_diameter_distribution", "discrete"},
                      {"insertion_a_diameters", "1e-3, 2e-3"},
                      {"insertion_a_diameter_shares", "0.3, 0.7"},
                      {"insertion_a_share_by", "mass"},
                      {"insertion_a_count", "4000"}}));
  double small = 0;
  for (int p = 0; p < list.particles.owned(); ++p)
    small += list.particles.radius(p) < 0.75e-3 ? list.particles.mass(p) : 0;
  CHECK(small / list.particles.total_mass() == Approx(0.3).margin(0.02));  // 4000 draws: 0.007 is one deviation

  BoxRun sieve(vessel({{"insertion_a_diameter_distribution", "sieve"},
                       {"insertion_a_diameters", "1e-3, 1.5e-3, 2e-3"},
                       {"insertion_a_diameter_shares", "0, 0.4, 1"},
                       {"insertion_a_share_by", "mass"},
                       {"insertion_a_count", "4000"}}));
  double passed[3] = {0, 0, 0};  // mass through 1.25, 1.5 and 1.75 mm
  for (int p = 0; p < sieve.particles.owned(); ++p)
    for (int k = 0; k < 3; ++k)
      passed[k] += 2 * sieve.particles.radius(p) < 1.25e-3 + k * 0.25e-3 ? sieve.particles.mass(p) : 0;
  const double expected[3] = {0.2, 0.4, 0.7};
  for (int k = 0; k < 3; ++k) CHECK(passed[k] / sieve.particles.total_mass() == Approx(expected[k]).margin(0.03));
}

TEST_CASE("Several materials come in the shares asked for", "[insertion]") {
  BoxRun box(vessel({{"material_sand_density", "2600"},
                     {"insertion_a_materials", "bead, sand"},
                     {"insertion_a_material_shares", "1, 3"},
                     {"insertion_a_diameter", "1e-3"},
                     {"insertion_a_count", "3000"}}));
  int sand = 0;
  for (int p = 0; p < box.particles.owned(); ++p)
    sand += box.particles.materials()[box.particles.material(p)].name == "sand";
  CHECK(sand / 3000.0 == Approx(0.75).margin(0.03));
}

TEST_CASE("A dense random packing holds 60 % solids without any overlap, periodic and between walls", "[insertion]") {
  for (const bool periodic : {true, false}) {
    BoxCase setup = vessel({{"insertion_a_type", "pack"},
                            {"insertion_a_diameter", "4e-3"},
                            {"insertion_a_solids_fraction", periodic ? "0.60" : "0.56"}});
    if (periodic) setup.periodic();
    BoxRun box(setup);
    double volume = 0;
    std::vector<Vec3> x;
    for (int p = 0; p < box.particles.owned(); ++p) {
      volume += box.particles.volume(p);
      x.push_back(box.particles.position(p));
    }
    CHECK(volume / (0.06 * 0.06 * 0.06) == Approx(periodic ? 0.60 : 0.56).epsilon(1e-3));
    double nearest = 1;
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        Vec3 apart = x[i] - x[j];
        if (periodic)
          for (int d = 0; d < 3; ++d) apart[d] -= 0.06 * std::round(apart[d] / 0.06);
        nearest = std::min(nearest, apart.norm());
      }
    CHECK(nearest >= 4e-3);
    // At random: no direction has more order than another, and no lattice rows (most neighbours not at one distance).
    int close = 0;
    for (std::size_t j = 1; j < x.size(); ++j) close += (x[j] - x[0]).norm() < 4.04e-3;
    CHECK(close < 12);
  }
}

TEST_CASE("Streams, removals and distributions that contradict themselves are refused", "[insertion]") {
  using Catch::Contains;
  CHECK_THAT(refused({{"insertion_a_type", "stream"}, {"insertion_a_diameter", "1e-3"}}),
             Contains("either -insertion_a_mass_rate or -insertion_a_number_rate"));
  CHECK_THAT(refused({{"insertion_a_diameter", "1e-3"}, {"insertion_a_count", "1"}, {"insertion_a_mass_rate", "1"}}),
             Contains("-insertion_a_type stream"));
  CHECK_THAT(refused({{"insertion_a_type", "stream"},
                      {"insertion_a_diameter", "1e-3"},
                      {"insertion_a_mass_rate", "1"},
                      {"insertion_a_radius", "0.01"}}),
             Contains("a disc needs all of"));
  CHECK_THAT(refused({{"insertion_a_diameter_distribution", "sieve"},
                      {"insertion_a_diameters", "1e-3, 2e-3"},
                      {"insertion_a_diameter_shares", "0.1, 1"},
                      {"insertion_a_count", "1"}}),
             Contains("from 0 to 1"));
  CHECK_THAT(refused({{"insertion_a_diameter", "1e-3"},
                      {"insertion_a_count", "1"},
                      {"insertion_a_materials", "bead"},
                      {"insertion_a_material_shares", "1, 2"}}),
             Contains("-insertion_a_material_shares"));
  CHECK_THAT(refused({{"insertion_a_diameter", "1e-3"}, {"insertion_a_count", "1"}, {"removal_b_lower", "0, 0, 0"}}),
             Contains("-removal_b_upper"));
}

TEST_CASE("A packing denser than spheres can be at random is given up", "[insertion][slow]") {
  CHECK_THAT(
      refused(
          {{"insertion_a_type", "pack"}, {"insertion_a_diameter", "4e-3"}, {"insertion_a_solids_fraction", "0.72"}}),
      Catch::Contains("do not pack"));
}
