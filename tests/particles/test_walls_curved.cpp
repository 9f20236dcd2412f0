#include <catch2/catch.hpp>
#include <cmath>

#include "grid_file.hpp"
#include "wall_probe.hpp"

using namespace silt;
using namespace silt::test;

namespace {

/// The gap between cylinders of radii 1 and 2, n cells around (a full turn meets itself), height 2.
Mesh annulus(int n) {
  Grid grid;
  grid.cells = {1, n, 1};
  grid.map = [=](const Vec3& x) {
    const double angle = 1.5 * M_PI * x[1] / n, radius = 1 + x[0];
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), 2 * x[2]);
  };
  return grid_mesh(grid);
}

}  // namespace

TEST_CASE("A sphere inside a faceted cylinder touches it once, the more finely faceted the more exactly", "[walls]") {
  for (int n : {36, 180, 1800}) {
    const Mesh mesh = annulus(n);
    Walls walls = walls_of(mesh);
    const double sagitta = 2 * (1 - std::cos(0.75 * M_PI / n));
    for (int k = 0; k < 200; ++k) {
      const double angle = 0.4 + 0.019 * k, r = 1.52;
      const auto found = touches(walls, {r * std::cos(angle), r * std::sin(angle), 1.1}, 0.5);
      INFO(n << " " << k);
      REQUIRE(found.size() == 1);
      CHECK(found[0].distance <= 2 - r + 1e-12);
      CHECK(found[0].distance >= 2 - r - 1.01 * sagitta);
      const Vec3 inward(-std::cos(angle), -std::sin(angle), 0);
      CHECK(std::acos(std::min(1.0, inward.dot(vec3(found[0].normal)))) < 8 * M_PI / n);
    }
  }
}

TEST_CASE("The distance to a faceted cylinder is continuous along a roll, from inside and outside", "[walls]") {
  const Mesh mesh = annulus(36);
  Walls walls = walls_of(mesh);
  for (double r : {1.49, 1.53}) {
    double before = -1;
    for (int k = 0; k < 20000; ++k) {
      const double angle = 0.5 + 3.5 * k / 20000;
      const auto found = touches(walls, {r * std::cos(angle), r * std::sin(angle), 1}, r < 1.5 ? 0.495 : 0.49);
      REQUIRE(found.size() == 1);
      if (before > 0) REQUIRE(std::abs(found[0].distance - before) < 1e-4);
      before = found[0].distance;
    }
  }
}

TEST_CASE("A sphere pinched between two cylinders touches both", "[walls]") {
  const Mesh mesh = annulus(90);
  Walls walls = walls_of(mesh);
  const auto found = touches(walls, {1.5 * std::cos(1.0), 1.5 * std::sin(1.0), 1}, 0.51);
  REQUIRE(found.size() == 2);
  CHECK(vec3(found[0].normal).dot(vec3(found[1].normal)) < -0.99);
}

TEST_CASE("Slightly warped quadrilaterals are split and still touched once", "[walls]") {
  Grid grid;
  grid.cells = {20, 20, 1};
  grid.map = [](const Vec3& x) {
    const double rise = x[2] > 0 ? 1 : 0.002 * std::sin(1.3 * x[0] + 0.7) * std::cos(0.9 * x[1]);
    return Vec3(x[0] / 10, x[1] / 10, rise);
  };
  const Mesh mesh = grid_mesh(grid);
  Walls walls = walls_of(mesh);
  double before = -1;
  for (int k = 0; k < 4000; ++k) {
    const double s = 0.35 + 1.3 * k / 4000;
    const auto found = touches(walls, {s, 0.4 + 0.5 * s, 0.295}, 0.3);
    REQUIRE(found.size() == 1);
    if (before > 0) REQUIRE(std::abs(found[0].distance - before) < 2e-4);
    before = found[0].distance;
    REQUIRE(found[0].normal[2] > 0.99);
  }
}
