#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "base/error.hpp"
#include "base/mesh.hpp"
#include "base/nodal_matrix.hpp"
#include "support/temporary_directory.hpp"

using namespace silt;

namespace {

MeshOptions box(const std::string& cell, std::vector<int> cells, Vec3 upper, std::vector<int> periodic = {0, 0, 0}) {
  MeshOptions options;
  options.cell = cell;
  options.cells = std::move(cells);
  options.upper = upper;
  options.periodic = std::move(periodic);
  return options;
}

/// int over the boundary of n dA: zero when every facet is found once and points out.
Vec3 closed_surface(const Mesh& mesh, double& area) {
  Vec3 sum = Vec3::Zero();
  area = 0;
  for (const auto& facet : mesh.facets) {
    const auto x = mesh.facet_corners(facet);
    Vec3 normal;
    if (mesh.dimension == 2) {
      const Vec3 t = x[1] - x[0];
      normal = Vec3(t[1], -t[0], 0);
    } else if (facet_nodes(mesh.cell) == 3) {
      normal = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]);
    } else {
      normal = 0.5 * (x[2] - x[0]).cross(x[3] - x[1]);
    }
    sum += normal;
    area += normal.norm();
  }
  for (int d = 0; d < 3; ++d) sum[d] = mpi_sum(sum[d]);
  area = mpi_sum(area);
  return sum;
}

}  // namespace

TEST_CASE("A box has the volume, the surface and the node count of its dimensions on every cell", "[mpi]") {
  struct Case {
    const char* cell;
    std::vector<int> n;
    long long nodes, cells;
  };
  for (const Case& c : {Case{"hexahedron", {4, 3, 5}, 120, 60}, Case{"tetrahedron", {4, 3, 5}, 120, 360},
                        Case{"quadrilateral", {6, 4}, 35, 24}, Case{"triangle", {6, 4}, 35, 48}}) {
    INFO(c.cell);
    const Mesh mesh(box(c.cell, c.n, Vec3(2, 1, 3)));
    const bool flat = mesh.dimension == 2;
    CHECK(mesh.total_nodes == c.nodes);
    CHECK(mesh.total_cells == c.cells);
    CHECK(mesh.volume == Approx(flat ? 2 : 6).epsilon(1e-13));
    double area;
    CHECK(closed_surface(mesh, area).norm() < 1e-12);
    CHECK(area == Approx(flat ? 6 : 22).epsilon(1e-13));
    CHECK(mesh.boundaries.size() == (flat ? 4u : 6u));
    CHECK(mesh.boundaries[0] == "x_min");
    const auto mass = lumped_mass(mesh);
    std::vector<double> one(mesh.nodes, 1.0);
    CHECK(mesh.dot(mass.data(), one.data(), 1) == Approx(mesh.volume).epsilon(1e-13));
  }
}

TEST_CASE("A periodic box has no boundary where it repeats and keeps its volume", "[mpi]") {
  const Mesh mesh(box("hexahedron", {4, 3, 5}, Vec3(2, 1, 3), {1, 1, 0}));
  CHECK(mesh.total_nodes == 4 * 3 * 6);
  CHECK(mesh.volume == Approx(6).epsilon(1e-13));
  CHECK(mesh.boundaries == std::vector<std::string>{"z_min", "z_max"});
  CHECK(mesh.upper[0] == Approx(2));
}

TEST_CASE("The stiffness of a linear field is its boundary flux alone, the energy its gradient squared", "[mpi]") {
  for (const char* cell : {"hexahedron", "tetrahedron", "quadrilateral", "triangle"}) {
    INFO(cell);
    const Mesh mesh(box(cell, {5, 4, 3}, Vec3(1, 2, 1.5)));
    const NodalGraph graph(mesh);
    NodalMatrix K(graph);
    add_stiffness(K);
    std::vector<double> f(mesh.nodes), Kf(mesh.nodes);
    const Vec3 slope(1, -2, mesh.dimension == 3 ? 0.5 : 0);
    for (int i = 0; i < mesh.nodes; ++i) f[i] = slope.dot(vec3(&mesh.node_coordinates[3 * i]));
    K.apply(f.data(), Kf.data(), 1);
    CHECK(mesh.dot(f.data(), Kf.data(), 1) == Approx(slope.squaredNorm() * mesh.volume).epsilon(1e-12));

    MatHandle petsc = K.create_petsc();
    K.fill_petsc(petsc);
    VecHandle x, y;
    MatCreateVecs(petsc, x.out(), y.out());
    double* array;
    VecGetArray(x, &array);
    std::copy_n(f.begin(), mesh.owned_nodes, array);
    VecRestoreArray(x, &array);
    MatMult(petsc, x, y);
    VecGetArray(y, &array);
    double difference = 0;
    for (int i = 0; i < mesh.owned_nodes; ++i) difference = std::max(difference, std::abs(array[i] - Kf[i]));
    VecRestoreArray(y, &array);
    CHECK(mpi_max(difference) < 1e-12);
  }
}

TEST_CASE("Neighbours across facets agree with each other and with the ranks", "[mpi]") {
  const Mesh mesh(box("tetrahedron", {3, 3, 3}, Vec3(1, 1, 1)));
  long long inner = 0, remote = 0, boundary = 0;
  for (int c = 0; c < mesh.cells; ++c)
    for (int f = 0; f < mesh.facets_per_cell; ++f) {
      const int other = mesh.cell_neighbours[c * mesh.facets_per_cell + f];
      if (other == Mesh::remote_cell) {
        ++remote;
        CHECK(mesh.facet_ranks[c * mesh.facets_per_cell + f] != mpi_rank());
        CHECK(mesh.facet_ranks[c * mesh.facets_per_cell + f] >= 0);
      } else if (other < 0) {
        ++boundary;
      } else {
        ++inner;
        bool back = false;
        for (int g = 0; g < mesh.facets_per_cell; ++g)
          back = back || mesh.cell_neighbours[other * mesh.facets_per_cell + g] == c;
        CHECK(back);
      }
    }
  CHECK(mpi_sum(boundary) == 6 * 9 * 2);
  CHECK(mpi_sum(inner) + mpi_sum(remote) + mpi_sum(boundary) == 4 * 162);
}

TEST_CASE("A mesh option that cannot be is refused with its name") {
  CHECK_THROWS_AS(Mesh(box("hexahedron", {2, 3, 3}, Vec3(1, 1, 1), {1, 0, 0})), UserError);
  CHECK_THROWS_AS(Mesh(box("tetrahedron", {3, 3, 3}, Vec3(1, 1, 1), {1, 0, 0})), UserError);
  CHECK_THROWS_AS(Mesh(box("hexahedron", {3, 3, 3}, Vec3(1, 0, 1))), UserError);
  MeshOptions file;
  file.type = "file";
  file.file = "no_such.msh";
  CHECK_THROWS_AS(Mesh(file), UserError);
}

namespace {

/// The unit square of two triangles, its four sides named, in Gmsh's format 2.2 or 4.1.
std::string square_of_triangles(bool old_format, bool name_all) {
  std::string text = old_format ? "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" : "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  text += name_all ? "$PhysicalNames\n3\n1 1 \"inlet\"\n1 2 \"wall\"\n2 3 \"domain\"\n$EndPhysicalNames\n"
                   : "$PhysicalNames\n2\n1 1 \"inlet\"\n2 3 \"domain\"\n$EndPhysicalNames\n";
  if (old_format) {
    text += "$Nodes\n4\n1 0 0 0\n2 2 0 0\n3 2 1 0\n4 0 1 0\n$EndNodes\n";
    if (name_all)
      return text +
             "$Elements\n6\n1 1 2 2 1 1 2\n2 1 2 2 2 2 3\n3 1 2 2 3 3 4\n4 1 2 1 4 4 1\n5 2 2 3 1 1 2 3\n6 2 2 3 1 1 3 "
             "4\n$EndElements\n";
    return text + "$Elements\n3\n1 1 2 1 4 4 1\n2 2 2 3 1 1 2 3\n3 2 2 3 1 1 3 4\n$EndElements\n";
  }
  return text +
         "$Entities\n0 2 1 0\n1 0 0 0 0 1 0 1 1 0\n2 0 0 0 2 1 0 1 2 0\n1 0 0 0 2 1 0 1 3 0\n$EndEntities\n"
         "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n2 0 0\n2 1 0\n0 1 0\n$EndNodes\n"
         "$Elements\n3 6 1 6\n1 1 1 1\n4 4 1\n1 2 1 3\n1 1 2\n2 2 3\n3 3 4\n2 1 2 2\n5 1 2 3\n6 1 3 4\n$EndElements\n";
}

}  // namespace

TEST_CASE("A Gmsh file of either format gives the mesh, with its boundaries by name") {
  const TemporaryDirectory folder;
  for (bool old_format : {true, false}) {
    INFO((old_format ? "2.2" : "4.1"));
    MeshOptions options;
    options.type = "file";
    options.file = folder / "square.msh";
    options.scale = 0.1;
    std::ofstream(options.file) << square_of_triangles(old_format, true);
    const Mesh mesh(options);
    CHECK(mesh.cell == Cell::triangle);
    CHECK(mesh.total_cells == 2);
    CHECK(mesh.volume == Approx(0.02).epsilon(1e-12));
    CHECK(mesh.boundaries.size() == 2);
    double inlet = 0;
    for (const auto& facet : mesh.facets) {
      const auto x = mesh.facet_corners(facet);
      if (mesh.boundaries[facet.boundary] == "inlet") inlet += (x[1] - x[0]).norm();
    }
    CHECK(inlet == Approx(0.1));
  }
}

TEST_CASE("A boundary is known in lower case, as the options that name it are") {
  const TemporaryDirectory folder;
  MeshOptions options;
  options.type = "file";
  options.file = folder / "square.msh";
  std::string text = square_of_triangles(true, true);
  text.replace(text.find("inlet"), 5, "Inlet");
  std::ofstream(options.file) << text;
  const Mesh mesh(options);
  CHECK(std::count(mesh.boundaries.begin(), mesh.boundaries.end(), "inlet") == 1);
  text.replace(text.find("\"wall\""), 6, "\"INLET\"");
  std::ofstream(options.file) << text;
  CHECK_THROWS_WITH(Mesh(options), Catch::Contains("capitals"));
}

TEST_CASE("A mesh of two kinds of cells is refused on every rank, wherever they are", "[mpi]") {
  // A row of twenty squares, the last of two triangles.
  const TemporaryDirectory folder;
  MeshOptions options;
  options.type = "file";
  options.file = folder / "mixed.msh";
  if (mpi_rank() == 0) {
    std::ofstream file(options.file);
    file << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n42\n";
    for (int k = 0; k < 42; ++k) file << k + 1 << ' ' << k / 2 << ' ' << k % 2 << " 0\n";
    file << "$EndNodes\n$Elements\n21\n";
    for (int k = 0; k < 19; ++k)
      file << k + 1 << " 3 2 1 1 " << 2 * k + 1 << ' ' << 2 * k + 3 << ' ' << 2 * k + 4 << ' ' << 2 * k + 2 << '\n';
    file << "20 2 2 1 1 39 41 42\n21 2 2 1 1 39 42 40\n$EndElements\n";
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK_THROWS_WITH(Mesh(options), Catch::Contains("several kinds"));
}

TEST_CASE("A boundary facet without a name is refused") {
  const TemporaryDirectory folder;
  MeshOptions options;
  options.type = "file";
  options.file = folder / "square.msh";
  std::ofstream(options.file) << square_of_triangles(true, false);
  CHECK_THROWS_WITH(Mesh(options), Catch::Contains("inlet") && Catch::Contains("3 facets"));
}

TEST_CASE("A weighted partition shares out the cost instead of the cells", "[mpi]") {
  MeshOptions options = box("hexahedron", {4, 4, 16}, Vec3(1, 1, 4));
  options.weight = "(z < 1) ? 40 : 1";
  const Mesh mesh(options);
  double mine = 0;
  for (int c = 0; c < mesh.cells; ++c) mine += mesh.cell_coordinates[24 * static_cast<size_t>(c) + 2] < 0.99 ? 40 : 1;
  CHECK(mesh.total_cells == 256);
  CHECK(mpi_max(mine) < 1.3 * mpi_sum(mine) / mpi_size());
}
