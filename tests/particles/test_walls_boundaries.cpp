#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "grid_file.hpp"
#include "wall_probe.hpp"

using namespace silt;
using namespace silt::test;

TEST_CASE("Boundaries are walls of the first material unless the flow leaves through them", "[walls]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  Options options;
  options.set("boundary_z_max_type", "pressure");
  options.set("boundary_z_min_type", "velocity");
  options.set("boundary_z_min_velocity", "0, 0, 1");
  options.set("boundary_x_min_material", "steel");
  options.set("boundary_x_max_particles", "open");
  options.set("boundary_y_min_type", "no_slip");
  options.set("boundary_y_min_velocity", "2, 0, 0");
  options.set("boundary_y_max_velocity", "x*t, 0, 0");
  Walls walls(mesh, options, {"steel", "glass"});
  const auto index = [&](const std::string& name) {
    return static_cast<int>(std::find(mesh.boundaries.begin(), mesh.boundaries.end(), name) - mesh.boundaries.begin());
  };
  CHECK(walls.role(index("z_max")) == BoundaryRole::outlet);
  CHECK(walls.role(index("x_max")) == BoundaryRole::open);
  CHECK(walls.role(index("z_min")) == BoundaryRole::wall);
  CHECK(touches(walls, {0.5, 0.5, 0.95}, 0.1).empty());
  CHECK(touches(walls, {0.95, 0.5, 0.5}, 0.1).empty());

  const auto floor = touches(walls, {0.5, 0.5, 0.05}, 0.1);
  REQUIRE(floor.size() == 1);
  CHECK(floor[0].material == 1);  // glass
  CHECK(vec3(floor[0].velocity).norm() == 0);
  const auto left = touches(walls, {0.05, 0.5, 0.5}, 0.1);
  REQUIRE(left.size() == 1);
  CHECK(left[0].material == 0);
  const auto belt = touches(walls, {0.5, 0.05, 0.5}, 0.1);
  REQUIRE(belt.size() == 1);
  CHECK(vec3(belt[0].velocity) == Vec3(2, 0, 0));
  const auto shear = touches(walls, {0.25, 0.95, 0.5}, 0.1, 3.0);
  REQUIRE(shear.size() == 1);
  CHECK(shear[0].velocity[0] == Approx(0.75));
}

TEST_CASE("A wall of an unknown material or role is refused by name", "[walls]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {1, 1, 1});
  Options options;
  options.set("boundary_x_min_material", "stel");
  CHECK_THROWS_WITH(Walls(mesh, options, {"steel", "glass"}),
                    Catch::Contains("-boundary_x_min_material") && Catch::Contains("did you mean steel"));
  Options other;
  other.set("boundary_x_min_particles", "wal");
  CHECK_THROWS_AS(Walls(mesh, other, {"steel"}), UserError);
}

TEST_CASE("The rim of an outlet in a flat floor is felt, the floor beside it is one wall", "[walls]") {
  Grid grid;
  grid.cells = {6, 6, 3};
  grid.name = [](const Vec3& x) {
    const bool hole = x[2] == 0 && std::abs(x[0] - 3) < 1 && std::abs(x[1] - 3) < 1;
    return std::string(hole ? "hole" : "shell");
  };
  const Mesh mesh = grid_mesh(grid);
  Options options;
  options.set("boundary_hole_type", "pressure");
  Walls walls = walls_of(mesh, options);
  const double radius = 0.6;
  CHECK(touches(walls, {3, 3, 0.3}, radius).empty());
  const auto rim = touches(walls, {2.3, 3, 0.4}, radius);
  REQUIRE(rim.size() == 1);
  CHECK(rim[0].distance == Approx(0.5));
  CHECK((vec3(rim[0].normal) - Vec3(0.6, 0, 0.8)).norm() < 1e-12);
  const auto corner = touches(walls, {2.1, 2.2, 0.4}, radius);
  REQUIRE(corner.size() == 2);  // the hole's corner is reentrant: its two rims
  const auto floor = touches(walls, {1.5, 2.5, 0.4}, radius);
  REQUIRE(floor.size() == 1);
  CHECK(floor[0].normal[2] == 1);
}

TEST_CASE("Every rank finds the walls near its cells, on any number of ranks", "[walls][mpi]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box_mesh(cell, {0, 0, 0}, {1, 1, 1}, {4, 4, 4});
    Walls walls = walls_of(mesh);
    CHECK(walls.shape().faces.size() == 6);
    // Spheres at the centres of local cells, as large as the domain allows: what they touch is known in closed form.
    long long found = 0, expected = 0;
    for (int c = 0; c < mesh.cells; ++c) {
      Vec3 centre = Vec3::Zero();
      for (int a = 0; a < mesh.nodes_per_cell; ++a)
        centre += vec3(&mesh.cell_coordinates[3 * (static_cast<size_t>(c) * mesh.nodes_per_cell + a)]);
      centre /= mesh.nodes_per_cell;
      const double radius = 0.3;
      for (const auto& point : touches(walls, centre, radius)) {
        ++found;
        int axis = 0;
        vec3(point.normal).cwiseAbs().maxCoeff(&axis);
        CHECK(point.distance == Approx(std::min(centre[axis], 1 - centre[axis])).epsilon(1e-12));
      }
      for (int d = 0; d < 3; ++d) expected += (centre[d] < radius) + (1 - centre[d] < radius);
    }
    CHECK(found == expected);
    CHECK(mpi_sum(found) > 0);
  }
}

TEST_CASE("A rank without cells has walls without facets nearby", "[walls][mpi]") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {1, 1, 1});
  Walls walls = walls_of(mesh);
  std::vector<WallPoint> points;
  walls.list(nullptr, 0, 0.1);
  walls.points(nullptr, 0, points);
  CHECK(points.empty());
  CHECK(walls.shape().faces.size() == 6);
}
