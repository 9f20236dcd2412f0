#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "coupled_case.hpp"
#include "coupling/dispersion.hpp"

using namespace silt;
using test::CoupledCase;

namespace {

constexpr double energy = 0.015, dissipation = 0.15;  // m2/s2, m2/s3: u' = 0.1 m/s, eddies live for 0.03 s

/// A box of 8 m of still fluid with turbulence the same everywhere, and 12^3 particles in its middle that follow it.
CoupledCase turbulent(double density) {
  CoupledCase run;
  run.set("mesh_lower", "-4, -4, -4").set("mesh_upper", "4, 4, 4").set("mesh_cells", "4, 4, 4");
  run.set("fluid_type", "prescribed").set("fluid_density", "1000").set("fluid_viscosity", "1e-3");
  run.set("fluid_turbulent_energy", fmt::format("{}", energy));
  run.set("fluid_turbulent_dissipation", fmt::format("{}", dissipation));
  run.set("coupling_filter_length", "0").set("drag_type", "stokes_cunningham").set("dispersion_type", "random_walk");
  run.set("material_bead_density", fmt::format("{}", density)).set("material_bead_young_modulus", "1e3");
  run.set("particles_speed", "1").set("virtual_mass_coefficient", "0");
  std::vector<Seed> seeds;
  for (int k = 0; k < 1728; ++k) {
    Seed seed;
    seed.radius = 0.5e-3;
    seed.position = 0.05 * Vec3(k % 12 - 5.5, k / 12 % 12 - 5.5, k / 144 - 5.5);
    seeds.push_back(seed);
  }
  run.create(seeds);
  return run;
}

/// Sums over all particles of the mean, the mean square per direction and the count.
struct Spread {
  double mean = 0, square = 0;
};
template <class Of>
Spread spread(const Particles& particles, Of&& of) {
  double sum[2] = {};
  for (int p = 0; p < particles.owned(); ++p) {
    const Vec3 value = of(p);
    sum[0] += value.sum() / 3;
    sum[1] += value.squaredNorm() / 3;
  }
  MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  const auto count = static_cast<double>(particles.total());
  return {sum[0] / count, sum[1] / count};
}

}  // namespace

TEST_CASE("Tracers in turbulence have its rms velocity, and spread with D = 2/3 C_L k^2/epsilon whatever the step",
          "[dispersion][mpi]") {
  // 1728 particles in three directions: 3 standard deviations of a mean square are 3 (2/5184)^1/2 = 6 %.
  const double life = 2 * 0.15 * energy / dissipation, diffusivity = 2.0 / 3.0 * 0.15 * energy * energy / dissipation;
  std::vector<double> squares;
  for (const double dt : {life / 3, life / 0.4}) {
    auto run = turbulent(1e-3);  // response time 6e-11 s
    std::map<std::int64_t, Vec3> start;
    for (int p = 0; p < run.particles->owned(); ++p) start[run.particles->id(p)] = run.particles->position(p);
    const int steps = static_cast<int>(std::lround(60 * life / dt));
    for (int n = 0; n < steps; ++n) {
      run.coupling->before_particles(dt);
      if (n == 0 && dt < life) {
        const Spread fluid =
            spread(*run.particles, [&](int p) { return Vec3(vec3(run.particles->fluid_action(p).velocity)); });
        CHECK(fluid.square == Approx(2.0 / 3.0 * energy).epsilon(0.06));
        CHECK(std::abs(fluid.mean) < 3 * 0.1 / std::sqrt(5184.0));
      }
      // Only the way of a tracer is asked for: the engine would take 1e9 response times for it.
      for (int p = 0; p < run.particles->owned(); ++p)
        start[run.particles->id(p)] -= dt * Vec3(vec3(run.particles->fluid_action(p).velocity));
    }
    const Spread way = spread(*run.particles,
                              [&](int p) { return Vec3(start.at(run.particles->id(p)) - run.particles->position(p)); });
    INFO("step " << dt << ": " << way.square);
    CHECK(way.square == Approx(2 * diffusivity * 60 * life).epsilon(0.06));
    squares.push_back(way.square);
  }
  CHECK(squares[0] == Approx(squares[1]).epsilon(1e-9));  // the same eddies in either step
}

TEST_CASE("A particle with inertia that falls through eddies leaves them after the time to cross them",
          "[dispersion]") {
  RandomWalkDispersion law;
  const TurbulenceAround flow{energy, dissipation};
  const double length = std::pow(0.09, 0.75) * std::pow(energy, 1.5) / dissipation;
  CHECK(law.eddy_life(flow) == Approx(0.03));
  // Fast and heavy: l/|u - v|; slow: it relaxes before it has crossed.
  CHECK(law.eddy_crossing(flow, 1.0, 100 * length) == Approx(0.01).epsilon(0.006));
  CHECK(law.eddy_crossing(flow, 1.0, 2 * length) == Approx(std::log(2.0)));
  CHECK(law.eddy_crossing(flow, 1.0, 0.9 * length) == infinity);
  CHECK(law.eddy_crossing(flow, 0.0, 1.0) == infinity);
  law.crossing = false;
  CHECK(law.eddy_crossing(flow, 1.0, 100 * length) == infinity);
}

TEST_CASE("Particles with inertia take up the turbulence as their response time lets them", "[dispersion][mpi]") {
  // From eddy to eddy v' = v E + u' (1 - E), E = exp(-life/tau): <v^2> = u'^2 (1 - E)/(1 + E).
  auto run = turbulent(540);  // tau = rho d^2/(18 mu) = 0.03 s, the life of an eddy
  run.set("dispersion_crossing", "no");
  run.coupling.reset();
  run.coupling = std::make_unique<Coupling>(*run.mesh, *run.particles, *run.fluid, run.options, run.gravity);
  for (int n = 0; n < 12; ++n) run.step(0.03);
  const double left = std::exp(-1.0);
  const Spread speed = spread(*run.particles, [&](int p) { return Vec3(run.particles->velocity(p)); });
  CHECK(speed.square == Approx(2.0 / 3.0 * energy * (1 - left) / (1 + left)).epsilon(0.06));
}

TEST_CASE("Dispersion without turbulence is refused, and so is half of it", "[dispersion]") {
  for (const bool half : {false, true}) {
    CoupledCase run;
    run.set("mesh_cells", "2, 2, 2").set("fluid_type", "prescribed").set("fluid_density", "1");
    run.set("fluid_viscosity", "1e-5").set("material_bead_density", "1000").set("dispersion_type", "random_walk");
    if (half) run.set("fluid_turbulent_energy", "1");
    CHECK_THROWS_AS(run.create({}), UserError);
  }
}
