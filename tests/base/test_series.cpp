#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/csv.hpp"
#include "base/error.hpp"
#include "base/series.hpp"
#include "support/temporary_directory.hpp"

using namespace silt;

namespace {

/// The whole dataset as doubles, read by this rank alone.
std::vector<double> read(const std::string& file, const std::string& name) {
  const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  REQUIRE(id >= 0);
  const hid_t set = H5Dopen2(id, name.c_str(), H5P_DEFAULT), space = H5Dget_space(set);
  std::vector<double> values(static_cast<size_t>(H5Sget_simple_extent_npoints(space)));
  if (!values.empty()) REQUIRE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(id);
  return values;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  std::stringstream out;
  out << in.rdbuf();
  return out.str();
}

int count_of(const std::string& text, const std::string& word) {
  int count = 0;
  for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++count;
  return count;
}

OutputDirectory made(const TemporaryDirectory& folder, const std::string& precision = "double") {
  OutputOptions options;
  options.directory = folder / "run";
  options.precision = precision;
  OutputDirectory directory(options);
  directory.prepare("title: test\n");
  return directory;
}

Mesh box(const std::string& cell, std::vector<int> cells, std::vector<int> periodic = {0, 0, 0}) {
  MeshOptions options;
  options.cell = cell;
  options.cells = std::move(cells);
  options.periodic = std::move(periodic);
  return Mesh(options);
}

}  // namespace

TEST_CASE("a fluid series holds every node once with its field, and cells that enclose the volume",
          "[base][series][mpi]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    TemporaryDirectory folder;
    const OutputDirectory directory = made(folder);
    const Mesh mesh = box(cell, {4, 3, 2});
    FluidSeries series(directory, mesh, "title: test");
    std::vector<double> pressure(mesh.nodes), velocity(3 * mesh.nodes);
    const auto x = [&](int i, int d) { return mesh.node_coordinates[3 * i + d]; };
    for (int step = 0; step < 2; ++step) {
      for (int i = 0; i < mesh.nodes; ++i) {
        pressure[i] = x(i, 0) + 10 * x(i, 1) + step;
        for (int d = 0; d < 3; ++d) velocity[3 * i + d] = x(i, d) - step;
      }
      series.write(0.5 * step, {{"pressure", 1, pressure}, {"velocity", 3, velocity}});
    }
    const auto points = read(directory.path("fluid/mesh.h5"), "points"),
               cells = read(directory.path("fluid/mesh.h5"), "cells");
    REQUIRE(points.size() == 3u * 5 * 4 * 3);
    REQUIRE(cells.size() == static_cast<size_t>(mesh.total_cells * mesh.nodes_per_cell));
    const auto p = read(directory.path("fluid/000001.h5"), "pressure"),
               u = read(directory.path("fluid/000001.h5"), "velocity");
    REQUIRE(p.size() == points.size() / 3);
    for (size_t k = 0; k < p.size(); ++k) {
      CHECK(p[k] == Approx(points[3 * k] + 10 * points[3 * k + 1] + 1));
      for (size_t d = 0; d < 3; ++d) CHECK(u[3 * k + d] == Approx(points[3 * k + d] - 1).margin(1e-14));
    }
    // Volumes from the file's own points and cells: XDMF's hexahedra go around, so 0-1, 0-3, 0-4 are edges.
    double volume = 0;
    const bool hexahedra = mesh.cell == Cell::hexahedron;
    for (long long c = 0; c < mesh.total_cells; ++c) {
      const double* node = &cells[static_cast<size_t>(c * mesh.nodes_per_cell)];
      const auto edge = [&](int a) -> Vec3 {
        return vec3(&points[3 * static_cast<size_t>(node[a])]) - vec3(&points[3 * static_cast<size_t>(node[0])]);
      };
      volume += hexahedra ? edge(1).cross(edge(3)).dot(edge(4)) : edge(1).cross(edge(2)).dot(edge(3)) / 6;
      if (hexahedra) CHECK((edge(6) - edge(1) - edge(3) - edge(4)).norm() < 1e-12);
    }
    CHECK(volume == Approx(1));
    const std::string index = text_of(directory.path("fluid.xdmf"));
    CHECK(count_of(index, "<Time Value") == 2);
    CHECK(count_of(index, "fluid/000001.h5:/velocity") == 1);
  }
}

TEST_CASE("on a periodic mesh every cell is written in its own place", "[base][series][mpi]") {
  TemporaryDirectory folder;
  const OutputDirectory directory = made(folder);
  const Mesh mesh = box("hexahedron", {4, 3, 3}, {1, 0, 0});
  FluidSeries series(directory, mesh);
  std::vector<double> field(mesh.nodes);
  for (int i = 0; i < mesh.nodes; ++i) field[i] = std::cos(2 * M_PI * mesh.node_coordinates[3 * i]);
  series.write(0, {{"wave", 1, field}});
  const auto points = read(directory.path("fluid/mesh.h5"), "points"),
             wave = read(directory.path("fluid/000000.h5"), "wave");
  REQUIRE(points.size() == 3u * 8 * 36);
  for (size_t c = 0; c < 36; ++c) {
    double low = 2, high = -1;
    for (size_t a = 8 * c; a < 8 * c + 8; ++a) {
      low = std::min(low, points[3 * a]);
      high = std::max(high, points[3 * a]);
      CHECK(wave[a] == Approx(std::cos(2 * M_PI * points[3 * a])).margin(1e-12));
    }
    CHECK(high - low == Approx(0.25));
  }
}

TEST_CASE("a particle series holds the particles of all ranks, also of ranks that own none, also none at all",
          "[base][series][mpi]") {
  TemporaryDirectory folder;
  const OutputDirectory directory = made(folder);
  ParticleSeries series(directory, "title: test");
  const auto write = [&](double time, int mine) {
    std::vector<double> position, radius;
    std::vector<std::int64_t> id;
    for (int k = 0; k < mine; ++k) {
      const int number = 100 * mpi_rank() + k;
      id.push_back(number);
      radius.push_back(0.5 * number);
      for (int d = 0; d < 3; ++d) position.push_back(number + 0.25 * d);
    }
    series.write(time, {{"position", 3, std::span<const double>(position)},
                        {"radius", 1, std::span<const double>(radius)},
                        {"id", 1, std::span<const std::int64_t>(id)}});
  };
  write(0, 0);
  write(0.1, mpi_rank() == mpi_size() - 1 ? 3 : 0);  // only the last rank owns particles
  write(0.2, 2);
  CHECK(read(directory.path("particles/000000.h5"), "radius").empty());
  CHECK(read(directory.path("particles/000001.h5"), "id").size() == 3);
  const auto x = read(directory.path("particles/000002.h5"), "position"),
             r = read(directory.path("particles/000002.h5"), "radius");
  const auto id = read(directory.path("particles/000002.h5"), "id");
  REQUIRE(id.size() == 2u * mpi_size());
  for (size_t k = 0; k < id.size(); ++k) {
    CHECK(id[k] == 100 * static_cast<double>(k / 2) + static_cast<double>(k % 2));
    CHECK(r[k] == 0.5 * id[k]);
    CHECK(x[3 * k + 2] == id[k] + 0.5);
  }
  CHECK(count_of(text_of(directory.path("particles.xdmf")), "<Time Value") == 3);
}

TEST_CASE("single precision keeps seven digits in half the space", "[base][series][mpi]") {
  TemporaryDirectory folder;
  const OutputDirectory directory = made(folder, "single");
  const Mesh mesh = box("hexahedron", {10, 10, 10});
  FluidSeries series(directory, mesh);
  std::vector<double> field(mesh.nodes, 1.0 / 3);
  series.write(0, {{"a", 1, field}});
  for (double value : read(directory.path("fluid/000000.h5"), "a")) CHECK(std::abs(value - 1.0 / 3) < 2e-8);
  CHECK(text_of(directory.path("fluid.xdmf")).find("Precision=\"4\"") != std::string::npos);
}

TEST_CASE("a disk that takes no more is one error on every rank and leaves the earlier outputs readable",
          "[base][series][mpi]") {
  TemporaryDirectory folder;
  const OutputDirectory directory = made(folder);
  ParticleSeries series(directory);
  std::vector<double> position(30000, 1.0);
  const auto write = [&](double time) { series.write(time, {{"position", 3, std::span<const double>(position)}}); };
  write(0);
  // No file may grow beyond 100 kB from here on: what a full disk looks like to a program.
  signal(SIGXFSZ, SIG_IGN);
  rlimit before, tight;
  getrlimit(RLIMIT_FSIZE, &before);
  tight = before;
  tight.rlim_cur = 100000;
  setrlimit(RLIMIT_FSIZE, &tight);
  CHECK_THROWS_AS(write(0.1), RunError);
  CHECK_THROWS_WITH(write(0.1),
                    Catch::Contains("cannot write") && Catch::Contains("000001.h5") && Catch::Contains("too large"));
  setrlimit(RLIMIT_FSIZE, &before);
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK(count_of(text_of(directory.path("particles.xdmf")), "<Time Value") == 1);
  CHECK(read(directory.path("particles/000000.h5"), "position").size() == position.size() * mpi_size());
  CHECK_FALSE(std::filesystem::exists(directory.path("particles/000001.h5")));
  CHECK_FALSE(std::filesystem::exists(directory.path("particles/000001.h5.part")));
  write(0.1);  // and the series goes on once there is room
  CHECK(count_of(text_of(directory.path("particles.xdmf")), "<Time Value") == 2);
}

TEST_CASE("every row of a CSV table is in the file at once", "[base][csv][mpi]") {
  TemporaryDirectory folder;
  CsvWriter table(folder / "t.csv", {"time", "value"});
  const double row[] = {0.1, 1.0 / 3};
  table.row(row);
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK(text_of(folder / "t.csv") == "time,value\n0.1,0.333333333333\n");
  MPI_Barrier(PETSC_COMM_WORLD);
  const double rows[] = {1, 2, 3, 4};
  table.row(rows);
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK(count_of(text_of(folder / "t.csv"), "\n") == 4);
  CHECK_THROWS_AS(CsvWriter(folder / "missing/t.csv", {"a"}), RunError);
}

TEST_CASE("only an earlier run of ours is overwritten, and nothing that is not ours", "[base][output][mpi]") {
  TemporaryDirectory folder;
  OutputOptions options;
  options.directory = folder / "a/b/run";
  const auto touch = [](const std::string& file) {
    if (mpi_rank() == 0) std::ofstream(file) << "x";
    MPI_Barrier(PETSC_COMM_WORLD);
  };
  {
    OutputDirectory directory(options);
    CHECK_FALSE(std::filesystem::exists(folder / "a"));  // checking leaves nothing behind
    MPI_Barrier(PETSC_COMM_WORLD);
    directory.prepare("title: first\n");
    ParticleSeries series(directory);
    series.write(0, {{"position", 3, std::span<const double>()}});
  }
  touch(folder / "a/b/run/notes.txt");
  // A table that the next run does not write must not be taken for its own.
  for (const std::string table : {"energy", "errors", "walls", "removed", "probe_a"})
    touch(folder / ("a/b/run/" + table + ".csv"));
  OutputDirectory(options).prepare("title: second\n");
  MPI_Barrier(PETSC_COMM_WORLD);
  CHECK_FALSE(std::filesystem::exists(folder / "a/b/run/particles.xdmf"));
  CHECK_FALSE(std::filesystem::exists(folder / "a/b/run/particles/000000.h5"));
  CHECK(std::filesystem::exists(folder / "a/b/run/notes.txt"));
  for (const std::string table : {"energy", "errors", "walls", "removed", "probe_a"})
    CHECK_FALSE(std::filesystem::exists(folder / ("a/b/run/" + table + ".csv")));
  CHECK(text_of(folder / "a/b/run/run.yaml") == "title: second\n");
  options.overwrite = false;
  CHECK_THROWS_AS(OutputDirectory(options), UserError);
  CHECK_NOTHROW(OutputDirectory(options, folder / "a/b/run/checkpoint.h5"));  // it goes on there
  CHECK_THROWS_AS(OutputDirectory(options, folder / "a/b/checkpoint.h5"), UserError);
  options.overwrite = true;
  options.directory = folder.path();
  CHECK_NOTHROW(OutputDirectory(options));  // foreign files do no harm
  touch(folder / "diagnostics.csv");
  CHECK_THROWS_AS(OutputDirectory(options), UserError);  // ... unless they bear our names
  options.directory = folder / "diagnostics.csv/run";
  CHECK_THROWS_AS(OutputDirectory(options), UserError);
  options.directory = "/proc/silt_run";
  CHECK_THROWS_AS(OutputDirectory(options), UserError);
  MPI_Barrier(PETSC_COMM_WORLD);
}
