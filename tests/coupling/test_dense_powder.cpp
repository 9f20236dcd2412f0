// Fine powder that moves freely and fills more than half of the volume, with a response time far below the fluid step.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <numbers>

#include "coupled_case.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double diameter = 1e-4, solids = 0.6, bead_density = 1000, viscosity = 1;
const double edge = diameter * std::cbrt(4 * pi / 6 / solids);  // of the cubic cell of the face-centred lattice
const double response_time = bead_density * diameter * diameter / (18 * viscosity);

/// Layers first..last-1 of a face-centred lattice of 2 x 2 cubic cells, half an edge apart, that touches nothing.
std::vector<Seed> lattice(int first, int last) {
  std::vector<Seed> seeds;
  for (int k = first; k < last; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i)
        if ((i + j + k) % 2 == 0) {
          Seed seed;
          seed.position = edge / 2 * Vec3(i + 0.5, j + 0.5, k + 0.5);
          seed.radius = diameter / 2;
          seeds.push_back(seed);
        }
  return seeds;
}

struct Powder : test::CoupledCase {
  Powder(const std::string& scheme, int layers, const std::string& element = "equal_order") {
    const double height = layers * edge / 2;
    set("mesh_upper", fmt::format("{0}, {0}, {1}", 2 * edge, height));
    set("mesh_cells", fmt::format("3, 3, {}", static_cast<int>(std::lround(height / diameter))));
    set("material_bead_density", fmt::format("{}", bead_density)).set("material_bead_young_modulus", "1e5");
    set("particles_speed", "0.01").set("drag_type", "stokes_cunningham").set("fluid_scheme", scheme);
    set("fluid_density", "2").set("fluid_viscosity", fmt::format("{}", viscosity));
    if (scheme == "monolithic")
      set("fluid_element", element);
    else
      set("fluid_velocity_tolerance", "1e-13");
  }
  /// Largest less smallest velocity of the fluid in direction d.
  double spread(int d) const {
    double least = 1e300, most = -1e300;
    for (int i = 0; i < mesh->nodes; ++i) {
      least = std::min(least, fluid->velocity()[3 * static_cast<size_t>(i) + d]);
      most = std::max(most, fluid->velocity()[3 * static_cast<size_t>(i) + d]);
    }
    return mpi_max(most) - mpi_min(least);
  }
  /// Momentum of both phases, of what is on its way between them, and of what the fluid has felt in advance.
  Vec3 momentum() const { return flow.momentum + flow.lent + particles->momentum() + coupling->ledger().in_transit; }
};

}  // namespace

TEST_CASE("dense powder that moves freely comes to rest with the fluid, whatever its response time",
          "[mpi][coupling][dense]") {
  // Particles move with the flow of the step before and hand its pressure on a step late. Unless the flow counts on
  // both, every step turns a wave over, (1 - alpha)/alpha = 1.5 times as high, or higher.
  const std::string scheme = GENERATE("pressure_correction", "monolithic");
  const double stiffness = GENERATE(1000.0, 100.0, 1.0);  // k dt/m
  CAPTURE(scheme, stiffness);
  Powder powder(scheme, 40);
  powder.set("mesh_periodic", "1, 1, 1");
  const double dt = stiffness * response_time, speed = 1e-3 * diameter / dt, length = 20 * edge;
  powder.set("fluid_initial_velocity", fmt::format("{0}*sin({1}*z), 0, {0}*cos({1}*z)", speed, 2 * pi / length));
  powder.create(lattice(0, 40));
  for (int k = 0; k < 26; ++k) {
    powder.step(dt);
    CHECK(powder.coupling->ledger().residual < 1e-12);
  }
  CHECK(powder.spread(2) < 0.02 * 2 * speed);  // 2: crest to trough
  CHECK(powder.spread(0) < 0.05 * 2 * speed);
}

TEST_CASE("dense powder and the fluid reach their common velocity, and no momentum is lost on the way",
          "[mpi][coupling][dense]") {
  // Momentum of both phases, of what is on its way between them and of what the fluid has felt in advance.
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const double stiffness = GENERATE(1000.0, 100.0);
  CAPTURE(element, stiffness);
  Powder powder("monolithic", 20, element);
  powder.set("mesh_periodic", "1, 1, 1").set("fluid_order", "1").set("fluid_density", "500");
  PetscOptionsSetValue(nullptr, "-fluid_snes_rtol", "1e-12");
  const double dt = stiffness * response_time, speed = 0.05 * diameter / dt;
  powder.set("fluid_initial_velocity", fmt::format("0.1*{0}*sin({1}*z), 0, {0}", speed, 2 * pi / (10 * edge)));
  powder.create(lattice(0, 20));
  const double dust = powder.particles->total_mass(), gas = 500 * (1 - solids) / solids * dust / bead_density;
  for (int k = 0; k < 8; ++k) {
    powder.step(dt);
    INFO("step " << k);
    CHECK(powder.momentum().z() / (gas * speed) == Approx(1).epsilon(1e-5));  // convection is not in conservation form
    CHECK(std::abs(powder.momentum().x()) < 1e-3 * gas * speed);
  }
  PetscOptionsClearValue(nullptr, "-fluid_snes_rtol");
  CHECK(powder.particles->momentum().z() / dust / (gas * speed / (gas + dust)) == Approx(1).epsilon(1e-3));
}

TEST_CASE("a column of dense powder falls at its hindered velocity, response time a hundredth of the step",
          "[mpi][coupling][dense]") {
  // Closed below and above: alpha u + (1 - alpha) v = 0. With the drag k = 3 pi mu d and -V_p grad p = (1 -
  // alpha)/alpha k (u - v) of model A a particle falls at alpha^2 W/k, W its weight less the buoyancy.
  const std::string scheme = GENERATE("pressure_correction", "monolithic");
  const double stiffness = GENERATE(100.0, 10.0);
  CAPTURE(scheme, stiffness);
  Powder powder(scheme, 60);
  const double dt = stiffness * response_time, k = 3 * pi * viscosity * diameter;
  const double volume = pi / 6 * std::pow(diameter, 3), alpha = 1 - solids;
  const double falls = 5e-3 * diameter / dt, gravity = falls * k / (alpha * alpha * (bead_density - 2) * volume);
  powder.gravity = Vec3(0, 0, -gravity);
  powder.set("mesh_periodic", "1, 1, 0").set("boundary_z_min_type", "slip").set("boundary_z_max_type", "slip");
  powder.create(lattice(10, 50));
  double fastest = 0;
  for (int step = 0; step < 30; ++step) {
    powder.step(dt);
    CHECK(powder.coupling->ledger().residual < 1e-12);
    if (step < 15) continue;
    double sum = 0, count = 0;
    for (int p = 0; p < powder.particles->owned(); ++p) {
      const double z = powder.particles->position(p).z() / (edge / 2);
      fastest = std::max(fastest, powder.particles->velocity(p).norm());
      if (z > 22 && z < 38) sum += powder.particles->velocity(p).z(), count += 1;
    }
    INFO("step " << step);
    CHECK(mpi_sum(sum) / mpi_sum(count) == Approx(-falls).epsilon(0.02));
  }
  CHECK(mpi_max(fastest) < 10 * falls);  // at most W/k at the column's ends, alpha^-2 = 6.25 times as fast
}
