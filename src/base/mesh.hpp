#pragma once
#include <string>
#include <vector>

#include "base/element.hpp"
#include "base/options.hpp"
#include "base/petsc.hpp"
#include "base/vector.hpp"

namespace silt {

/// The options `-mesh_...`: a box or a Gmsh file.
struct MeshOptions {
  std::string type = "box";
  InputFile file;
  std::string cell = "hexahedron";
  Vec3 lower = Vec3::Zero(), upper = Vec3::Ones();
  std::vector<int> cells = {8, 8, 8};
  std::vector<int> periodic = {0, 0, 0};
  double scale = 1;
  std::string weight = "1";
  MeshOptions() = default;
  /// Reads `-mesh_...`. Throws UserError for what has no meaning with the type chosen.
  explicit MeshOptions(Options& options);
  void options(OptionGroup& option);
};

/// What decides the partition of a mesh besides `-mesh_weight`: where the work of a run is, or who had which cell.
struct Partition {
  std::vector<Vec3> points;                 ///< m, of particles, the same on every rank
  double particle_cost = 0, cell_cost = 1;  ///< cost of a particle and of a cell, in any unit
  std::vector<Vec3> cells;                  ///< m, centres of cells whose rank is given, the same on every rank
  std::vector<int> ranks;                   ///< of each of them; empty: to be found
};

/// One facet of the domain's boundary, owned by the rank that owns its cell.
struct BoundaryFacet {
  int cell;      ///< local cell
  int facet;     ///< facet of that cell (element.hpp)
  int boundary;  ///< index into Mesh::boundaries
};

/// The distributed mesh: a DMPlex without overlap, and the arrays that element and particle loops run over.
///
/// Nodes are the vertices. Local nodes 0..owned_nodes-1 are owned by this rank, the rest belong to other ranks; node i
/// owned here has the global number first_node + i. A rank may own no cell and no node. Coordinates have three
/// components also in 2D (z = 0). On a periodic mesh a node stands for several places: geometry is per cell
/// (cell_coordinates), node_coordinates holds one of them.
class Mesh {
 public:
  /// Creates, distributes (PTScotch) and checks the mesh; throws UserError for a bad file or option. Collective.
  Mesh(const MeshOptions& options, const Partition& partition = {});
  /// Mean of the corners of a local cell. m
  Vec3 centre(int local_cell) const;

  DM plex() const { return plex_; }

  int dimension = 3;
  Cell cell = Cell::hexahedron;
  int nodes_per_cell = 8;
  int facets_per_cell = 6;

  int cells = 0;                         ///< local cells
  long long total_cells = 0;             ///< on all ranks
  std::vector<int> cell_nodes;           ///< [cells][nodes_per_cell] local nodes
  std::vector<double> cell_coordinates;  ///< [cells][nodes_per_cell][3] m
  std::vector<int>
      cell_neighbours;  ///< [cells][facets_per_cell] local cell; -1 - b: boundary b; remote_cell: on another rank
  std::vector<int> facet_ranks;  ///< [cells][facets_per_cell] rank on the other side of a remote facet, else -1
  static constexpr int remote_cell = -1000000;
  std::vector<double> cell_volumes;  ///< [cells] m3 (m2 in 2D)

  int nodes = 0, owned_nodes = 0;
  long long first_node = 0, total_nodes = 0;
  std::vector<long long> node_global;    ///< [nodes] global number
  std::vector<double> node_coordinates;  ///< [nodes][3] m

  std::vector<std::string>
      boundaries;  ///< names, the same on every rank: x_min ... for boxes, Gmsh's physical names for files
  std::vector<BoundaryFacet> facets;  ///< boundary facets of local cells

  Vec3 lower, upper;  ///< bounding box of the whole mesh
  std::array<bool, 3> periodic{false, false, false};
  double smallest_edge = 0, volume = 0;  ///< over all ranks

  /// Corner coordinates of a boundary facet, facet_nodes(cell) of them, ordered outwards.
  std::array<Vec3, 4> facet_corners(const BoundaryFacet& facet) const;

  /// Adds up the contributions of all ranks to shared nodes; every rank then holds the sum. values[nodes][components].
  /// Collective.
  void sum_shared(double* values, int components) const;
  /// Copies the owner's value to the other ranks' copies. Collective.
  void copy_from_owner(double* values, int components) const;
  /// Sum of a[i]*b[i] over owned nodes and all ranks.
  double dot(const double* a, const double* b, int components) const;

 private:
  void create(const MeshOptions& options, const Partition& partition);
  void weigh(const std::string& weight, const Partition& partition, double scale);
  void assign(const Partition& partition, double scale);
  void extract();
  void extract_boundaries();

  DmHandle plex_;
  SfHandle node_exchange_;
  std::vector<std::pair<int, int>> facet_labels_;
};

}  // namespace silt
