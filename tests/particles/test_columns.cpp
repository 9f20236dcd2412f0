#include <catch2/catch.hpp>

#include "gas_box.hpp"
#include "particles/engine.hpp"

using namespace silt;

namespace {

BoxCase gas_case() {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(8e-3)).periodic();
  setup.set("material_bead_young_modulus", "1e6").set("particles_speed", "1");
  return setup;
}

}  // namespace

TEST_CASE("What particles carry follows them through collisions, sorting and migration, and their ghosts have it",
          "[particles][mpi]") {
  BoxCase setup = gas_case();
  Mesh mesh(setup.mesh);
  Engine engine(mesh, setup.options, Vec3::Zero());
  Columns& columns = engine.store.columns;
  const int home = columns.add({"home", 3, GhostValues::at_rebuild, true, [](const Seed& seed, double* row) {
                                  for (int d = 0; d < 3; ++d) row[d] = seed.position[d];
                                }});
  const int age = columns.add({"age", 1, GhostValues::every_step, true, {}});
  const int own = columns.add({"own", 1, GhostValues::none, false, {}});
  CHECK(columns.width() == 5);
  CHECK(columns.add({"age", 1, GhostValues::none, true, {}}) == age);
  auto seeds = gas(7, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.6);
  seeds[5].columns = {{"age", {100}}, {"nobody asked", {1, 2}}};
  engine.add(seeds);
  long long moved = 0, ghosts = 0;
  std::shared_ptr<const Particles::Snapshot> saved;
  for (int n = 0; n < 10; ++n) {
    for (int p = 0; p < engine.store.owned; ++p) {
      *columns.row(age, p) += 1;
      *columns.row(own, p) = static_cast<double>(engine.store.id[p]);
    }
    engine.advance(n * 2e-3, 2e-3);
    if (n == 4) saved = engine.snapshot(true);
    for (int p = 0; p < engine.store.all(); ++p) {
      const auto id = engine.store.id[p];
      for (int d = 0; d < 3; ++d) REQUIRE(columns.row(home, p)[d] == seeds[id].position[d]);
      if (p < engine.store.owned) {
        REQUIRE(*columns.row(age, p) == (id == 5 ? 101 : 1) + n);
        REQUIRE(*columns.row(own, p) == id);
        moved += (vec3(columns.row(home, p)) - vec3(engine.store.motion[p].position)).norm() > 2e-3;
      } else {
        REQUIRE(*columns.row(own, p) == 0);
        REQUIRE(*columns.row(age, p) == (id == 5 ? 101 : 1) + n);
        ++ghosts;
      }
    }
  }
  CHECK(mpi_sum(moved) > 100);
  if (mpi_size() > 1) CHECK(mpi_sum(ghosts) > 100);
  engine.restore(*saved);
  for (int p = 0; p < engine.store.owned; ++p) REQUIRE(*columns.row(age, p) == (engine.store.id[p] == 5 ? 101 : 1) + 4);
}

TEST_CASE("Without a model that asks for them particles carry nothing more", "[particles]") {
  BoxRun run(gas_case());
  run.particles.add(gas(3, Vec3::Zero(), Vec3::Constant(8e-3), 0.5e-3, 0.3));
  CHECK(run.particles.columns().count() == 0);
  CHECK(run.particles.columns().width() == 0);
  const int a = run.particles.columns().add({"a", 2, GhostValues::none, true, {}});
  CHECK_THROWS_AS(run.particles.columns().add({"a", 3, GhostValues::none, true, {}}), std::logic_error);
  CHECK(run.particles.columns().find("b") == -1);
  CHECK(run.particles.columns().find("a") == a);
  run.particles.advance(0, 1e-3);
  CHECK(run.particles.columns().row(a, 26)[1] == 0);
}
