#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "base/error.hpp"
#include "grid_file.hpp"
#include "particles/insertion/insertion.hpp"
#include "particles/insertion/packing.hpp"
#include "particles/insertion/room.hpp"

using namespace silt;
using namespace silt::test;

namespace {

std::vector<Seed> seeds_of(const Mesh& mesh, Options options, const std::vector<std::string>& materials = {"bead"}) {
  const Walls walls(mesh, options, materials);
  return make_insertions(walls, options, materials);
}

Options with(const std::vector<std::pair<std::string, std::string>>& values) {
  Options options;
  for (const auto& [name, value] : values) options.set(name, value);
  return options;
}

/// Smallest gap between any two spheres, periods considered; m.
double smallest_gap(const std::vector<Seed>& seeds, const Vec3& period = Vec3::Zero()) {
  double least = 1e300;
  Packing packing(period);
  for (const auto& seed : seeds) {
    const auto worst = packing.deepest(seed.position, seed.radius);
    if (worst.index >= 0) least = std::min(least, -worst.share * seed.radius);
    packing.add(seed.position, seed.radius);
  }
  return least;
}

double smallest_gap_by_pairs(const std::vector<Seed>& seeds) {
  double least = 1e300;
  for (size_t i = 0; i < seeds.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      least = std::min(least, (seeds[i].position - seeds[j].position).norm() - seeds[i].radius - seeds[j].radius);
  return least;
}

bool within(const std::vector<Seed>& seeds, const Vec3& lower, const Vec3& upper) {
  for (const auto& seed : seeds)
    for (int d = 0; d < 3; ++d)
      if (seed.position[d] - seed.radius < lower[d] - 1e-9 || seed.position[d] + seed.radius > upper[d] + 1e-9)
        return false;
  return true;
}

}  // namespace

TEST_CASE("A fill at a count places that many spheres without overlap inside its region", "[insertion]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box_mesh(cell, {0, 0, 0}, {1, 1, 2}, {4, 4, 8});
    const auto seeds = seeds_of(mesh, with({{"insertion_bed_diameter", "0.1"},
                                            {"insertion_bed_count", "500"},
                                            {"insertion_bed_lower", "0, 0, 0.5"},
                                            {"insertion_bed_velocity", "0, 0, -1"}}));
    REQUIRE(seeds.size() == 500);
    CHECK(smallest_gap_by_pairs(seeds) >= -1e-9);
    CHECK(within(seeds, {0, 0, 0.5}, {1, 1, 2}));
    CHECK(seeds[7].velocity == Vec3(0, 0, -1));
    CHECK(seeds[7].radius == 0.05);
  }
}

TEST_CASE("A fill reaches the solids fraction asked for, dilute or dense", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {4, 4, 4});
  for (double wanted : {0.02, 0.15, 0.3, 0.4, 0.48, 0.55}) {
    const auto seeds = seeds_of(
        mesh, with({{"insertion_bed_diameter", "0.06"}, {"insertion_bed_solids_fraction", fmt::format("{}", wanted)}}));
    const double one = M_PI / 6 * std::pow(0.06, 3);
    INFO(wanted);
    CHECK(std::abs(seeds.size() * one - wanted) <= 0.501 * one);
    CHECK(smallest_gap(seeds) >= -1e-9);
    CHECK(within(seeds, {0, 0, 0}, {1, 1, 1}));
  }
}

TEST_CASE("The bed of 9240 spheres is filled at once at any height from 40 mm on", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {0.044, 0.01, 0.12}, {18, 4, 48});
  for (const char* height : {"0.040", "0.060", "0.080", "0.120"}) {
    const auto seeds = seeds_of(mesh, with({{"insertion_bed_diameter", "1.2e-3"},
                                            {"insertion_bed_count", "9240"},
                                            {"insertion_bed_lower", "0, 0, 0"},
                                            {"insertion_bed_upper", fmt::format("0.044, 0.01, {}", height)}}));
    REQUIRE(seeds.size() == 9240);
    CHECK(smallest_gap(seeds) >= -1e-9);
    CHECK(within(seeds, {0, 0, 0}, {0.044, 0.01, std::stod(height)}));
  }
}

TEST_CASE("A demand that cannot fit says how many do", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  CHECK_THROWS_WITH(seeds_of(mesh, with({{"insertion_bed_diameter", "0.25"}, {"insertion_bed_count", "200"}})),
                    Catch::Contains("-insertion_bed: 200 particles") && Catch::Contains("about 64 do"));
  CHECK_THROWS_WITH(seeds_of(mesh, with({{"insertion_bed_diameter", "0.25"}})), Catch::Contains("_count or"));
  CHECK_THROWS_WITH(seeds_of(mesh, with({{"insertion_bed_count", "2"}})), Catch::Contains("_diameter is missing"));
  CHECK_THROWS_WITH(seeds_of(mesh, with({{"insertion_bed_count", "2"},
                                         {"insertion_bed_diameter", "0.25"},
                                         {"insertion_bed_lower", "2, 0, 0"},
                                         {"insertion_bed_upper", "3, 1, 1"}})),
                    Catch::Contains("outside the mesh"));
  CHECK_THROWS_WITH(
      seeds_of(
          mesh,
          with({{"insertion_bed_count", "2"}, {"insertion_bed_diameter", "0.25"}, {"insertion_bed_material", "bed"}})),
      Catch::Contains("did you mean bead"));
}

TEST_CASE("Another seed gives another filling, the same seed the same", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  const auto fill = [&](const char* seed) {
    return seeds_of(mesh,
                    with({{"insertion_a_diameter", "0.1"}, {"insertion_a_count", "50"}, {"insertion_a_seed", seed}}));
  };
  const auto a = fill("1"), b = fill("1"), c = fill("2");
  CHECK(a[10].position == b[10].position);
  CHECK(a[10].position != c[10].position);
}

TEST_CASE("Two insertions do not overlap each other", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  const auto seeds = seeds_of(mesh,
                              with({{"insertion_big_diameter", "0.3"},
                                    {"insertion_big_count", "8"},
                                    {"insertion_small_diameter", "0.05"},
                                    {"insertion_small_solids_fraction", "0.1"},
                                    {"insertion_small_material", "bead"},
                                    {"insertion_big_material", "steel"}}),
                              {"steel", "bead"});
  CHECK(seeds[0].material == 0);
  CHECK(seeds.back().material == 1);
  CHECK(smallest_gap_by_pairs(seeds) >= -1e-9);
}

TEST_CASE("Diameters follow their distribution", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  for (const char* kind : {"uniform", "normal", "lognormal"}) {
    const auto seeds = seeds_of(mesh, with({{"insertion_a_diameter", "0.02"},
                                            {"insertion_a_diameter_distribution", kind},
                                            {"insertion_a_diameter_deviation", "0.004"},
                                            {"insertion_a_count", "4000"}}));
    double mean = 0, square = 0;
    for (const auto& seed : seeds) mean += 2 * seed.radius / 4000;
    for (const auto& seed : seeds) square += std::pow(2 * seed.radius - mean, 2) / 4000;
    INFO(kind);
    const double deviation = std::string(kind) == "uniform" ? 0.004 / std::sqrt(3.0) : 0.004;
    CHECK(mean == Approx(0.02).margin(4 * deviation / std::sqrt(4000.0)));
    CHECK(std::sqrt(square) == Approx(deviation).epsilon(0.05));
    CHECK(smallest_gap(seeds) >= -1e-9);
  }
}

TEST_CASE("A periodic box is filled across its sides without overlaps", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {1, 1, 1});
  for (const char* fraction : {"0.2", "0.5", "0.6"}) {
    const auto seeds =
        seeds_of(mesh, with({{"insertion_a_diameter", "0.1"}, {"insertion_a_solids_fraction", fraction}}));
    CHECK(static_cast<long>(seeds.size()) == std::lround(std::stod(fraction) / (M_PI / 6 * 1e-3)));
    CHECK(smallest_gap(seeds, Vec3(1, 1, 1)) >= -1e-9);
    double nearest_side = 1;
    for (const auto& seed : seeds) nearest_side = std::min(nearest_side, seed.position.minCoeff());
    CHECK(nearest_side < 0.03);
  }
}

TEST_CASE("A fill stays inside a mesh of any shape and off its walls", "[insertion]") {
  Grid grid;  // a room with a block in the middle
  grid.cells = {6, 6, 6};
  grid.keep = [](int i, int j, int k) { return !(i >= 2 && i < 4 && j >= 2 && j < 4 && k < 4); };
  const Mesh mesh = grid_mesh(grid);
  for (const char* count : {"300", "500"}) {
    const auto seeds = seeds_of(mesh, with({{"insertion_a_diameter", "0.6"}, {"insertion_a_count", count}}));
    REQUIRE(seeds.size() == std::stoul(count));
    CHECK(smallest_gap_by_pairs(seeds) >= -1e-9);
    CHECK(within(seeds, {0, 0, 0}, {6, 6, 6}));
    for (const auto& seed : seeds) {
      const Vec3 nearest = seed.position.cwiseMax(Vec3(2, 2, 0)).cwiseMin(Vec3(4, 4, 4));
      REQUIRE((seed.position - nearest).norm() >= 0.3 - 1e-6);
    }
  }
}

TEST_CASE("A cylinder is filled within its radius", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {-1, -1, 0}, {1, 1, 2}, {4, 4, 4});
  for (const char* fraction : {"0.2", "0.42"}) {
    const auto seeds = seeds_of(mesh, with({{"insertion_a_diameter", "0.12"},
                                            {"insertion_a_cylinder", "z"},
                                            {"insertion_a_solids_fraction", fraction}}));
    CHECK(static_cast<long>(seeds.size()) ==
          std::lround(std::stod(fraction) * 2 * M_PI / (M_PI / 6 * std::pow(0.12, 3))));
    for (const auto& seed : seeds) REQUIRE(std::hypot(seed.position[0], seed.position[1]) <= 1 - 0.06 + 1e-6);
    CHECK(smallest_gap(seeds) >= -1e-9);
  }
}

TEST_CASE("A 2D mesh is filled with discs in its plane", "[insertion]") {
  const Mesh mesh = box_mesh("triangle", {0, 0, 0}, {1, 1, 0}, {3, 3});
  for (const char* fraction : {"0.3", "0.7", "0.8"}) {
    const auto seeds =
        seeds_of(mesh, with({{"insertion_a_diameter", "0.05"}, {"insertion_a_solids_fraction", fraction}}));
    CHECK(static_cast<long>(seeds.size()) == std::lround(std::stod(fraction) / (M_PI / 4 * 0.0025)));
    CHECK(smallest_gap(seeds) >= -1e-9);
    for (const auto& seed : seeds) REQUIRE(seed.position[2] == 0);
  }
}

TEST_CASE("A lattice has its sites at the spacing asked for", "[insertion]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  const auto seeds = seeds_of(
      mesh, with({{"insertion_a_type", "lattice"}, {"insertion_a_diameter", "0.1"}, {"insertion_a_spacing", "0.2"}}));
  REQUIRE(seeds.size() == 125);
  CHECK((seeds[0].position - Vec3(0.05, 0.05, 0.05)).norm() < 1e-14);
  CHECK((seeds[1].position - Vec3(0.25, 0.05, 0.05)).norm() < 1e-14);
  const auto shaken = seeds_of(mesh, with({{"insertion_a_type", "lattice"},
                                           {"insertion_a_diameter", "0.1"},
                                           {"insertion_a_spacing", "0.2"},
                                           {"insertion_a_jitter", "1"}}));
  CHECK(smallest_gap_by_pairs(shaken) >= 0);
  CHECK(within(shaken, {0, 0, 0}, {1, 1, 1}));
  CHECK_THROWS_WITH(
      seeds_of(
          mesh,
          with({{"insertion_a_type", "lattice"}, {"insertion_a_diameter", "0.1"}, {"insertion_a_spacing", "0.09"}})),
      Catch::Contains("less than the diameter"));
}

TEST_CASE("A point is inside exactly where the mesh is, on every side of edges and corners", "[insertion]") {
  Grid grid;
  grid.cells = {6, 6, 6};
  grid.keep = [](int i, int j, int k) {
    return !(i >= 2 && i < 4 && j >= 2 && j < 4 && k >= 1 && k < 4) && (i < 5 || k < 5);
  };
  const Mesh mesh = grid_mesh(grid);
  const Surface surface(mesh);
  const Room room(surface, std::vector<bool>(mesh.boundaries.size(), true));
  for (double x = -0.37; x < 6.5; x += 0.31)
    for (double y = -0.36; y < 6.5; y += 0.33)
      for (double z = -0.33; z < 6.5; z += 0.29) {
        const bool box = std::min({x, y, z}) > 0 && std::max({x, y, z}) < 6;
        const bool block = x > 2 && x < 4 && y > 2 && y < 4 && z > 1 && z<4, notch = x> 5 && z > 5;
        INFO(x << " " << y << " " << z);
        REQUIRE(room.inside({x, y, z}) == (box && !block && !notch));
      }
}

TEST_CASE("A filling depends neither on the ranks nor on the mesh of the same room", "[insertion][mpi]") {
  const Mesh many = box_mesh("tetrahedron", {0, 0, 0}, {1, 1, 1}, {3, 3, 3});
  const Mesh single = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {1, 1, 1});  // all of it on one rank
  for (const char* fraction : {"0.2", "0.45"}) {
    const auto options = with({{"insertion_a_diameter", "0.1"}, {"insertion_a_solids_fraction", fraction}});
    const auto a = seeds_of(many, options), b = seeds_of(single, options);
    REQUIRE(a.size() == b.size());
    double sum = 0;
    bool same = true;
    for (size_t k = 0; k < a.size(); ++k) {
      same = same && a[k].position == b[k].position;
      sum += a[k].position.dot(Vec3(1, 3, 7));
    }
    CHECK(same);
    CHECK(mpi_min(sum) == mpi_max(sum));
  }
}
