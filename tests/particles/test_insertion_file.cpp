#include <hdf5.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "base/error.hpp"
#include "grid_file.hpp"
#include "particles/insertion/insertion.hpp"

using namespace silt;
using namespace silt::test;

namespace {

/// Writes a text file on rank 0 and removes it at the end of the test.
struct TextFile {
  std::string name;
  TextFile(const std::string& file, const std::string& text) : name(file) {
    if (mpi_rank() == 0) std::ofstream(name) << text;
    MPI_Barrier(PETSC_COMM_WORLD);
  }
  ~TextFile() {
    MPI_Barrier(PETSC_COMM_WORLD);
    if (mpi_rank() == 0) std::remove(name.c_str());
  }
};

std::vector<Seed> read(const std::string& file, const std::string& overlap = "0.05") {
  const Mesh mesh = box_mesh("hexahedron", {0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  Options options;
  options.set("insertion_bed_type", "file");
  options.set("insertion_bed_file", file);
  options.set("insertion_bed_velocity", "0, 0, 5");
  options.set("insertion_bed_material", "steel");
  options.set("insertion_bed_largest_overlap", overlap);
  const std::vector<std::string> materials = {"bead", "steel"};
  const Walls walls(mesh, options, materials);
  return make_insertions(walls, options, materials);
}

std::string message(const std::string& text, const std::string& overlap = "0.05") {
  const TextFile file("silt_test_particles.csv", text);
  try {
    read(file.name, overlap);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

void write(hid_t group, const char* name, std::vector<hsize_t> shape, const std::vector<double>& values) {
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t set = H5Dcreate2(group, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(set);
  H5Sclose(space);
}

}  // namespace

TEST_CASE("A CSV file gives particles by named columns in any order", "[insertion][mpi]") {
  const TextFile file("silt_test_particles.csv",
                      "# two beads\n\nz, y, x, diameter, vx, vy, vz, material\r\n"
                      "0.25, 0.5, 0.75, 0.2, 1, 2, 3, bead\r\n +0.5,0.5,0.25,1e-1, 0,0,0, steel\n");
  const auto seeds = read(file.name);
  REQUIRE(seeds.size() == 2);
  CHECK(seeds[0].position == Vec3(0.75, 0.5, 0.25));
  CHECK(seeds[0].velocity == Vec3(1, 2, 3));
  CHECK(seeds[0].radius == Approx(0.1));
  CHECK(seeds[0].material == 0);
  CHECK(seeds[1].material == 1);
  CHECK(seeds[1].position == Vec3(0.25, 0.5, 0.5));
}

TEST_CASE("What a CSV file does not say comes from the options", "[insertion]") {
  const TextFile file("silt_test_particles.csv", "x,y,z,radius\n0.5,0.5,0.5,0.1\n");
  const auto seeds = read(file.name);
  REQUIRE(seeds.size() == 1);
  CHECK(seeds[0].velocity == Vec3(0, 0, 5));
  CHECK(seeds[0].material == 1);
  CHECK(seeds[0].radius == 0.1);
}

TEST_CASE("Mistakes in a CSV file name file, line and column", "[insertion][mpi]") {
  using Catch::Contains;
  const std::string head = "x,y,z,radius\n";
  CHECK_THAT(message(head + "0.5,0.5,0.5,0.1\n0.5,0.5,abc,0.1\n"),
             Contains("silt_test_particles.csv:3: column 'z': 'abc' is not a number"));
  CHECK_THAT(message(head + "0.5,0.5,0.5\n"), Contains(":2: 3 values where the header names 4 columns"));
  CHECK_THAT(message(head + "0.5,0.5,0.5,-1\n"), Contains(":2: column 'radius' must be above 0"));
  CHECK_THAT(message(head + "0.5,0.5,0.5,1e999\n"), Contains("is not a number"));
  CHECK_THAT(message(head + "0.5,0.5,nan,0.1\n"), Contains("is not a number"));
  CHECK_THAT(message("x,y,radius\n"), Contains(":1: column 'z' is missing"));
  CHECK_THAT(message("x,y,z\n"), Contains("one of the columns 'diameter' and 'radius'"));
  CHECK_THAT(message("x,y,z,radius,x\n"), Contains("'x' occurs twice"));
  CHECK_THAT(message("x,y,z,radius,vx\n"), Contains("vx, vy, vz all or none"));
  CHECK_THAT(message("x,y,z,size\n"), Contains("unknown column 'size'"));
  CHECK_THAT(message(""), Contains("no header line"));
  CHECK_THAT(message("x,y,z,radius,material\n0.5,0.5,0.5,0.1,wood\n"), Contains(":2: column 'material': 'wood'"));
  CHECK_THAT(message(head + "0.5,0.5,1.5,0.1\n"), Contains(":2: the particle at (0.5, 0.5, 1.5) lies outside"));
  CHECK_THAT(message(head + "0.5,0.5,0.08,0.1\n"), Contains(":2: the particle overlaps a wall by 0.2 of its radius"));
  CHECK_THROWS_WITH(read("nowhere.csv"), Contains("'nowhere.csv' does not exist"));
}

TEST_CASE("An overlapping start is refused beyond the allowed share of the radius", "[insertion]") {
  using Catch::Contains;
  const std::string text = "x,y,z,radius\n0.3,0.5,0.5,0.1\n0.7,0.5,0.5,0.1\n0.48,0.5,0.5,0.1\n";
  CHECK_THAT(message(text), Contains("csv:4: the particle overlaps that of") && Contains("csv:2 by 0.2"));
  CHECK(message(text, "0.25").empty());
}

TEST_CASE("An HDF5 file gives particles as particle output writes them", "[insertion][mpi]") {
  const std::string name = "silt_test_particles.h5";
  const auto make = [&](const std::vector<double>& radius, bool with_position) {
    if (mpi_rank() == 0) {
      const hid_t file = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
      const hid_t group = H5Gcreate2(file, "particles", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      if (with_position) write(group, "position", {2, 3}, {0.2, 0.3, 0.4, 0.6, 0.7, 0.8});
      write(group, "spin", {2, 3}, {1, 2, 3, 4, 5, 6});
      write(group, "radius", {radius.size()}, radius);
      write(group, "material", {2}, {0, 1});
      H5Gclose(group);
      H5Fclose(file);
    }
    MPI_Barrier(PETSC_COMM_WORLD);
  };
  make({0.1, 0.05}, true);
  const auto seeds = read(name);
  REQUIRE(seeds.size() == 2);
  CHECK(seeds[1].position == Vec3(0.6, 0.7, 0.8));
  CHECK(seeds[1].spin == Vec3(4, 5, 6));
  CHECK(seeds[1].velocity == Vec3(0, 0, 5));
  CHECK(seeds[1].radius == 0.05);
  CHECK(seeds[0].material == 0);
  CHECK(seeds[1].material == 1);
  make({0.1, 0.05, 0.1}, true);
  CHECK_THROWS_WITH(read(name), Catch::Contains("/particles/radius has 3 rows where position has 2"));
  make({0.1, -0.1}, true);
  CHECK_THROWS_WITH(read(name), Catch::Contains("/particles/radius, row 2: must be above 0"));
  make({0.1, 0.1}, false);
  CHECK_THROWS_WITH(read(name), Catch::Contains("dataset /particles/position is missing"));
  MPI_Barrier(PETSC_COMM_WORLD);
  if (mpi_rank() == 0) {
    std::remove(name.c_str());
    std::ofstream(name) << "not HDF5";
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK_THROWS_WITH(read(name), Catch::Contains("is not an HDF5 file"));
  MPI_Barrier(PETSC_COMM_WORLD);
  if (mpi_rank() == 0) std::remove(name.c_str());
}
