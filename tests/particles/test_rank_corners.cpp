#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "gas_box.hpp"

using namespace silt;

namespace {

constexpr double large = 1.5e-3, small = 0.5e-3;

/// Directions to the faces and corners of a cube.
std::vector<Vec3> directions() {
  std::vector<Vec3> all;
  for (int d = 0; d < 3; ++d)
    for (const double sign : {-1.0, 1.0}) all.push_back(sign * Vec3::Unit(d));
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) all.push_back(Vec3(x, y, z).normalized());
  return all;
}

/// A large sphere that turns, and fourteen small ones all around that come and touch it within a few steps.
std::vector<Seed> cluster(const Vec3& centre, const Vec3& drift) {
  std::vector<Seed> seeds = {sphere(centre, drift, large, Vec3(40, -60, 80))};
  double more = 0;
  for (const Vec3& n : directions())
    seeds.push_back(sphere(centre + (large + small + 1e-6) * n, drift - (0.1 + 0.01 * more++) * n, small));
  return seeds;
}

/// One cell, hence all particles on one rank, or many in a periodic box.
BoxCase box_case(int cells) {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(9e-3));
  setup.mesh.cells = {cells, cells, cells};
  if (cells > 1) setup.periodic();
  setup.set("material_bead_young_modulus", "1e6").set("material_bead_restitution", "0.7");
  setup.set("material_bead_friction", "0.5").set("particles_speed", "1");
  return setup;
}

/// Places and motion after the impacts, relative to the drift; `owners`: ranks of the small spheres when they touch.
std::map<std::int64_t, State> after(int cells, const Vec3& centre, const Vec3& drift, int& owners) {
  BoxRun run(box_case(cells));
  std::vector<Seed> seeds = cluster(centre, drift);
  for (auto& seed : seeds)
    for (int d = 0; d < 3; ++d) seed.position[d] -= 9e-3 * std::floor(seed.position[d] / 9e-3);
  run.particles.add(seeds);
  int mine = 0;
  for (int i = 0; i < run.particles.owned(); ++i) mine += run.particles.id(i) > 0;
  owners = static_cast<int>(mpi_sum(mine > 0 ? 1.0 : 0.0));
  double most = 0;
  for (int n = 0; n < 20; ++n)
    most = std::max(most, static_cast<double>(run.particles.advance(n * 5e-5, 5e-5).contacts));
  CHECK(most == 14);
  auto state = gather(run.particles);
  const double time = 20 * 5e-5;
  for (auto& [id, s] : state)
    for (int d = 0; d < 3; ++d) {
      double x = s.x[d] - centre[d] - drift[d] * time;
      s.x[d] = x - 9e-3 * std::round(x / 9e-3);
      s.v[d] -= drift[d];
    }
  return state;
}

double apart(const std::map<std::int64_t, State>& a, const std::map<std::int64_t, State>& b) {
  double most = 0;
  REQUIRE(a.size() == b.size());
  for (const auto& [id, s] : a)
    for (int d = 0; d < 3; ++d) {
      most = std::max(most, std::abs(s.x[d] - b.at(id).x[d]) / 9e-3);
      most = std::max(most, std::abs(s.v[d] - b.at(id).v[d]) / 0.1);
      most = std::max(most, std::abs(s.w[d] - b.at(id).w[d]) / 100);
    }
  return most;
}

}  // namespace

TEST_CASE("A sphere that touches others on every rank at once, also over the corner of a periodic box, moves as on one",
          "[particles][mpi]") {
  int owners = 0;
  const auto alone = after(1, Vec3::Constant(4.5e-3), Vec3::Zero(), owners);
  CHECK(owners == 1);
  CHECK(std::abs(alone.at(0).w[0] - 40) > 0.1);  // friction acted
  int most = 0;
  for (const Vec3& centre : {Vec3(4.5e-3, 4.5e-3, 4.5e-3), Vec3(0, 0, 0), Vec3(3e-3, 6e-3, 0)})
    for (const Vec3& drift : {Vec3(0, 0, 0), Vec3(3, -2, 4)}) {
      const auto shared = after(6, centre, drift, owners);
      most = std::max(most, owners);
      CHECK(apart(shared, alone) < 1e-9);
    }
  CHECK(most == mpi_size());
}
