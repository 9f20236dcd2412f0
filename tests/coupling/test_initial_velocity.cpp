// A velocity given at the start, among particles.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "coupled_case.hpp"

using namespace silt;
using test::CoupledCase;

namespace {

constexpr double diameter = 1e-3, spacing = 1.05e-3, side = 4 * spacing;

/// Layers of a cubic lattice that fill the width of a column.
std::vector<Seed> layers(int first, int last, double velocity) {
  std::vector<Seed> seeds;
  for (int k = first; k < last; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        Seed seed;
        seed.position = spacing * Vec3(i + 0.5, j + 0.5, k + 0.5);
        seed.velocity = Vec3(0, 0, velocity);
        seed.radius = diameter / 2;
        seeds.push_back(seed);
      }
  return seeds;
}

void column(CoupledCase& run, const std::string& scheme, const std::string& element) {
  run.set("mesh_upper", fmt::format("{0}, {0}, {1}", side, 4 * side)).set("mesh_cells", "3, 3, 12");
  run.set("fluid_density", "1.2").set("fluid_viscosity", "1.8e-5").set("fluid_scheme", scheme);
  run.set("fluid_element", element);
  run.set("material_bead_density", "1000").set("material_bead_young_modulus", "1e6").set("particles_speed", "1");
  for (const char* name : {"x_min", "x_max", "y_min", "y_max"}) run.set(fmt::format("boundary_{}_type", name), "slip");
}

}  // namespace

TEST_CASE("A flow given at the start passes a bed with its superficial velocity from the first step",
          "[coupling][mpi]") {
  const auto [scheme, element] = GENERATE(table<std::string, std::string>(
      {{"pressure_correction", "equal_order"}, {"monolithic", "equal_order"}, {"monolithic", "taylor_hood"}}));
  CAPTURE(scheme, element);
  CoupledCase run;
  column(run, scheme, element);
  run.set("boundary_z_min_type", "velocity")
      .set("boundary_z_min_velocity", "0, 0, 0.6")
      .set("boundary_z_max_type", "pressure");
  run.set("fluid_initial_velocity", "0, 0, 0.6");
  run.create(layers(0, 8, 0));
  run.coupling->start();
  const auto alpha = std::span<const double>(run.fluid->load().void_fraction);
  double least = 1;
  for (int i = 0; i < run.mesh->nodes; ++i) {
    CHECK(alpha[i] * run.fluid->velocity()[3 * static_cast<size_t>(i) + 2] ==
          Approx(0.6).epsilon(0.04));  // at the bed's surface
    least = std::min(least, alpha[i]);
  }
  CHECK(mpi_min(least) < 0.6);
  // The drag of the first step is that of the second, which continuity has made right.
  const double dt = 1e-4;
  run.step(dt);
  const double first = run.coupling->ledger().drag_on_particles.z();
  run.step(dt);
  CHECK(first == Approx(run.coupling->ledger().drag_on_particles.z()).epsilon(0.05));
}

TEST_CASE("A plug of particles that starts moving drives the fluid around it through it", "[coupling][mpi]") {
  const std::string scheme = GENERATE("pressure_correction", "monolithic");
  CoupledCase run;
  column(run, scheme, "equal_order");
  run.set("boundary_z_min_type", "slip").set("boundary_z_max_type", "slip");
  run.create(layers(4, 12, 0.1));
  run.coupling->start();
  for (int i = 0; i < run.mesh->nodes; ++i) {
    const double alpha = run.fluid->load().void_fraction[i];
    CHECK(alpha * run.fluid->velocity()[3 * static_cast<size_t>(i) + 2] == Approx(-(1 - alpha) * 0.1).margin(2e-3));
  }
}
