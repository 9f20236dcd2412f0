// What particles do to the turbulence of the fluid.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <numbers>

#include "base/error.hpp"
#include "coupled_case.hpp"

using namespace silt;
using test::CoupledCase;

namespace {

constexpr double k0 = 2, epsilon0 = 3, viscosity = 1e-5, diameter = 1e-3, pi = std::numbers::pi;
constexpr double C_mu = 0.09;

std::vector<Seed> lattice(double slip) {
  std::vector<Seed> seeds;
  for (int k = 0; k < 64; ++k) {
    Seed seed;
    seed.position = 5e-3 * Vec3(k % 4 + 0.5, k / 4 % 4 + 0.5, k / 16 + 0.5);
    seed.velocity = Vec3(0, 0, slip);
    seed.radius = diameter / 2;
    seeds.push_back(seed);
  }
  return seeds;
}

/// Uniform turbulence in a periodic box with heavy beads on a lattice whose void fraction is uniform.
void turbulent(CoupledCase& run, const std::string& turbulence, const std::string& model, double density, double slip) {
  run.set("mesh_upper", "0.02, 0.02, 0.02").set("mesh_cells", "4, 4, 4").set("mesh_periodic", "1, 1, 1");
  run.set("fluid_density", "1")
      .set("fluid_viscosity", fmt::format("{}", viscosity))
      .set("fluid_turbulence", turbulence);
  run.set("fluid_initial_turbulent_energy", std::to_string(k0)).set("fluid_turbulence_largest_ratio", "1e20");
  const double omega0 = epsilon0 / (C_mu * k0);
  const double eddy = turbulence == "sst_k_omega" ? k0 / omega0 : C_mu * k0 * k0 / epsilon0;
  run.set("fluid_initial_viscosity_ratio", fmt::format("{:.15g}", eddy / viscosity));
  run.set("material_bead_density", fmt::format("{}", density)).set("material_bead_young_modulus", "1e6");
  run.set("particles_speed", "1").set("drag_type", "stokes_cunningham").set("modulation_type", model);
  run.create(lattice(slip));
}

double mean(const CoupledCase& run, std::span<const double> values) {
  return run.mesh->dot(run.coupling->mass().data(), values.data(), 1) / run.mesh->volume;
}

}  // namespace

TEST_CASE("A model of modulation has its value and its limits", "[coupling][modulation]") {
  const DragDissipation law;
  ParticleInTurbulence p{2, 3, 1e-4, 1e-6, 0, 0};
  const double stokes = (1e-6 / 1e-4) / (1.5 * C_mu * 2 / 3);
  CHECK(law.work(p) == Approx(-2 * 1e-4 * 2 * stokes / (1 + stokes)));
  p.held = 1;
  CHECK(law.work(p) == Approx(-4e-4));
  p.held = 0, p.mass = 1e6;  // too heavy to follow
  CHECK(law.work(p) == Approx(-4e-4));
  p.mass = 1e-15;  // a tracer
  CHECK(std::abs(law.work(p)) < 1e-8 * 4e-4);
  p.slip = 3;
  CHECK(SlipProduction{}.work(p) == Approx(9e-4));
}

TEST_CASE("Turbulence among particles too heavy to follow it decays as the equations say",
          "[coupling][modulation][mpi]") {
  // With D = 2 n k_p/(alpha rho): k' = -epsilon - D k, epsilon' = -C2 epsilon^2/k - C D epsilon. w = epsilon/k obeys
  // Bernoulli's equation w' = -a w^2 - b w, a = C2 - 1, b = (C - 1) D; and k' = -(w + D) k. The same with omega =
  // w/beta*, a = beta_2/beta*.
  const std::string turbulence = GENERATE("realizable_k_epsilon", "sst_k_omega");
  CAPTURE(turbulence);
  CoupledCase run;
  turbulent(run, turbulence, "drag_dissipation", 1e12, 0);
  const double volume = 8e-6, alpha = 1 - 64 * pi / 6 * std::pow(diameter, 3) / volume;
  const double D = 2 * 64 / volume * 3 * pi * viscosity * diameter / alpha;
  const double a = turbulence == "sst_k_omega" ? 0.0828 / 0.09 : 0.9, b = 0.2 * D, w0 = epsilon0 / k0, end = 1;
  const int steps = 400;
  for (int n = 0; n < steps; ++n) run.step(end / steps);
  const double grown = 1 + a * w0 / b * (1 - std::exp(-b * end));
  const double k = k0 * std::exp(-D * end) * std::pow(grown, -1 / a), w = w0 * std::exp(-b * end) / grown;
  CHECK(D > 1);
  CHECK(mean(run, run.fluid->turbulent_energy()) == Approx(k).epsilon(0.01));
  CHECK(mean(run, run.fluid->turbulent_dissipation()) == Approx(k * w).epsilon(0.01));
  CHECK(run.coupling->modulation()->given() < 0);
  CHECK(run.coupling->modulation()->received() == Approx(run.coupling->modulation()->given()).epsilon(1e-12));
}

TEST_CASE("Slip feeds the turbulence with the work of the drag", "[coupling][modulation][mpi]") {
  CoupledCase run;
  turbulent(run, "realizable_k_epsilon", "slip_production", 1e12, 0.5);
  run.step(1e-4);
  const double work = 64 * 3 * pi * viscosity * diameter * 0.25;
  CHECK(run.coupling->modulation()->given() == Approx(work).epsilon(1e-3));
  CHECK(run.coupling->modulation()->received() == Approx(run.coupling->modulation()->given()).epsilon(1e-12));
}

TEST_CASE("Modulation without equations of turbulence is refused", "[coupling][modulation]") {
  CoupledCase run;
  run.set("mesh_cells", "2, 2, 2").set("mesh_periodic", "1, 1, 1").set("fluid_density", "1");
  run.set("fluid_viscosity", "1e-5").set("material_bead_density", "1000").set("modulation_type", "drag_dissipation");
  CHECK_THROWS_AS(run.create({}), UserError);
}
