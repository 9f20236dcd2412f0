#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <numbers>
#include <random>

#include "base/error.hpp"
#include "coupled_case.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi;

/// A coupled case with what the tests ask of it.
struct Bed : test::CoupledCase {
  /// Mean over the particles of all ranks.
  Vec3 mean_velocity() const { return particles->momentum() / particles->total_mass(); }
  double largest(std::span<const double> field, int components, int d) const {
    double most = -1e300;
    for (int i = 0; i < mesh->nodes; ++i) most = std::max(most, field[components * i + d]);
    return mpi_max(most);
  }
  double least(std::span<const double> field, int components, int d) const {
    double low = 1e300;
    for (int i = 0; i < mesh->nodes; ++i) low = std::min(low, field[components * i + d]);
    return mpi_min(low);
  }
};

/// A lattice of counts x counts x counts[2] spheres that fills a box from the origin, the first half a spacing from the
/// sides.
std::vector<Seed> lattice(std::array<int, 3> counts, double spacing, double diameter) {
  std::vector<Seed> seeds;
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        Seed seed;
        seed.position = spacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
        seed.radius = diameter / 2;
        seeds.push_back(seed);
      }
    }
  }
  return seeds;
}

void periodic_box(Bed& bed, double side, int cells) {
  bed.set("mesh_upper", fmt::format("{0}, {0}, {0}", side)).set("mesh_cells", fmt::format("{0}, {0}, {0}", cells));
  bed.set("mesh_periodic", "1, 1, 1").set("material_bead_density", "1000").set("material_bead_young_modulus", "1e5");
}

/// Random beads in a box of slip walls, bead and fluid moving: everything that is exchanged differs from particle to
/// particle.
void stirred(Bed& bed, std::vector<Seed>& seeds) {
  bed.gravity = Vec3(0, 0, -9.81);
  bed.set("mesh_upper", "8e-3, 8e-3, 16e-3").set("mesh_cells", "4, 4, 8");
  bed.set("material_bead_density", "1000").set("material_bead_young_modulus", "1e6").set("particles_speed", "1");
  bed.set("fluid_density", "1.2").set("fluid_viscosity", "1.8e-5").set("fluid_initial_velocity", "0, 0, 0.5");
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"}) bed.set(fmt::format("boundary_{}_type", side), "slip");
  bed.set("boundary_z_min_type", "velocity").set("boundary_z_min_velocity", "0, 0, 0.5");
  bed.set("boundary_z_max_type", "pressure");
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  seeds = lattice({7, 7, 6}, 8e-3 / 7, 1e-3);
  for (auto& seed : seeds) seed.velocity = 0.1 * Vec3(unit(random), unit(random), unit(random));
}

}  // namespace

TEST_CASE(
    "a cloud of free fine particles and the fluid reach their common velocity, response time a thousandth of the step",
    "[mpi][coupling]") {
  // k dt/m = 18 mu dt/(rho_p d^2) = 1000
  const double d = 2e-4, dt = 1e-2, mu = 1000 * 1000 * d * d / (18 * dt), side = 1e-2;
  Bed bed;
  periodic_box(bed, side, 4);
  bed.set("fluid_density", "2")
      .set("fluid_viscosity", fmt::format("{:.15g}", mu))
      .set("fluid_initial_velocity", "0.1, 0.05, 0");
  bed.set("drag_type", "stokes_cunningham");
  bed.create(lattice({8, 8, 8}, side / 8, d));
  const double solid = bed.particles->total_mass(), volume = 512 * pi / 6 * d * d * d,
               fluid = 2 * (side * side * side - volume);
  const Vec3 common = fluid * Vec3(0.1, 0.05, 0) / (fluid + solid);
  bed.step(dt);  // finds out that nothing holds the particles
  CHECK(bed.coupling->ledger().residual < 1e-12);
  for (int k = 1; k < 6; ++k) {
    bed.step(dt);
    INFO("step " << k);
    CHECK((bed.mean_velocity() - common).norm() < 2e-3 * common.norm());
    CHECK(bed.largest(bed.fluid->velocity(), 3, 0) == Approx(common[0]).epsilon(2e-3));
    CHECK(bed.least(bed.fluid->velocity(), 3, 1) == Approx(common[1]).epsilon(2e-3));
    CHECK(bed.coupling->ledger().residual < 1e-12);
  }
}

TEST_CASE(
    "a held bed of fine powder lets the fluid through at Darcy's velocity, response time a thousandth of the step",
    "[mpi][coupling]") {
  // Spheres on a simple cubic lattice, pressed together by 0.2 % of their diameter: contacts so stiff that they take up
  // a force well within a step. Model A: alpha dp/dz = n k u with k = 3 pi mu d, n = 1/spacing^3.
  const double d = 1e-4, spacing = 0.998 * d, mu = 1, dt = 1000 * 1000 * d * d / (18 * mu), height = 6 * spacing,
               drop = 10;
  Bed bed;
  bed.set("mesh_upper", fmt::format("{0}, {0}, {1}", 4 * spacing, height)).set("mesh_cells", "2, 2, 3");
  bed.set("material_bead_density", "1000").set("material_bead_young_modulus", "1e7").set("particles_speed", "0.01");
  bed.set("fluid_density", "1").set("fluid_viscosity", "1").set("drag_type", "stokes_cunningham");
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"}) bed.set(fmt::format("boundary_{}_type", side), "slip");
  bed.set("boundary_z_min_type", "pressure").set("boundary_z_min_particles", "wall");
  bed.set("boundary_z_max_type", "pressure").set("boundary_z_max_particles", "wall");
  bed.set("boundary_z_max_pressure", fmt::format("{}", drop));
  bed.create(lattice({4, 4, 6}, spacing, d));
  const double n = 1 / std::pow(spacing, 3), alpha = 1 - n * pi / 6 * d * d * d;
  const double darcy = -alpha * drop / height / (3 * pi * mu * d * n);
  for (int k = 0; k < 90; ++k) bed.step(dt);
  CHECK(bed.largest(bed.fluid->velocity(), 3, 2) == Approx(darcy).epsilon(0.01));
  CHECK(bed.least(bed.fluid->velocity(), 3, 2) == Approx(darcy).epsilon(0.01));
  CHECK(bed.coupling->ledger().residual < 1e-12);
  CHECK(std::abs(bed.mean_velocity()[2]) < 0.01 * std::abs(darcy));
}

TEST_CASE("action equals reaction to round-off in every step of a stirred bed, models A and B", "[mpi][coupling]") {
  for (const std::string model : {"a", "b"}) {
    for (const std::string drag : {"gidaspow", "di_felice"}) {
      Bed bed;
      std::vector<Seed> seeds;
      stirred(bed, seeds);
      bed.set("fluid_model", model).set("drag_type", drag);
      bed.create(seeds);
      Vec3 momentum = bed.particles->momentum(), transit = Vec3::Zero();
      bed.particles->take_impulses();
      for (int k = 0; k < 10; ++k) {
        bed.step(5e-4);
        const ExchangeLedger& ledger = bed.coupling->ledger();
        CHECK(ledger.residual < 1e-12);
        CHECK(ledger.deposited_volume == Approx(ledger.particle_volume).epsilon(1e-12));
        // What the engine says it received is what the ledger says it gave.
        const auto impulses = bed.particles->take_impulses();
        const double scale = impulses.drag.norm() + ledger.delivered.norm() + ledger.given_at_once.norm();
        CHECK((impulses.drag - ledger.drag_on_particles).norm() < 1e-11 * scale);
        CHECK((impulses.fluid_force - ledger.delivered - ledger.buoyancy).norm() < 1e-11 * scale);
        CHECK((impulses.kicks - ledger.given_at_once).norm() < 1e-11 * scale);
        // What was in transit has been delivered, and what is owed now is in transit.
        CHECK((ledger.delivered - transit).norm() < 1e-12 * scale);
        CHECK((ledger.given_at_once + ledger.in_transit - ledger.response_on_particles - ledger.pressure_on_particles)
                  .norm() < 1e-12 * scale);
        transit = ledger.in_transit;
        const Vec3 now = bed.particles->momentum();
        CHECK(
            (now - momentum - impulses.gravity - impulses.walls - impulses.drag - impulses.fluid_force - impulses.kicks)
                .norm() < 1e-10 * (scale + momentum.norm()));
        momentum = now;
      }
    }
  }
}

TEST_CASE("a fluid at rest carries a particle's buoyancy whether its pressure holds the static head or not",
          "[coupling]") {
  // A neutrally heavy particle, rho_p = rho_f, stays where it is.
  for (const std::string model : {"a", "b"}) {
    for (const std::string hydrostatic : {"no", "yes"}) {
      Bed bed;
      bed.gravity = Vec3(0, 0, -9.81);
      bed.set("mesh_upper", "1e-2, 1e-2, 1e-2").set("mesh_cells", "4, 4, 4");
      bed.set("material_bead_density", "1000").set("material_bead_young_modulus", "1e6").set("particles_speed", "1");
      bed.set("fluid_density", "1000")
          .set("fluid_viscosity", "1e-3")
          .set("fluid_model", model)
          .set("fluid_hydrostatic", hydrostatic);
      for (const char* side : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
        bed.set(fmt::format("boundary_{}_type", side), "no_slip");
      bed.create(lattice({1, 1, 1}, 1e-2, 1e-3));
      for (int k = 0; k < 20; ++k) bed.step(1e-3);
      INFO("model " << model << " static head " << hydrostatic
                    << ", velocity after 0.02 s (free fall 0.2 m/s): " << bed.mean_velocity()[2]);
      // With the static head in the pressure the first step has none yet: one step's fall, taken by the drag.
      CHECK(std::abs(bed.mean_velocity()[2]) < (hydrostatic == "no" ? 1e-6 : 1e-2));
    }
  }
}

TEST_CASE("particles that leave through the outlet take nothing from the balance", "[mpi][coupling]") {
  Bed bed;
  std::vector<Seed> seeds;
  stirred(bed, seeds);
  bed.gravity = Vec3::Zero();
  for (auto& seed : seeds) {
    seed.position[2] += 9e-3;
    seed.velocity[2] = 1;
  }
  bed.create(seeds);
  const long long before = bed.particles->total();
  for (int k = 0; k < 10; ++k) {
    bed.particles->take_impulses();
    bed.step(5e-4);
    const ExchangeLedger& ledger = bed.coupling->ledger();
    CHECK(ledger.residual < 1e-12);
    CHECK((bed.particles->take_impulses().drag - ledger.drag_on_particles).norm() <
          1e-11 * ledger.drag_on_particles.norm());
  }
  CHECK(bed.particles->total() < before);
}

TEST_CASE("a bed denser than the filter can show as a mixture stops the run with the place", "[mpi][coupling]") {
  Bed bed;
  periodic_box(bed, 4e-3, 8);
  bed.set("fluid_density", "1").set("fluid_viscosity", "1e-5").set("coupling_filter_length", "0");
  CHECK_THROWS_AS(bed.create(lattice({4, 4, 4}, 1e-3, 1e-3)), RunError);
}

TEST_CASE("a 2D mesh needs the thickness it stands for", "[coupling]") {
  Bed bed;
  bed.set("mesh_cell", "quadrilateral").set("mesh_upper", "1e-2, 1e-2, 0").set("mesh_cells", "4, 4");
  bed.set("fluid_density", "1").set("fluid_viscosity", "1e-5").set("material_bead_density", "1000");
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"})
    bed.set(fmt::format("boundary_{}_type", side), "no_slip");
  CHECK_THROWS_AS(bed.create({}), UserError);
  bed.set("coupling_depth", "1e-3");
  std::vector<Seed> seeds = lattice({2, 2, 1}, 5e-3, 1e-3);
  for (auto& seed : seeds) seed.position[2] = 0;
  bed.create(seeds);
  bed.step(1e-4);
  CHECK(bed.coupling->ledger().deposited_volume == Approx(4 * pi / 6 * 1e-9));
}

TEST_CASE("a mistyped drag law is refused", "[coupling]") {
  Bed bed;
  periodic_box(bed, 1e-2, 4);
  bed.set("fluid_density", "1").set("fluid_viscosity", "1e-5").set("drag_type", "gidaspo");
  CHECK_THROWS_AS(bed.create({}), UserError);
}
