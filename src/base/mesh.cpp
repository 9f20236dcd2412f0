// The arrays that element and particle loops run over, taken from the DMPlex once.
#include "base/mesh.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "base/mesh_periods.hpp"
#include "base/text.hpp"

namespace silt {
namespace {

/// Place in PETSc's closure of each of our nodes (tensor cells: ours are lexicographic).
constexpr int quadrilateral_order[4] = {0, 1, 3, 2};
constexpr int hexahedron_order[8] = {0, 3, 1, 2, 4, 5, 7, 6};

/// Nothing for a cell of another type.
std::optional<Cell> cell_from(DMPolytopeType type) {
  switch (type) {
    case DM_POLYTOPE_TRIANGLE:
      return Cell::triangle;
    case DM_POLYTOPE_QUADRILATERAL:
      return Cell::quadrilateral;
    case DM_POLYTOPE_TETRAHEDRON:
      return Cell::tetrahedron;
    case DM_POLYTOPE_HEXAHEDRON:
      return Cell::hexahedron;
    default:
      return std::nullopt;
  }
}

/// Determinant of the map from the reference cell at xi; coordinates[nodes][3].
double jacobian_determinant(Cell cell, const double* coordinates, const double* xi) {
  double N[8], dN[8][3], J[3][3] = {};
  shape(cell, xi, N, dN);
  for (int a = 0; a < cell_nodes(cell); ++a)
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 3; ++d) J[i][d] += coordinates[3 * a + i] * dN[a][d];
  if (cell_dimension(cell) == 2) return J[0][0] * J[1][1] - J[0][1] * J[1][0];
  return J[0][0] * (J[1][1] * J[2][2] - J[1][2] * J[2][1]) - J[0][1] * (J[1][0] * J[2][2] - J[1][2] * J[2][0]) +
         J[0][2] * (J[1][0] * J[2][1] - J[1][1] * J[2][0]);
}

/// The vertices of a point of the plex, in closure order.
std::vector<PetscInt> vertices_of(DM plex, PetscInt point, PetscInt first_vertex, PetscInt last_vertex) {
  PetscInt* closure = nullptr;
  PetscInt size = 0;
  SILT_PETSC(DMPlexGetTransitiveClosure(plex, point, PETSC_TRUE, &size, &closure));
  std::vector<PetscInt> vertices;
  for (PetscInt k = 0; k < size; ++k)
    if (closure[2 * k] >= first_vertex && closure[2 * k] < last_vertex) vertices.push_back(closure[2 * k]);
  SILT_PETSC(DMPlexRestoreTransitiveClosure(plex, point, PETSC_TRUE, &size, &closure));
  return vertices;
}

/// For every point of the plex that another rank holds too: that rank (the owner's for ghosts, one of the holders for
/// owned points), else -1.
std::vector<int> sharing_ranks(DM plex, PetscInt points, std::vector<char>& owned) {
  std::vector<int> rank(points, -1), mine(points, mpi_rank());
  owned.assign(points, 1);
  PetscSF sf;
  SILT_PETSC(DMGetPointSF(plex, &sf));
  PetscInt roots = -1, leaves = 0;
  const PetscInt* local = nullptr;
  const PetscSFNode* remote = nullptr;
  SILT_PETSC(PetscSFGetGraph(sf, &roots, &leaves, &local, &remote));
  if (roots < 0) return rank;
  SILT_PETSC(PetscSFReduceBegin(sf, MPI_INT, mine.data(), rank.data(), MPI_MAX));
  SILT_PETSC(PetscSFReduceEnd(sf, MPI_INT, mine.data(), rank.data(), MPI_MAX));
  for (PetscInt k = 0; k < leaves; ++k) {
    const PetscInt point = local ? local[k] : k;
    rank[point] = static_cast<int>(remote[k].rank);
    owned[point] = 0;
  }
  return rank;
}

}  // namespace

Mesh::Mesh(const MeshOptions& options, const Partition& partition) {
  create(options, partition);
  extract();
  if (options.scale != 1) {
    for (auto& x : cell_coordinates) x *= options.scale;
    for (auto& x : node_coordinates) x *= options.scale;
  }
  if (options.type == "box")
    for (int d = 0; d < dimension; ++d)
      periodic[d] = d < static_cast<int>(options.periodic.size()) && options.periodic[d] != 0;

  Vec3 low = Vec3::Constant(infinity), high = Vec3::Constant(-infinity);
  for (size_t k = 0; k < cell_coordinates.size(); k += 3) {
    low = low.cwiseMin(vec3(&cell_coordinates[k]));
    high = high.cwiseMax(vec3(&cell_coordinates[k]));
  }
  for (int d = 0; d < 3; ++d) {
    lower[d] = mpi_min(low[d]);
    upper[d] = mpi_max(high[d]);
  }
  const Quadrature rule = quadrature(cell, 2);
  double edge = infinity, sum = 0;
  bool inverted = false;
  cell_volumes.assign(cells, 0.0);
  for (int c = 0; c < cells; ++c) {
    const double* x = &cell_coordinates[3 * nodes_per_cell * c];
    for (int q = 0; q < rule.points; ++q) {
      const double determinant = jacobian_determinant(cell, x, rule.point[q].data());
      inverted = inverted || !(determinant > 0);
      cell_volumes[c] += rule.weight[q] * determinant;
    }
    sum += cell_volumes[c];
    for (int f = 0; f < facets_per_cell; ++f) {
      const auto& list = facet_node_list(cell, f);
      const int corners = facet_nodes(cell);
      for (int k = 0; k < corners; ++k)
        edge = std::min(edge, (vec3(x + 3 * list[k]) - vec3(x + 3 * list[(k + 1) % corners])).norm());
    }
  }
  if (mpi_any(inverted)) throw UserError("the mesh has a cell that is inverted or has no volume");
  smallest_edge = mpi_min(edge);
  volume = mpi_sum(sum);
  if (options.type == "file") find_periods(*this, options.file);
  extract_boundaries();
  if (options.type == "file") check_periodic_ends(*this, options.file);
}

void Mesh::extract() {
  PetscInt first_cell, last_cell, first_vertex, last_vertex, first_point, last_point;
  SILT_PETSC(DMPlexGetHeightStratum(plex_, 0, &first_cell, &last_cell));
  SILT_PETSC(DMPlexGetDepthStratum(plex_, 0, &first_vertex, &last_vertex));
  SILT_PETSC(DMPlexGetChart(plex_, &first_point, &last_point));
  cells = static_cast<int>(last_cell - first_cell);
  total_cells = mpi_sum(static_cast<long long>(cells));
  if (total_cells == 0) throw UserError("the mesh has no cells");

  int kind = -1, strange = -1;
  bool mixed = false;
  for (PetscInt c = first_cell; c < last_cell; ++c) {
    DMPolytopeType type;
    SILT_PETSC(DMPlexGetCellType(plex_, c, &type));
    const auto known = cell_from(type);
    if (!known) {
      strange = type;
      continue;
    }
    const int here = static_cast<int>(*known);
    mixed = mixed || (kind >= 0 && kind != here);
    kind = here;
  }
  strange = static_cast<int>(mpi_max(strange));
  if (strange >= 0)
    throw UserError(fmt::format(
        "the mesh contains cells of type '{}'; only triangles, quadrilaterals, tetrahedra and hexahedra are allowed",
        DMPolytopeTypes[strange]));
  cell = static_cast<Cell>(static_cast<int>(mpi_max(kind)));
  if (mpi_any(mixed || (kind >= 0 && kind != static_cast<int>(cell))))
    throw UserError("the mesh mixes cells of several kinds; one kind a mesh is allowed");
  dimension = cell_dimension(cell);
  nodes_per_cell = silt::cell_nodes(cell);
  facets_per_cell = cell_facets(cell);

  // Nodes: owned ones first, in the order of the plex.
  std::vector<char> owned;
  const std::vector<int> other_rank = sharing_ranks(plex_, last_point - first_point, owned);
  std::vector<int> node_of(last_point - first_point, -1);
  for (int pass = 0; pass < 2; ++pass)
    for (PetscInt v = first_vertex; v < last_vertex; ++v)
      if (owned[v] == (pass == 0)) {
        node_of[v] = nodes++;
        owned_nodes += pass == 0;
      }
  long long count = owned_nodes;
  MPI_Exscan(&count, &first_node, 1, MPI_LONG_LONG, MPI_SUM, PETSC_COMM_WORLD);
  if (mpi_rank() == 0) first_node = 0;
  total_nodes = mpi_sum(count);

  PetscSF point_sf;
  SILT_PETSC(DMGetPointSF(plex_, &point_sf));
  PetscInt roots = -1, leaves = 0;
  const PetscInt* leaf = nullptr;
  const PetscSFNode* remote = nullptr;
  SILT_PETSC(PetscSFGetGraph(point_sf, &roots, &leaves, &leaf, &remote));
  std::vector<int> owner_node = node_of;
  if (roots >= 0) {
    SILT_PETSC(PetscSFBcastBegin(point_sf, MPI_INT, node_of.data(), owner_node.data(), MPI_REPLACE));
    SILT_PETSC(PetscSFBcastEnd(point_sf, MPI_INT, node_of.data(), owner_node.data(), MPI_REPLACE));
  }
  std::vector<PetscInt> ghost;
  std::vector<PetscSFNode> owner;
  for (PetscInt k = 0; k < (roots >= 0 ? leaves : 0); ++k) {
    const PetscInt point = leaf ? leaf[k] : k;
    if (point < first_vertex || point >= last_vertex) continue;
    ghost.push_back(node_of[point]);
    owner.push_back({remote[k].rank, owner_node[point]});
  }
  SILT_PETSC(PetscSFCreate(PETSC_COMM_WORLD, node_exchange_.out()));
  SILT_PETSC(PetscSFSetGraph(node_exchange_, nodes, static_cast<PetscInt>(ghost.size()), ghost.data(),
                             PETSC_COPY_VALUES, owner.data(), PETSC_COPY_VALUES));
  std::vector<double> number(nodes, 0.0);
  for (int i = 0; i < owned_nodes; ++i) number[i] = static_cast<double>(first_node + i);
  copy_from_owner(number.data(), 1);
  node_global.assign(nodes, 0);
  for (int i = 0; i < nodes; ++i) node_global[i] = std::llround(number[i]);

  // Cells: nodes, coordinates of their own (periodic meshes), neighbours.
  PetscInt embedding;
  SILT_PETSC(DMGetCoordinateDim(plex_, &embedding));
  node_coordinates.assign(3 * static_cast<size_t>(nodes), 0.0);
  cell_nodes.resize(static_cast<size_t>(cells) * nodes_per_cell);
  cell_coordinates.assign(3 * cell_nodes.size(), 0.0);
  cell_neighbours.assign(static_cast<size_t>(cells) * facets_per_cell, -1);
  facet_ranks.assign(cell_neighbours.size(), -1);
  for (int c = 0; c < cells; ++c) {
    const PetscInt point = first_cell + c;
    const auto vertices = vertices_of(plex_, point, first_vertex, last_vertex);
    PetscBool localized;
    PetscInt size;
    const PetscScalar* array;
    PetscScalar* coordinates = nullptr;
    SILT_PETSC(DMPlexGetCellCoordinates(plex_, point, &localized, &size, &array, &coordinates));
    int* local = &cell_nodes[static_cast<size_t>(c) * nodes_per_cell];
    double* x = &cell_coordinates[3 * static_cast<size_t>(c) * nodes_per_cell];
    std::vector<PetscInt> vertex(nodes_per_cell);
    for (int a = 0; a < nodes_per_cell; ++a) {
      const int place = cell == Cell::hexahedron      ? hexahedron_order[a]
                        : cell == Cell::quadrilateral ? quadrilateral_order[a]
                                                      : a;
      vertex[a] = vertices[place];
      for (int d = 0; d < dimension; ++d) x[3 * a + d] = PetscRealPart(coordinates[place * embedding + d]);
    }
    SILT_PETSC(DMPlexRestoreCellCoordinates(plex_, point, &localized, &size, &array, &coordinates));
    const double centre[3] = {0.25, 0.25, 0.25};
    if (jacobian_determinant(cell, x, centre) < 0) {
      // PETSc may list a cell inside out: exchanging the first two axes turns it.
      const auto exchange = [&](int a, int b) {
        std::swap(vertex[a], vertex[b]);
        std::swap_ranges(x + 3 * a, x + 3 * a + 3, x + 3 * b);
      };
      exchange(1, 2);
      if (cell == Cell::hexahedron) exchange(5, 6);
    }
    for (int a = 0; a < nodes_per_cell; ++a) {
      local[a] = node_of[vertex[a]];
      std::copy_n(x + 3 * a, 3, &node_coordinates[3 * static_cast<size_t>(local[a])]);
    }
    // Facets are matched by their vertices: PETSc's order of the cone is not ours.
    const PetscInt* cone;
    PetscInt cone_size;
    SILT_PETSC(DMPlexGetCone(plex_, point, &cone));
    SILT_PETSC(DMPlexGetConeSize(plex_, point, &cone_size));
    for (PetscInt k = 0; k < cone_size; ++k) {
      auto corners = vertices_of(plex_, cone[k], first_vertex, last_vertex);
      std::sort(corners.begin(), corners.end());
      for (int f = 0; f < facets_per_cell; ++f) {
        std::vector<PetscInt> ours;
        for (int a : facet_node_list(cell, f))
          if (a >= 0) ours.push_back(vertex[a]);
        std::sort(ours.begin(), ours.end());
        if (ours != corners) continue;
        const size_t place = static_cast<size_t>(c) * facets_per_cell + f;
        const PetscInt* support;
        PetscInt support_size;
        SILT_PETSC(DMPlexGetSupport(plex_, cone[k], &support));
        SILT_PETSC(DMPlexGetSupportSize(plex_, cone[k], &support_size));
        if (support_size == 2) {
          cell_neighbours[place] = static_cast<int>((support[0] == point ? support[1] : support[0]) - first_cell);
        } else if (other_rank[cone[k]] >= 0) {
          cell_neighbours[place] = remote_cell;
          facet_ranks[place] = other_rank[cone[k]];
        } else {
          facets.push_back({c, f, -1});
          facet_labels_.emplace_back(static_cast<int>(cone[k]), static_cast<int>(place));
        }
      }
    }
  }
}

void Mesh::extract_boundaries() {
  // Boxes carry no label of ours: their facets are told by where they lie. Files: one label per physical name.
  std::vector<DMLabel> labels;
  PetscInt count;
  SILT_PETSC(DMGetNumLabels(plex_, &count));
  std::vector<std::string> names;
  for (PetscInt k = 0; k < count; ++k) {
    const char* label_name;
    SILT_PETSC(DMGetLabelName(plex_, k, &label_name));
    const std::string word = label_name;
    if (word == "depth" || word == "celltype" || word == "Cell Sets" || word == "Face Sets" || word == "Vertex Sets" ||
        word == "Edge Sets" || word == "marker")
      continue;
    DMLabel label;
    SILT_PETSC(DMGetLabelByNum(plex_, k, &label));
    bool on_boundary = false;
    for (const auto& [facet, place] : facet_labels_) {
      PetscInt value;
      SILT_PETSC(DMLabelGetValue(label, facet, &value));
      on_boundary = on_boundary || value >= 0;
    }
    if (!mpi_any(on_boundary)) continue;
    if (std::find(names.begin(), names.end(), lower_case(word)) != names.end())
      throw UserError(
          fmt::format("two boundaries of the mesh differ by capitals alone, as options do not: '{}'", word));
    labels.push_back(label);
    names.push_back(lower_case(word));
  }
  const bool by_name = !names.empty();
  if (!by_name)
    for (int d = 0; d < dimension; ++d)
      for (const char* end : {"min", "max"}) names.push_back(fmt::format("{}_{}", "xyz"[d], end));

  std::vector<int> used(names.size(), 0);
  int nameless = 0, doubly = -1;
  const double tolerance = 1e-6 * smallest_edge;
  for (size_t k = 0; k < facets.size(); ++k) {
    int found = -1;
    if (by_name) {
      for (size_t b = 0; b < labels.size(); ++b) {
        PetscInt value;
        SILT_PETSC(DMLabelGetValue(labels[b], facet_labels_[k].first, &value));
        if (value < 0) continue;
        if (found >= 0) doubly = static_cast<int>(b);
        found = static_cast<int>(b);
      }
    } else {
      const auto corners = facet_corners(facets[k]);
      for (int d = 0; d < dimension; ++d)
        for (int end = 0; end < 2; ++end) {
          bool all = true;
          for (int a = 0; a < facet_nodes(cell); ++a)
            all = all && std::abs(corners[a][d] - (end ? upper : lower)[d]) < tolerance;
          if (all) found = 2 * d + end;
        }
    }
    nameless += found < 0;
    facets[k].boundary = found;
    if (found >= 0) used[found] = 1;
  }
  const double double_named = mpi_max(doubly);
  if (double_named >= 0)
    throw UserError(fmt::format("the mesh has boundary facets with two names, one of them '{}'",
                                names[static_cast<int>(double_named)]));
  const long long unnamed = mpi_sum(static_cast<long long>(nameless));
  if (unnamed > 0)
    throw UserError(fmt::format("{} facets of the mesh's boundary belong to no physical name; named are: {}", unnamed,
                                fmt::join(names, ", ")));
  if (!names.empty())
    MPI_Allreduce(MPI_IN_PLACE, used.data(), static_cast<int>(used.size()), MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  std::vector<int> renumber(names.size(), -1);
  for (size_t b = 0; b < names.size(); ++b)
    if (used[b]) {
      renumber[b] = static_cast<int>(boundaries.size());
      boundaries.push_back(names[b]);
    }
  for (size_t k = 0; k < facets.size(); ++k) {
    facets[k].boundary = renumber[facets[k].boundary];
    cell_neighbours[facet_labels_[k].second] = -1 - facets[k].boundary;
  }
  facet_labels_.clear();
}

std::array<Vec3, 4> Mesh::facet_corners(const BoundaryFacet& facet) const {
  std::array<Vec3, 4> corners;
  const auto& list = facet_node_list(cell, facet.facet);
  for (int a = 0; a < facet_nodes(cell); ++a)
    corners[a] = vec3(&cell_coordinates[3 * (static_cast<size_t>(facet.cell) * nodes_per_cell + list[a])]);
  return corners;
}

Vec3 Mesh::centre(int local_cell) const {
  Vec3 sum = Vec3::Zero();
  for (int a = 0; a < nodes_per_cell; ++a)
    sum += vec3(&cell_coordinates[3 * (static_cast<size_t>(local_cell) * nodes_per_cell + a)]);
  return sum / nodes_per_cell;
}

}  // namespace silt
