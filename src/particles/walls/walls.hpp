#pragma once
#include <string>
#include <vector>

#include "particles/contact.hpp"
#include "particles/walls/wall_boundary.hpp"
#include "particles/walls/wall_shape.hpp"

namespace silt {

/// The options `-walls_...`.
struct WallOptions {
  double smooth_angle = 15;
  void options(OptionGroup& option) {
    option("smooth_angle", smooth_angle, "degrees",
           "where the boundary turns by less than this it is taken for one smooth wall: a particle touches it once",
           between(0, 45));
  }
};

/// The mesh's boundary as walls for the particles.
///
/// A sphere touches a wall at the local minima of its distance from the centre: inside faces, on convex edges, at
/// convex vertices, each of them counted once however many facets share it; coplanar facets are one face, and flat or
/// concave edges are never felt. Of several points on one smooth wall (facets joined by edges of less than
/// `smooth_angle`) whose normals differ by less than twice that angle, only the deepest is kept, so that a curved wall
/// does not get stiffer when its mesh is refined: the energy of the contact stays a continuous function of the centre.
class Walls {
 public:
  /// Reads `-walls_...` and `-boundary_<name>_particles|material|velocity`; `materials` are the names by index.
  /// Collective.
  Walls(const Mesh& mesh, Options& options, const std::vector<std::string>& materials);

  const std::vector<WallBoundary>& boundaries() const { return boundaries_; }
  BoundaryRole role(int boundary) const { return boundaries_[boundary].role; }
  const Surface& surface() const { return surface_; }
  const WallShape& shape() const { return shape_; }

  /// Remembers which of the particles may touch a wall before having moved `skin`/2. Local.
  void list(const Motion* particles, int count, double skin);
  /// The points of walls nearer than the radius to each particle, ordered by particle; replaces `points`. Local.
  void points(const Motion* particles, double time, std::vector<WallPoint>& points) const;

 private:
  /// Copies what the particles of this rank can reach, periodic images included.
  void localise(double reach);
  void touch_face(const WallFace& face, const Motion& particle, std::vector<WallPoint>& points) const;
  void touch_edge(const WallEdge& edge, const Motion& particle, size_t first, std::vector<WallPoint>& points) const;
  void merge_smooth(size_t first, std::vector<WallPoint>& points) const;

  struct Near {
    int particle, first, faces, last;  ///< items first..faces are faces, faces..last edges
  };

  Surface surface_;
  std::vector<WallBoundary> boundaries_;
  WallShape shape_, local_;
  BoxTree tree_;
  Box home_;           ///< of this rank's cells
  double reach_ = -1;  ///< m, how far from home_ local_ holds
  double merge_cosine_ = 1;
  std::vector<Near> near_;
  std::vector<int> items_;
  mutable std::vector<int> groups_;  ///< of the points of the particle at hand
};

}  // namespace silt
