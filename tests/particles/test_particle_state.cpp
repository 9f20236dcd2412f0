#include <catch2/catch.hpp>
#include <cmath>

#include "gas_box.hpp"

using namespace silt;

namespace {

BoxCase gas_case() {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(8e-3));
  setup.gravity = {0, 0, -9.81};
  setup.set("material_bead_young_modulus", "1e6").set("material_bead_friction", "0.4").set("particles_speed", "1");
  return setup;
}

}  // namespace

TEST_CASE("A step repeated from a snapshot ends where it ended before", "[particles][mpi]") {
  BoxRun run(gas_case());
  run.particles.add(gas(7, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3, 0.1));
  run.particles.advance(0, 3e-3);
  run.particles.take_impulses();
  const auto snapshot = run.particles.snapshot();
  const auto start = gather(run.particles);
  run.particles.advance(3e-3, 2e-3);
  const auto first = gather(run.particles);
  const Vec3 wall = run.particles.take_impulses().walls;
  run.particles.restore(*snapshot);
  const auto back = gather(run.particles);
  for (const auto& [id, s] : start)
    for (int d = 0; d < 3; ++d) REQUIRE(s.x[d] == back.at(id).x[d]);
  run.particles.advance(3e-3, 2e-3);
  const auto second = gather(run.particles);
  double largest = 0;
  for (const auto& [id, s] : first)
    for (int d = 0; d < 3; ++d) largest = std::max(largest, std::abs(s.v[d] - second.at(id).v[d]));
  CHECK(largest < 1e-10);  // the order of sums over contacts may differ
  CHECK((run.particles.take_impulses().walls - wall).norm() < 1e-10 * wall.norm());
}

TEST_CASE("Held particles stay where they are and pass on to their support what acts on them", "[particles][mpi]") {
  BoxCase setup = gas_case();
  setup.set("particles_fixed", "yes");
  BoxRun run(setup);
  run.particles.add(gas(4, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3));  // of a file, say: with velocities
  run.particles.settle();
  CHECK(run.particles.momentum().norm() == 0);
  const auto before = gather(run.particles);
  for (int i = 0; i < run.particles.owned(); ++i) {
    FluidAction& action = run.particles.fluid_action(i);
    vec3(action.velocity) = Vec3(0, 0, 1);
    action.exchange = 1e-3;
    vec3(action.force) = Vec3(0, 0, 2e-3);
  }
  run.particles.advance(0, 0.5);
  const auto got = run.particles.take_impulses();
  CHECK(got.drag[2] == Approx(64 * 1e-3 * 0.5));
  CHECK(got.fluid_force[2] == Approx(64 * 2e-3 * 0.5));
  CHECK(got.gravity[2] == Approx(-9.81 * run.particles.total_mass() * 0.5));
  CHECK((got.drag + got.fluid_force + got.gravity + got.walls).norm() < 1e-15);
  CHECK(run.particles.momentum().norm() == 0);
  for (int i = 0; i < run.particles.owned(); ++i) CHECK(run.particles.fluid_action(i).held == 1);
  const auto after = gather(run.particles);
  for (const auto& [id, s] : before)
    for (int d = 0; d < 3; ++d) REQUIRE(s.x[d] == after.at(id).x[d]);
}

TEST_CASE("The swarm shows the particles as they are", "[particles][mpi]") {
  BoxRun run(gas_case());
  run.particles.add(gas(5, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3));
  for (int n = 0; n < 2; ++n) {
    run.particles.advance(n * 1e-3, 1e-3);
    DM swarm = run.particles.swarm();
    PetscInt size = 0;
    SILT_PETSC(DMSwarmGetSize(swarm, &size));
    CHECK(size == 125);
    Vec velocity;
    SILT_PETSC(DMSwarmCreateGlobalVectorFromField(swarm, "velocity", &velocity));
    PetscReal norm = 0;
    SILT_PETSC(VecNorm(velocity, NORM_2, &norm));
    SILT_PETSC(DMSwarmDestroyGlobalVectorFromField(swarm, "velocity", &velocity));
    CHECK(norm * norm * run.particles.total_mass() / 125 / 2 == Approx(run.particles.kinetic_energy()).epsilon(1e-12));
  }
}

TEST_CASE("Spheres on the sides of a small periodic box, and gliding along them, stay held by some rank",
          "[particles][mpi]") {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(1e-3)).periodic();
  setup.set("material_bead_young_modulus", "1e6").set("particles_speed", "1");
  BoxRun run(setup);
  // A lattice with places on three sides; those on y = 1 mm glide along it.
  std::vector<Seed> seeds;
  for (int k = 0; k < 4; ++k)
    for (int j = 1; j < 5; ++j)
      for (int i = 0; i < 4; ++i)
        seeds.push_back(sphere(Vec3(i, j, k) * 0.25e-3, j == 4 ? Vec3(0.25, 0, 0.125) : Vec3::Zero(), 40e-6));
  run.particles.add(seeds);
  for (int n = 0; n < 20; ++n) {
    run.particles.advance(n * 1e-4, 1e-4);
    const auto state = gather(run.particles);
    REQUIRE(state.size() == seeds.size());
    for (const auto& [id, s] : state) {
      const Vec3 away = vec3(s.x) - seeds[id].position - (n + 1) * 1e-4 * seeds[id].velocity;
      for (int d = 0; d < 3; ++d) CHECK(std::abs(std::remainder(away[d], 1e-3)) < 1e-12);
    }
  }
  CHECK(run.particles.departed().empty());
}
