// How the DMPlex comes to be: boxes of any cell, Gmsh files, distribution over the ranks.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

#include "base/error.hpp"
#include "base/expression.hpp"
#include "base/gmsh_file.hpp"
#include "base/mesh.hpp"

namespace silt {
namespace {

Cell cell_of(const std::string& word) {
  for (Cell cell : {Cell::triangle, Cell::quadrilateral, Cell::tetrahedron, Cell::hexahedron})
    if (name(cell) == word) return cell;
  throw UserError(fmt::format("option -mesh_cell: unknown cell '{}'", word));
}

/// Vertices of a grid of n[0] x n[1] x n[2] boxes, x fastest.
std::vector<double> grid_points(const MeshOptions& options, int dimension, const std::array<int, 3>& n) {
  std::vector<double> points;
  for (int k = 0; k <= (dimension > 2 ? n[2] : 0); ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i) {
        const int index[3] = {i, j, k};
        for (int d = 0; d < dimension; ++d)
          points.push_back(options.lower[d] + (options.upper[d] - options.lower[d]) * index[d] / n[d]);
      }
  return points;
}

/// Every box split into 2 triangles or 6 tetrahedra along its main diagonal (Kuhn), which meet face to face.
std::vector<PetscInt> kuhn_cells(int dimension, const std::array<int, 3>& n) {
  static const int paths[6][2] = {{1, 2}, {1, 4}, {2, 1}, {2, 4}, {4, 1}, {4, 2}};
  std::vector<PetscInt> cells;
  const int nx = n[0] + 1, ny = n[1] + 1;
  for (int k = 0; k < (dimension > 2 ? n[2] : 1); ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const auto corner = [&](int c) { return (i + (c & 1)) + nx * ((j + (c >> 1 & 1)) + ny * (k + (c >> 2 & 1))); };
        if (dimension == 2) {
          for (int c : {0, 1, 3, 0, 3, 2}) cells.push_back(corner(c));
          continue;
        }
        for (const auto& path : paths) {
          const bool odd =
              (path[0] == 1 && path[1] == 4) || (path[0] == 2 && path[1] == 1) || (path[0] == 4 && path[1] == 2);
          const int b = path[0], c = path[0] + path[1];
          for (int v : {0, odd ? b : c, odd ? c : b, 7}) cells.push_back(corner(v));
        }
      }
  return cells;
}

DmHandle create_box(const MeshOptions& options) {
  const Cell cell = cell_of(options.cell);
  const int dimension = cell_dimension(cell);
  if (static_cast<int>(options.cells.size()) < dimension)
    throw UserError(
        fmt::format("option -mesh_cells: {} numbers of cells are needed for a {}", dimension, options.cell));
  std::array<int, 3> n{1, 1, 1}, wrap{0, 0, 0};
  for (int d = 0; d < dimension; ++d) {
    n[d] = options.cells[d];
    wrap[d] = d < static_cast<int>(options.periodic.size()) ? options.periodic[d] : 0;
    if (!(options.upper[d] > options.lower[d]))
      throw UserError(fmt::format("option -mesh_upper: {:g} must be above -mesh_lower {:g} in direction {}",
                                  options.upper[d], options.lower[d], "xyz"[d]));
    if (wrap[d] && n[d] < 3)
      throw UserError(fmt::format("option -mesh_cells: {} is too few in periodic direction {}; at least 3 are needed",
                                  n[d], "xyz"[d]));
  }
  DmHandle plex;
  if (cell == Cell::hexahedron || cell == Cell::quadrilateral) {
    PetscInt faces[3] = {n[0], n[1], n[2]};
    PetscReal lower[3] = {options.lower[0], options.lower[1], options.lower[2]};
    PetscReal upper[3] = {options.upper[0], options.upper[1], options.upper[2]};
    DMBoundaryType kind[3];
    for (int d = 0; d < 3; ++d) kind[d] = wrap[d] ? DM_BOUNDARY_PERIODIC : DM_BOUNDARY_NONE;
#if PETSC_VERSION_LT(3, 22, 0)
    SILT_PETSC(DMPlexCreateBoxMesh(PETSC_COMM_WORLD, dimension, PETSC_FALSE, faces, lower, upper, kind, PETSC_TRUE,
                                   plex.out()));
#else
    SILT_PETSC(DMPlexCreateBoxMesh(PETSC_COMM_WORLD, dimension, PETSC_FALSE, faces, lower, upper, kind, PETSC_TRUE, 0,
                                   PETSC_TRUE, plex.out()));
#endif
    return plex;
  }
  for (int d = 0; d < dimension; ++d)
    if (wrap[d])
      throw UserError(
          fmt::format("option -mesh_periodic: not available for a box of {}s; use hexahedron or quadrilateral, "
                      "or a Gmsh file with periodic sides",
                      options.cell));
  std::vector<double> points;
  std::vector<PetscInt> cells;
  if (mpi_rank() == 0) {
    points = grid_points(options, dimension, n);
    cells = kuhn_cells(dimension, n);
  }
  const int corners = cell_nodes(cell);
  SILT_PETSC(DMPlexCreateFromCellListPetsc(PETSC_COMM_WORLD, dimension, static_cast<PetscInt>(cells.size() / corners),
                                           static_cast<PetscInt>(points.size() / dimension), corners, PETSC_TRUE,
                                           cells.data(), dimension, points.data(), plex.out()));
  return plex;
}

/// Gives every facet a label with its physical name. PETSc could do that itself (-dm_plex_gmsh_use_regions), but
/// in 3.18 it takes the elementary numbers of format 2.2 for physical ones too.
void name_facets(DM plex, const std::string& file) {
  PetscInt dimension;
  SILT_PETSC(DMGetDimension(plex, &dimension));
  std::map<PetscInt, DMLabel> labels;
  std::ifstream text(file, std::ios::binary);
  std::string line;
  while (std::getline(text, line) && line.rfind("$PhysicalNames", 0) != 0 && line.rfind("$Nodes", 0) != 0) {
  }
  while (std::getline(text, line) && line[0] != '$') {
    std::istringstream row(line);
    PetscInt of_dimension, tag;
    std::string name;
    if (!(row >> of_dimension >> tag >> std::quoted(name)) || of_dimension != dimension - 1) continue;
    SILT_PETSC(DMCreateLabel(plex, name.c_str()));
    SILT_PETSC(DMGetLabel(plex, name.c_str(), &labels[tag]));
  }
  DMLabel sets;
  SILT_PETSC(DMGetLabel(plex, "Face Sets", &sets));
  PetscInt first, last;
  SILT_PETSC(DMPlexGetHeightStratum(plex, 1, &first, &last));
  for (PetscInt facet = first; sets && facet < last; ++facet) {
    PetscInt tag;
    SILT_PETSC(DMLabelGetValue(sets, facet, &tag));
    if (const auto found = labels.find(tag); found != labels.end())
      SILT_PETSC(DMLabelSetValue(found->second, facet, tag));
  }
}

/// Throws UserError on every rank for a file that is damaged.
void check_gmsh(const std::string& file) {
  std::string fault = mpi_rank() == 0 ? fault_of_gmsh_file(file) : "";
  int length = static_cast<int>(fault.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  fault.resize(static_cast<size_t>(length));
  MPI_Bcast(fault.data(), length, MPI_CHAR, 0, PETSC_COMM_WORLD);
  if (!fault.empty())
    throw UserError(fmt::format("option -mesh_file: '{}' is not a Gmsh mesh that can be read: {}", file, fault));
}

DmHandle read_gmsh(const std::string& file) {
  if (file.empty()) throw UserError("option -mesh_file: a mesh of type file needs a Gmsh file");
  if (!std::filesystem::is_regular_file(file))
    throw UserError(fmt::format("option -mesh_file: '{}' does not exist", file));
  check_gmsh(file);
  // Only the first rank reads, and where it fails PETSc leaves the others waiting: it tries alone first.
  PetscErrorCode code = 0;
  if (mpi_size() > 1 && mpi_rank() == 0) {
    DmHandle trial;
    code = DMPlexCreateGmshFromFile(PETSC_COMM_SELF, file.c_str(), PETSC_FALSE, trial.out());
  }
  DmHandle plex;
  if (!mpi_any(code != 0)) code = DMPlexCreateGmshFromFile(PETSC_COMM_WORLD, file.c_str(), PETSC_TRUE, plex.out());
  if (mpi_any(code != 0))
    throw UserError(
        fmt::format("option -mesh_file: '{}' is not a Gmsh mesh that can be read (formats 2.2 and 4.1)", file));
  name_facets(plex, file);
  return plex;
}

}  // namespace

MeshOptions::MeshOptions(Options& options) {
  options.read("mesh", *this);
  if (!options.given("mesh_type") && options.given("mesh_file")) type = "file";
  const bool is_file = type == "file";
  const std::vector<const char*> of_boxes = {"cell", "lower", "upper", "cells", "periodic"}, of_files = {"file"};
  for (const char* name : is_file ? of_boxes : of_files)
    if (options.given(std::string("mesh_") + name))
      throw UserError(fmt::format("option -mesh_{} has no meaning with -mesh_type {}", name, type));
}

void MeshOptions::options(OptionGroup& option) {
  option("type", type, {"box", "file"}, "a box of cells, or a Gmsh file; a file when one is named");
  option("file", file, "Gmsh file (2.2 or 4.1) with a physical name for every boundary; its periodic sides repeat");
  option("cell", cell, {"hexahedron", "tetrahedron", "quadrilateral", "triangle"},
         "cell of a box; two-dimensional cells make a 2D mesh");
  option("lower", lower, "m", "lowest corner of the box");
  option("upper", upper, "m", "highest corner of the box");
  option("cells", cells, "-", "cells along x, y, z (simplices: boxes that are split)", at_least(1));
  option("periodic", periodic, "-", "1 for every direction in which the box repeats", between(0, 1));
  option("weight", weight,
         "cost of a cell for the partition, a formula in x, y, z of its centre: (z < 0.05) ? 20 : 1 where a bed makes "
         "cells cost 20 times as much");
  option("scale", scale, "-", "factor on the coordinates of a mesh file (0.001: written in mm)", positive);
}

void Mesh::create(const MeshOptions& options, const Partition& partition) {
  const bool box = options.type == "box";
  plex_ = box ? create_box(options) : read_gmsh(options.file);
  if (mpi_size() == 1) return;
  PetscPartitioner partitioner;
  SILT_PETSC(DMPlexGetPartitioner(plex_, &partitioner));
  PetscInt first = 0, last = 0;
  SILT_PETSC(DMPlexGetHeightStratum(plex_, 0, &first, &last));
  // PTScotch cannot split fewer cells than ranks; those meshes only occur in tests and demonstrations.
  const bool tiny = mpi_sum(static_cast<long long>(last - first)) < 2LL * mpi_size();
  if (!partition.ranks.empty()) {
    assign(partition, options.scale);
  } else {
    SILT_PETSC(PetscPartitionerSetType(partitioner, tiny ? PETSCPARTITIONERSIMPLE : PETSCPARTITIONERPTSCOTCH));
    SILT_PETSC(PetscPartitionerSetFromOptions(partitioner));
    weigh(options.weight, partition, options.scale);
  }
  DmHandle distributed;
  SILT_PETSC(DMPlexDistribute(plex_, 0, nullptr, distributed.out()));
  if (distributed) plex_ = std::move(distributed);
}

}  // namespace silt
