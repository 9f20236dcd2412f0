#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gas_box.hpp"

using namespace silt;

namespace {

constexpr double radius = 0.5e-3, skin = 0.2e-3, overlap = 0.02e-3, step = 1e-5, stiffness = 50;
constexpr int pairs = 19;  // one across each face between cells of 3 mm along the box

BoxCase row_of_cells() {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3(60e-3, 6e-3, 6e-3));
  setup.mesh.cells = {20, 2, 2};
  setup.set("normal_type", "linear").set("normal_stiffness", "50").set("material_bead_restitution", "1");
  setup.set("tangential_type", "viscous")
      .set("tangential_damping", "0")
      .set("particles_speed", "1")
      .set("particles_step", "1e-5");
  setup.set("particles_skin", "0.2e-3");
  return setup;
}

/// Pairs too far apart for the lists, symmetric about the faces between cells.
std::vector<Seed> resting_pairs() {
  std::vector<Seed> seeds;
  for (int k = 1; k <= pairs; ++k)
    for (const double side : {-1.0, 1.0})
      seeds.push_back(sphere(Vec3(3e-3 * k + side * (radius + 0.75 * skin), 1.5e-3, 1.5e-3), Vec3::Zero(), radius));
  return seeds;
}

/// Ranks that own one sphere of a pair whose other belongs to another rank.
int shared_pairs(const Particles& particles) {
  std::vector<int> mine(pairs);
  for (int i = 0; i < particles.owned(); ++i) ++mine[particles.id(i) / 2];
  return static_cast<int>(mpi_sum(static_cast<long long>(std::count(mine.begin(), mine.end(), 1)))) / 2;
}

}  // namespace

TEST_CASE("Spheres kicked from rest past the reach of their lists in one substep are met in the next, by both ranks",
          "[particles][mpi]") {
  BoxRun run(row_of_cells());
  run.particles.add(resting_pairs());
  CHECK((mpi_size() == 1 || shared_pairs(run.particles) > 0));
  const double mass = 2500 * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3);
  const double way = 0.75 * skin + 0.5 * overlap, kicked = 2 * way / step;  // of each sphere in the kick
  double time = 0;
  const auto advance = [&](double gain) {  // m/s towards the other sphere
    for (int i = 0; i < run.particles.owned(); ++i)
      vec3(run.particles.fluid_action(i).force) = Vec3(run.particles.id(i) % 2 ? -gain : gain, 0, 0) * mass / step;
    const int rebuilds = run.particles.advance(time, step).rebuilds;
    time += step;
    return rebuilds;
  };
  for (int n = 0; n < 3; ++n) advance(0);
  CHECK(advance(0) == 0);
  CHECK(advance(kicked) == (mpi_size() == 1));
  CHECK(advance(-2 * kicked) == (mpi_size() > 1));  // ends where the kick did

  // One rank alone has met the pairs in the kick: half a substep of their force then, and one since.
  const double gained = (mpi_size() == 1 ? 1.5 : 0.5) * step * stiffness * overlap / mass;
  for (const auto& [id, s] : gather(run.particles)) {
    const double sign = id % 2 ? -1 : 1;
    CHECK(s.x[0] == Approx(3e-3 * (id / 2 + 1) - sign * (radius - 0.5 * overlap)).epsilon(1e-4));
    CHECK(-sign * s.v[0] - kicked == Approx(gained).epsilon(5e-3));
  }
  Vec3 momentum = Vec3::Zero();
  for (const auto& [id, s] : gather(run.particles)) momentum += Vec3(s.v[0], s.v[1], s.v[2]);
  CHECK(momentum.norm() < 1e-12 * pairs * gained);
}
