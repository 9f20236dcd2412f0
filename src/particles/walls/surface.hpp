#pragma once
#include <array>
#include <vector>

#include "base/mesh.hpp"
#include "base/vector.hpp"

namespace silt {

/// One planar facet of the mesh's boundary as the particles see it: `normal` points into the domain.
struct SurfaceFacet {
  std::array<Vec3, 4> corner;  ///< m, anticlockwise seen from outside the domain
  int corners = 3;
  int boundary = 0;           ///< index into Mesh::boundaries
  std::array<int, 4> edge;    ///< edge k joins corners k and k + 1; -1 for the far ends of an extruded 2D facet
  std::array<int, 4> vertex;  ///< -1 in 2D
  Vec3 normal;
  int patch = -1;  ///< coplanar connected facets of one boundary share a patch
  Vec3 start(int k) const { return corner[k]; }
  Vec3 end(int k) const { return corner[k + 1 == corners ? 0 : k + 1]; }
};

/// A plane that a patch of facets lies in; normal into the domain.
struct Patch {
  Vec3 normal;
  double offset;  ///< normal . x on the plane, m
  std::vector<int> facets;
};

/// The boundary of the whole mesh on every rank, the same whatever the partition: facets as planar polygons
/// (quadrilaterals that are not planar are split, facets of a 2D mesh are extruded far along z), joined by edges and
/// vertices that are also joined across periodic sides, and gathered into coplanar patches.
class Surface {
 public:
  /// Gathers the facets of all ranks. Collective.
  explicit Surface(const Mesh& mesh);
  /// A surface of given facets (corners, number of corners and boundary set, in the same order on every rank) in a
  /// domain; `round_off`: relative error of the coordinates.
  Surface(std::vector<SurfaceFacet> facets, const Vec3& lower, const Vec3& upper, const std::array<bool, 3>& periodic,
          double round_off);

  int dimension;
  Vec3 lower, upper;  ///< m, bounding box of the mesh
  std::array<bool, 3> periodic;
  double tolerance;  ///< m, lengths below it count as round-off
  std::vector<SurfaceFacet> facets;
  std::vector<Patch> patches;
  /// Of every edge: {facet, its k}. Two facets, the wedge between which lies in the domain; where more meet (a wall
  /// without thickness, blocks that touch along a line) every wedge has an edge of its own.
  std::vector<std::vector<std::array<int, 2>>> edge_facets;
  std::vector<std::vector<std::array<int, 2>>> vertex_facets;  ///< of every vertex: {facet, its corner}

  /// In-plane unit vector from edge k of a facet into the facet, in the plane of its patch.
  Vec3 into_facet(int facet, int k) const;
  /// Translations by which a periodic domain repeats, the zero one first: 1, 3, 9 or 27.
  std::vector<Vec3> shifts() const;

 private:
  void gather(const Mesh& mesh);
  void connect();
  void split_edges();
  void grow_patches();
};

}  // namespace silt
