#include <catch2/catch.hpp>
#include <cmath>

#include "grid_file.hpp"
#include "wall_probe.hpp"

using namespace silt;
using namespace silt::test;

namespace {

/// A room of 4 x 4 x 4 with a block of 2 x 4 x 2 in the corner x > 2, z < 2: a step with one convex edge.
Mesh step(int refine) {
  Grid grid;
  grid.cells = {4 * refine, 4 * refine, 4 * refine};
  grid.keep = [=](int i, int, int k) { return i < 2 * refine || k >= 2 * refine; };
  grid.map = [=](const Vec3& x) -> Vec3 { return x / refine; };
  return grid_mesh(grid);
}

/// A block of 1 x 1 x 1 standing on the floor in the middle of a room of 3 x 3 x 3.
Mesh block() {
  Grid grid;
  grid.cells = {6, 6, 6};
  grid.keep = [](int i, int j, int k) { return !(i >= 2 && i < 4 && j >= 2 && j < 4 && k < 2); };
  grid.map = [](const Vec3& x) -> Vec3 { return 0.5 * x; };
  return grid_mesh(grid);
}

}  // namespace

TEST_CASE("A box meshed by hexahedra or tetrahedra is six faces without edges", "[walls]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box_mesh(cell, {0, 0, 0}, {1, 2, 3}, {5, 6, 7});
    const Walls walls = walls_of(mesh);
    CHECK(walls.shape().faces.size() == 6);
    CHECK(walls.shape().edges.empty());
    for (const auto& face : walls.shape().faces) CHECK(face.sides == 4);
  }
}

TEST_CASE("A sphere in the floor, an edge and a corner of a box touches one, two and three walls", "[walls]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box_mesh(cell, {0, 0, 0}, {1, 1, 1}, {3, 4, 5});
    Walls walls = walls_of(mesh);
    CHECK(touches(walls, {0.5, 0.5, 0.5}, 0.1).empty());
    const auto floor = touches(walls, {0.4, 0.5, 0.09}, 0.1);
    REQUIRE(floor.size() == 1);
    CHECK(floor[0].distance == Approx(0.09).epsilon(1e-12));
    CHECK((vec3(floor[0].normal) - Vec3::UnitZ()).norm() < 1e-14);
    CHECK(mesh.boundaries[floor[0].boundary] == "z_min");
    CHECK(touches(walls, {0.08, 0.5, 0.09}, 0.1).size() == 2);
    const auto corner = touches(walls, {0.92, 0.93, 0.94}, 0.1);
    REQUIRE(corner.size() == 3);
    Vec3 push = Vec3::Zero();
    for (const auto& point : corner) push += (0.1 - point.distance) * vec3(point.normal);
    CHECK((push - Vec3(-0.02, -0.03, -0.04)).norm() < 1e-14);
  }
}

TEST_CASE("A sphere touches face, convex edge or convex vertex of a block once and at the nearest point", "[walls]") {
  const Mesh mesh = block();
  Walls walls = walls_of(mesh);
  // The block's upper face, four upper edges, four vertical ones, four upper vertices: from every side.
  const double radius = 0.3;
  for (double x : {0.8, 1.0, 1.1, 1.5, 1.9, 2.0, 2.2})
    for (double y : {0.75, 1.0, 1.2, 1.5, 1.8, 2.0, 2.2})
      for (double z : {0.6, 0.9, 1.0, 1.05, 1.2}) {
        const Vec3 centre(x, y, z), nearest = centre.cwiseMax(Vec3(1, 1, 0)).cwiseMin(Vec3(2, 2, 1));
        const double distance = (centre - nearest).norm();
        if (distance == 0) continue;
        INFO(x << " " << y << " " << z);
        const auto found = touches(walls, centre, radius);
        if (distance >= radius) {
          CHECK(found.empty());
          continue;
        }
        REQUIRE(found.size() == 1);
        CHECK(found[0].distance == Approx(distance).epsilon(1e-9));
        CHECK((vec3(found[0].normal) - (centre - nearest) / distance).norm() < 1e-9);
      }
}

TEST_CASE("At the foot of a block a sphere touches floor and block", "[walls]") {
  const Mesh mesh = block();
  Walls walls = walls_of(mesh);
  CHECK(touches(walls, {0.75, 1.5, 0.26}, 0.3).size() == 2);  // floor and side
  CHECK(touches(walls, {0.9, 0.8, 0.26}, 0.3).size() == 2);   // floor and vertical edge
  CHECK(touches(walls, {0.29, 0.29, 0.29}, 0.3).size() == 3);
}

TEST_CASE("Refining the mesh of the walls changes no contact", "[walls]") {
  const Mesh coarse = step(1), fine = step(4);
  Walls a = walls_of(coarse), b = walls_of(fine);
  CHECK(a.shape().faces.size() == b.shape().faces.size());
  int compared = 0;
  for (double x = 0.05; x < 4; x += 0.083)
    for (double z = 0.07; z < 4; z += 0.091) {
      if (x >= 2 && z <= 2) continue;
      const auto p = touches(a, {x, 1.9, z}, 0.5), q = touches(b, {x, 1.9, z}, 0.5);
      REQUIRE(p.size() == q.size());
      for (size_t k = 0; k < p.size(); ++k) {
        CHECK(p[k].distance == Approx(q[k].distance).epsilon(1e-10));
        CHECK((vec3(p[k].normal) - vec3(q[k].normal)).norm() < 1e-10);
        ++compared;
      }
    }
  CHECK(compared > 500);
}

TEST_CASE("A sphere much larger than the facets touches a floor at one point", "[walls]") {
  Grid grid;
  grid.cells = {40, 40, 2};
  grid.map = [](const Vec3& x) -> Vec3 { return {x[0] / 20, x[1] / 20, x[2]}; };
  const Mesh mesh = grid_mesh(grid);
  Walls walls = walls_of(mesh);
  const auto found = touches(walls, {1.013, 0.974, 0.599}, 0.6);  // radius = 12 facets
  REQUIRE(found.size() == 1);
  CHECK(found[0].distance == Approx(0.599).epsilon(1e-12));
}

TEST_CASE("A sphere sliding over coplanar facets feels a constant floor", "[walls]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box_mesh(cell, {0, 0, 0}, {1, 1, 1}, {7, 5, 3});
    Walls walls = walls_of(mesh);
    for (int k = 0; k <= 4000; ++k) {
      // Through facet edges and exactly along them, and through vertices.
      const double s = 0.2 + 0.6 * k / 4000;
      for (const Vec3& at : {Vec3(s, 0.31 + 0.4 * s, 0.099), Vec3(s, 0.4, 0.099), Vec3(3.0 / 7, s, 0.099)}) {
        const auto found = touches(walls, at, 0.1);
        REQUIRE(found.size() == 1);
        REQUIRE(found[0].distance == Approx(0.099).epsilon(1e-12));
        REQUIRE(found[0].normal[2] == Approx(1).epsilon(1e-14));
      }
    }
  }
}

TEST_CASE("A floor whose facets do not make one convex patch still is flat", "[walls]") {
  // The floor around a block: an annulus, cut into convex parts whose borders are never felt.
  const Mesh mesh = block();
  Walls walls = walls_of(mesh);
  int on_floor = 0;
  for (const auto& face : walls.shape().faces) on_floor += face.normal[2] > 0.5 && face.offset < 0.5;
  CHECK(on_floor <= 5);
  for (int k = 0; k <= 1000; ++k) {
    const double angle = 2 * M_PI * k / 1000;
    const auto found = touches(walls, Vec3(1.5 + 1.2 * std::cos(angle), 1.5 + 1.2 * std::sin(angle), 0.09), 0.1);
    REQUIRE(found.size() == 1);
    REQUIRE(found[0].normal[2] == 1);
    REQUIRE(found[0].distance == Approx(0.09).epsilon(1e-12));
  }
}

TEST_CASE("Rolling over a convex edge the distance and the normal are continuous", "[walls]") {
  const Mesh mesh = step(3);
  Walls walls = walls_of(mesh);
  const double radius = 0.5, distance = 0.49;
  Vec3 before = Vec3::UnitZ();
  for (int k = 0; k <= 3000; ++k) {
    const double s = -0.6 + 2.0 * k / 3000;  // along the step's top, around its edge at x = 2, z = 2, down its side
    const double arc = 0.5 * M_PI * distance;
    Vec3 centre(2 - s, 1.7, 2 + distance);
    if (s > 0) centre = {2 - distance * std::sin(s / distance), 1.7, 2 + distance * std::cos(s / distance)};
    if (s > arc) centre = {2 - distance, 1.7, 2 - (s - arc)};
    const auto found = touches(walls, centre, radius);
    INFO(s);
    REQUIRE(found.size() == 1);
    REQUIRE(found[0].distance == Approx(distance).epsilon(1e-9));
    REQUIRE((vec3(found[0].normal) - before).norm() < 0.01);
    before = vec3(found[0].normal);
  }
}

TEST_CASE("Walls act over the sides of a periodic domain", "[walls]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {4, 4, 4}, {1, 1, 0});
  Walls walls = walls_of(mesh);
  CHECK(walls.shape().faces.size() == 2);
  for (double x : {0.0, 1e-12, 0.05, 0.999, 1.0, 1.004, -0.003})
    for (double y : {0.0, 0.5, 1.0}) {
      const auto found = touches(walls, {x, y, 0.095}, 0.1);
      REQUIRE(found.size() == 1);
      CHECK(found[0].distance == Approx(0.095).epsilon(1e-12));
    }
}

TEST_CASE("In two dimensions sides are walls and corners of the domain are felt once", "[walls]") {
  for (const char* cell : {"quadrilateral", "triangle"}) {
    const Mesh mesh = box_mesh(cell, {0, 0, 0}, {1, 1, 0}, {4, 3});
    Walls walls = walls_of(mesh);
    CHECK(walls.shape().faces.size() == 4);
    CHECK(touches(walls, {0.5, 0.5, 0}, 0.1).empty());
    const auto side = touches(walls, {0.25, 0.96, 0}, 0.1);
    REQUIRE(side.size() == 1);
    CHECK(side[0].distance == Approx(0.04).epsilon(1e-12));
    CHECK((vec3(side[0].normal) + Vec3::UnitY()).norm() < 1e-14);
    CHECK(touches(walls, {0.05, 0.96, 0}, 0.1).size() == 2);
  }
}

TEST_CASE("A straight convex edge is one edge however finely it is meshed", "[walls]") {
  const Walls walls = walls_of(step(5));
  CHECK(walls.shape().edges.size() == 1);
}

TEST_CASE("A wall without thickness is felt from both sides and around its rim", "[walls]") {
  // A plate z = 2, x < 3 across a room of 6 x 6 x 4.
  Grid grid;
  grid.cells = {6, 6, 5};
  grid.keep = [](int, int, int k) { return k != 2; };
  grid.node = [](int i, int j, int k) { return std::array{i, j, k == 3 && i >= 3 ? 2 : k}; };
  grid.map = [](const Vec3& x) { return Vec3(x[0], x[1], x[2] < 3 ? x[2] : x[2] - 1); };
  const Mesh mesh = grid_mesh(grid);
  Walls walls = walls_of(mesh);
  CHECK(walls.shape().edges.size() == 1);
  for (double x : {1.0, 1.5, 2.0, 2.7, 3.0})
    for (double side : {-1, 1}) {
      const auto found = touches(walls, {x, 2.7, 2 + 0.4 * side}, 0.5);
      REQUIRE(found.size() == 1);
      CHECK(found[0].distance == Approx(0.4));
      CHECK(found[0].normal[2] == Approx(side));
    }
  for (double z : {1.8, 2.0, 2.3}) {
    const auto rim = touches(walls, {3.3, 2.6, z}, 0.5);
    REQUIRE(rim.size() == 1);
    CHECK(rim[0].distance == Approx(std::hypot(0.3, z - 2)));
  }
  CHECK(touches(walls, {3.6, 2.6, 2}, 0.5).empty());
}

TEST_CASE("Blocks that touch along a line leave two rooms with their own walls", "[walls]") {
  // Rooms x, y < 2 and x, y > 2 of a chequered box, joined nowhere but in the line x = y = 2.
  Grid grid;
  grid.cells = {4, 4, 2};
  grid.keep = [](int i, int j, int) { return (i < 2) == (j < 2); };
  const Mesh mesh = grid_mesh(grid);
  Walls walls = walls_of(mesh);
  CHECK(walls.shape().edges.empty());
  CHECK(touches(walls, {1.8, 1.7, 1}, 0.4).size() == 2);
  CHECK(touches(walls, {2.3, 2.2, 1}, 0.4).size() == 2);
}
