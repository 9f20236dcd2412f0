#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "gas_box.hpp"

using namespace silt;

namespace {

BoxCase gas_case() {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(8e-3)).periodic();
  setup.set("material_bead_young_modulus", "1e6").set("material_bead_restitution", "0.8");
  setup.set("material_bead_friction", "0.4").set("particles_speed", "1");
  return setup;
}

double largest_difference(const std::map<std::int64_t, State>& a, const std::map<std::int64_t, State>& b) {
  double largest = 0;
  REQUIRE(a.size() == b.size());
  for (const auto& [id, s] : a)
    for (int d = 0; d < 3; ++d) {
      largest = std::max(largest, std::abs(s.x[d] - b.at(id).x[d]) / 1e-3);
      largest = std::max(largest, std::abs(s.v[d] - b.at(id).v[d]) / 0.3);
      largest = std::max(largest, std::abs(s.w[d] - b.at(id).w[d]) / 300);
    }
  return largest;
}

}  // namespace

TEST_CASE("Collisions conserve the momentum of a gas to round-off, on any number of ranks", "[particles][mpi]") {
  BoxRun run(gas_case());
  run.particles.add(gas(7, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3));
  const Vec3 before = run.particles.momentum();
  const double scale = run.particles.total_mass() * 0.3;
  int contacts = 0, rebuilds = 0;
  for (int n = 0; n < 10; ++n) {
    const ParticleStep step = run.particles.advance(n * 2e-3, 2e-3);
    contacts += static_cast<int>(step.contacts);
    rebuilds += step.rebuilds;
  }
  CHECK(contacts > 100);
  CHECK(rebuilds > 3);
  CHECK((run.particles.momentum() - before).norm() < 1e-13 * scale);
  CHECK(run.particles.total() == 343);
}

TEST_CASE("Rough collisions conserve the angular momentum of a cloud, spin included, to round-off",
          "[particles][mpi]") {
  BoxCase setup;
  setup.box(Vec3::Constant(-20e-3), Vec3::Constant(20e-3));
  setup.set("material_bead_young_modulus", "1e6").set("material_bead_restitution", "0.8");
  setup.set("rolling_type", "constant").set("material_bead_rolling_friction", "0.1").set("particles_speed", "1");
  BoxRun run(setup);
  auto seeds = gas(4, Vec3::Constant(-3e-3), Vec3::Constant(3e-3), 0.5e-3, 0.2, 0.3);
  for (auto& seed : seeds) seed.velocity -= 60 * seed.position;  // the cloud falls together
  run.particles.add(seeds);
  const Vec3 before = run.particles.angular_momentum(Vec3::Zero());
  const double energy = run.particles.kinetic_energy();
  for (int n = 0; n < 10; ++n) run.particles.advance(n * 2e-3, 2e-3);
  CHECK(run.particles.kinetic_energy() < 0.8 * energy);
  const double scale = run.particles.total_mass() * 0.3 * 3e-3;
  CHECK((run.particles.angular_momentum(Vec3::Zero()) - before).norm() < 1e-12 * scale);
}

TEST_CASE("A frictionless elastic gas keeps its energy, to second order in the step", "[particles]") {
  double previous = 0;
  for (const double factor : {1.0, 0.5, 0.25}) {
    BoxCase setup = gas_case();
    setup.set("material_bead_restitution", "1").set("material_bead_friction", "0");
    setup.set("particles_step", std::to_string(16e-6 * factor)).set("particles_step_override", "yes");
    BoxRun run(setup);
    // Pairs on their own, each of which collides once: the error is that of the integrator, not of chaos.
    std::vector<Seed> seeds;
    Random random(3);
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const Vec3 centre = Vec3(i + 0.5, j + 0.5, k + 0.5) * (8e-3 / 3), along = random.vector(1).normalized();
          seeds.push_back(sphere(centre + 0.6e-3 * along, -random(0.1, 0.3) * along, 0.5e-3));
          seeds.push_back(sphere(centre - 0.6e-3 * along, random(0.1, 0.3) * along, 0.5e-3));
        }
    run.particles.add(seeds);
    const double before = run.particles.kinetic_energy();
    run.particles.advance(0, 2e-3);
    CHECK(run.particles.advance(2e-3, 1e-5).contacts == 0);
    CHECK(run.particles.rotational_energy() == Approx(0).margin(1e-20 * before));
    const double error = std::abs(run.particles.kinetic_energy() - before) / before;
    INFO("step factor " << factor << " error " << error);
    CHECK(error < 2e-3 * factor * factor);
    previous = error;
  }
  (void)previous;
}

TEST_CASE("The trajectories of a gas do not depend on how the ranks share the domain", "[particles][mpi]") {
  const auto seeds = gas(7, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3, 0.1);
  BoxCase coarse = gas_case(), fine = gas_case();
  SECTION("periodic") {
    coarse.mesh.cells = {3, 3, 3};
    fine.mesh.cells = {5, 4, 3};
  }
  SECTION("walled; the coarse mesh is one cell, so all ranks but one are empty: the run of a single rank") {
    coarse.mesh.cells = {1, 1, 1};
    fine.mesh.cells = {5, 4, 3};
    coarse.mesh.periodic = fine.mesh.periodic = {0, 0, 0};
    coarse.gravity = fine.gravity = {0, 0, -9.81};
  }
  BoxRun a(coarse), b(fine);
  a.particles.add(seeds), b.particles.add(seeds);
  for (int n = 0; n < 4; ++n) {
    a.particles.advance(n * 1e-3, 1e-3);
    b.particles.advance(n * 1e-3, 1e-3);
  }
  CHECK(largest_difference(gather(a.particles), gather(b.particles)) < 1e-9);
}

TEST_CASE("Plain, AVX2 and AVX-512 loops give the same trajectories", "[particles]") {
  const auto seeds = gas(7, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3, 0.2);
  std::map<std::int64_t, State> reference;
  for (const char* instructions : {"plain", "avx2", "avx512"}) {
    __builtin_cpu_init();
    if (std::string(instructions) == "avx2" && !__builtin_cpu_supports("avx2")) continue;
    if (std::string(instructions) == "avx512" && !__builtin_cpu_supports("avx512dq")) continue;
    BoxCase setup = gas_case();
    setup.set("particles_instructions", instructions);
    BoxRun run(setup);
    run.particles.add(seeds);
    run.particles.advance(0, 3e-3);
    const auto state = gather(run.particles);
    if (reference.empty())
      reference = state;
    else
      CHECK(largest_difference(reference, state) < 1e-9);
  }
}

TEST_CASE("The same run gives the same bits", "[particles][mpi]") {
  const auto seeds = gas(6, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3, 0.1);
  BoxCase setup = gas_case();
  const Mesh mesh(setup.mesh);  // shared, as the partitioner need not find the same parts twice
  Particles a(mesh, setup.options, setup.gravity), b(mesh, setup.options, setup.gravity);
  a.add(seeds), b.add(seeds);
  a.advance(0, 5e-3), b.advance(0, 5e-3);
  CHECK(largest_difference(gather(a), gather(b)) == 0.0);
}

TEST_CASE("The impulses told add up to the change of momentum", "[particles][mpi]") {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3(8e-3, 8e-3, 16e-3));
  setup.mesh.cells = {2, 2, 5};
  setup.gravity = {1, 0, -9.81};
  setup.set("boundary_z_min_particles", "outlet").set("particles_speed", "1");
  setup.set("material_bead_young_modulus", "1e6");
  BoxRun run(setup);
  run.particles.add(gas(6, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3));
  Vec3 before = Vec3::Zero();
  long long removed = 0;
  for (int n = 0; n < 12; ++n) {
    for (int i = 0; i < run.particles.owned(); ++i) {
      FluidAction& action = run.particles.fluid_action(i);
      vec3(action.velocity) = Vec3(0.2, 0, -0.4);
      action.exchange = run.particles.mass(i) * (n % 2 ? 2e3 : 50);
      vec3(action.force) = Vec3(0, 0, 1e-6);
      for (double& component : action.impulse) component = 0;
    }
    removed = run.particles.advance(n * 2e-3, 2e-3).removed;
    Vec3 drag = Vec3::Zero();
    for (int i = 0; i < run.particles.owned(); ++i) drag += vec3(run.particles.fluid_action(i).impulse);
    for (const auto& gone : run.particles.departed()) drag += vec3(gone.action.impulse);
    if (run.particles.owned() > 0) run.particles.kick(0, Vec3(1e-9, 0, 2e-9));
    const auto got = run.particles.take_impulses();
    const Vec3 after = run.particles.momentum();
    const Vec3 sum = got.gravity + got.walls + got.drag + got.fluid_force + got.kicks + got.added + got.removed;
    const double scale = got.drag.norm() + got.gravity.norm() + got.removed.norm() + before.norm();
    CHECK((after - before - sum).norm() < 1e-12 * scale);
    const Vec3 all_drag(mpi_sum(drag[0]), mpi_sum(drag[1]), mpi_sum(drag[2]));
    CHECK((all_drag - got.drag).norm() < 1e-12 * (all_drag.norm() + 1e-300));
    before = after;
  }
  CHECK(removed > 20);
  CHECK(run.particles.total() == 216 - removed);
}

TEST_CASE("Drag is integrated exactly whatever the step, and its impulse is what the momentum gained", "[particles]") {
  for (const double rate : {1e-3, 3.0, 1e3, 1e9}) {
    BoxCase setup;
    setup.box(Vec3::Constant(-1), Vec3::Constant(1));
    setup.gravity = {0, 0, -9.81};
    setup.set("particles_step", "0.01").set("particles_step_override", "yes").set("particles_skin", "0.2");
    BoxRun run(setup);
    run.particles.add({sphere(Vec3::Zero(), Vec3(0.1, 0, 0), 0.05)});
    FluidAction& action = run.particles.fluid_action(0);
    const double mass = run.particles.mass(0), time = 0.03;
    vec3(action.velocity) = Vec3(0, 0.5, 0);
    action.exchange = rate * mass;
    vec3(action.force) = Vec3(0, 0, 4 * mass);
    run.particles.advance(0, time);
    const Vec3 terminal = Vec3(0, 0.5, 0) + Vec3(0, 0, 4 - 9.81) / rate;
    const Vec3 expected = terminal + std::exp(-rate * time) * (Vec3(0.1, 0, 0) - terminal);
    const Vec3 way = terminal * time - std::expm1(-rate * time) / rate * (Vec3(0.1, 0, 0) - terminal);
    const double tolerance = rate < 1 ? 1e-9 : 1e-12;  // the closed form itself cancels for a small rate
    CHECK((run.particles.velocity(0) - expected).norm() < tolerance);
    CHECK((run.particles.position(0) - way).norm() < tolerance);
    const Vec3 gained = mass * (run.particles.velocity(0) - Vec3(0.1, 0, 0)) - mass * time * Vec3(0, 0, 4 - 9.81);
    CHECK((vec3(run.particles.fluid_action(0).impulse) - gained).norm() < 1e-12 * mass);
  }
}

TEST_CASE("A sheared pair keeps its tangential spring when it crosses ranks", "[particles][mpi]") {
  // Two spheres pressed together and sheared move along the box through every rank; a third run stands still.
  const double radius = 0.5e-3;
  const auto run_at = [&](double drift) {
    BoxCase setup;
    setup.box(Vec3(0, 0, 0), Vec3(60e-3, 6e-3, 6e-3));
    setup.mesh.cells = {30, 2, 2};
    setup.set("material_bead_restitution", "0.9").set("material_bead_friction", "0.9").set("particles_speed", "1");
    setup.set("material_bead_young_modulus", "1e5").set("particles_step", "1e-5");
    BoxRun run(setup);
    const Vec3 carried(drift, 0, 0);
    run.particles.add({sphere(Vec3(3e-3, 3e-3, 2.55e-3), carried + Vec3(0, 0.02, 0), radius),
                       sphere(Vec3(3e-3, 3e-3, 3.53e-3), carried - Vec3(0, 0.02, 0), radius)});
    int rebuilds = 0;
    for (int n = 0; n < 20; ++n) {
      for (int i = 0; i < run.particles.owned(); ++i)  // held together by a constant force
        vec3(run.particles.fluid_action(i).force) = Vec3(0, 0, run.particles.id(i) == 0 ? 3e-4 : -3e-4);
      rebuilds += run.particles.advance(n * 1e-4, 1e-4).rebuilds;
    }
    auto state = gather(run.particles);
    for (auto& [id, s] : state) s.x[0] -= drift * 2e-3, s.v[0] -= drift;
    CHECK((drift == 0 || rebuilds > 20));
    return state;
  };
  CHECK(largest_difference(run_at(0), run_at(25)) < 1e-7);
}

TEST_CASE("Without a fluid, particles that come into another rank's cells wait there until the lists are made anew",
          "[particles][mpi]") {
  // Pairs in contact, all adrift along the box: on any rank count the lists last as long, unless somebody (a fluid, an
  // outlet) wants to know the cells.
  enum class Asks { nobody, fluid, outlet };
  const auto run_for = [](Asks asks, int& rebuilds) {
    BoxCase setup;
    setup.box(Vec3::Zero(), Vec3(60e-3, 6e-3, 6e-3));
    setup.mesh.cells = {30, 2, 2};
    setup.set("material_bead_young_modulus", "1e5").set("particles_speed", "1").set("particles_step", "1e-5");
    setup.set("particles_skin", "1e-3");
    if (asks == Asks::outlet) setup.set("boundary_x_max_particles", "outlet");
    BoxRun run(setup);
    std::vector<Seed> seeds;
    for (int k = 0; k < 40; ++k)
      for (int side = 0; side < 2; ++side)
        seeds.push_back(sphere(Vec3((1.3 + 1.1 * k) * 1e-3, 3e-3, (2.5 + 0.995 * side) * 1e-3), {2, 0, 0}, 0.5e-3));
    run.particles.add(seeds);
    if (asks == Asks::fluid && run.particles.owned() > 0) run.particles.fluid_action(0);
    rebuilds = 0;
    for (int n = 0; n < 40; ++n) rebuilds += run.particles.advance(n * 5e-5, 5e-5).rebuilds;
    return gather(run.particles);
  };
  int seldom = 0, often = 0, outlet = 0;
  const auto state = run_for(Asks::nobody, seldom);
  CHECK(state.size() == 80);
  CHECK(seldom <= 4e-3 / (0.4 * 1e-3) + 1);  // 4 mm, half a skin each time
  CHECK(largest_difference(state, run_for(Asks::fluid, often)) < 1e-12);
  CHECK(largest_difference(state, run_for(Asks::outlet, outlet)) < 1e-12);
  if (mpi_size() > 1) CHECK(std::min(often, outlet) >= seldom + 2);
}

TEST_CASE("A particle that passes several ranks in one step arrives, and one through a wall is reported",
          "[particles][mpi]") {
  BoxCase setup;
  setup.box(Vec3(0, 0, 0), Vec3(60e-3, 6e-3, 6e-3));
  setup.mesh.cells = {30, 2, 2};
  setup.set("particles_step", "1e-4").set("particles_step_override", "yes").set("particles_skin", "2e-3");
  SECTION("within the domain") {
    BoxRun run(setup);
    run.particles.add({sphere(Vec3(2e-3, 3e-3, 3e-3), Vec3(4.9, 0, 0), 0.5e-3)});
    run.particles.advance(0, 1e-2);
    const auto state = gather(run.particles);
    REQUIRE(state.size() == 1);
    CHECK(state.at(0).x[0] == Approx(51e-3).epsilon(1e-12));
  }
  SECTION("faster than its own size in a step") {
    BoxRun run(setup);
    run.particles.add({sphere(Vec3(2e-3, 3e-3, 3e-3), Vec3(50, 0, 0), 0.5e-3)});
    CHECK_THROWS_WITH(run.particles.advance(0, 1e-3),
                      Catch::Contains("particle 0") && Catch::Contains("radius in a step"));
  }
  SECTION("through a wall") {
    setup.set("particles_overlap_limit", "1").set("material_bead_young_modulus", "1e2");
    const Seed fast = sphere(Vec3(2e-3, 3e-3, 3e-3), Vec3(-4, 0, 0), 0.5e-3);
    BoxRun run(setup);
    run.particles.add({fast});
    CHECK_THROWS_WITH(run.particles.advance(0, 1e-2), Catch::Contains("lost particle 0 at (") &&
                                                          Catch::Contains("passed the wall x_min") &&
                                                          Catch::Contains("velocity (-3.9"));
    setup.set("particles_lost", "warn");
    BoxRun lenient(setup);
    lenient.particles.add({fast, sphere(Vec3(30e-3, 3e-3, 3e-3), Vec3::Zero(), 0.5e-3)});
    const ParticleStep step = lenient.particles.advance(0, 1e-2);
    CHECK(step.removed == 1);
    CHECK(lenient.particles.total() == 1);
    CHECK(mpi_sum(static_cast<long long>(lenient.particles.departed().size())) == 1);
    for (const auto& gone : lenient.particles.departed()) CHECK(lenient.mesh.boundaries[gone.boundary] == "x_min");
  }
}

TEST_CASE("Mistakes of the user get one clear line", "[particles]") {
  BoxCase setup;
  SECTION("no density") {
    Options options;
    options.set("material_sand_friction", "0.3");
    const Mesh mesh(setup.mesh);
    CHECK_THROWS_WITH(Particles(mesh, options, Vec3::Zero()), Catch::Contains("sand has no density"));
  }
  SECTION("a step that is too long") {
    setup.set("particles_step", "1");
    BoxRun run(setup);
    CHECK_THROWS_WITH(run.particles.add({sphere(Vec3::Constant(0.5), Vec3::UnitX(), 0.01)}),
                      Catch::Contains("-particles_step 1 s is longer"));
  }
  SECTION("particles that overlap at the start") {
    BoxRun run(setup);
    run.particles.add(
        {sphere(Vec3::Constant(0.5), Vec3::UnitX(), 0.01), sphere(Vec3(0.51, 0.5, 0.5), Vec3::Zero(), 0.01)});
    CHECK_THROWS_AS(run.particles.advance(0, 1e-3), UserError);
  }
  SECTION("a particle outside the mesh") {
    BoxRun run(setup);
    CHECK_THROWS_WITH(run.particles.add({sphere(Vec3::Constant(2), Vec3::Zero(), 0.01)}),
                      Catch::Contains("outside the mesh"));
  }
  SECTION("an unknown pair of materials") {
    setup.set("pair_bead_wal_friction", "0.1");
    CHECK_THROWS_WITH(BoxRun(setup), Catch::Contains("not a pair"));
  }
  SECTION("a linear law without a stiffness") {
    setup.set("normal_type", "linear");
    CHECK_THROWS_WITH(BoxRun(setup), Catch::Contains("normal_stiffness"));
  }
}
