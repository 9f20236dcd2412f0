#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "particles/contact.hpp"
#include "particles/walls/faceted_wall.hpp"
#include "particles/walls/rigid_wall.hpp"
#include "particles/walls/wall_boundary.hpp"

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

/// The mesh's boundary and the rigid walls, as the particles meet them.
///
/// A sphere touches a wall at the local minima of its distance from the centre: inside faces, on convex edges, at
/// convex vertices, each of them counted once however many facets share it; coplanar facets are one face, and flat or
/// concave edges are never felt. Of several points on one smooth wall (facets joined by edges of less than
/// `smooth_angle`) whose normals differ by less than twice that angle, only the deepest is kept, so that a curved wall
/// does not get stiffer when its mesh is refined: the energy of the contact stays a continuous function of the centre.
class Walls {
 public:
  /// Reads `-walls_...`, `-boundary_<name>_particles|material|velocity` and every `-wall_<name>_...`; `materials` are
  /// the names by index. Collective.
  Walls(const Mesh& mesh, Options& options, const std::vector<std::string>& materials);

  const std::vector<WallBoundary>& boundaries() const { return boundaries_; }
  BoundaryRole role(int boundary) const { return boundaries_[boundary].role; }
  /// Whether all boundaries of the mesh are walls.
  bool closed() const {
    return std::all_of(boundaries_.begin(), boundaries_.end(),
                       [](const auto& boundary) { return boundary.role == BoundaryRole::wall; });
  }
  const Surface& surface() const { return surface_; }
  const WallShape& shape() const { return shape_; }

  /// All walls by the number that stands in WallPoint::boundary: the boundaries of the mesh, then the rigid walls.
  int count() const { return static_cast<int>(names_.size()); }
  const std::string& name(int wall) const { return names_[wall]; }
  int material(int wall) const;
  /// K, of a wall that conducts heat; null: it does not.
  const Expression* temperature(int wall) const;
  const std::vector<RigidWall>& rigid() const { return rigid_; }

  /// Remembers which of the particles may come within `gap` of a wall before having moved `skin`/2, and moved() being
  /// below that too. Local.
  void list(const Motion* particles, int count, double skin, double gap = 0);
  /// The points of walls nearer to each particle than its radius and the gap of list(), ordered by particle; replaces
  /// `points`. With `beyond` (m) also those further by that much, as far as they are listed. Local.
  void points(const Motion* particles, double time, std::vector<WallPoint>& points, double beyond = 0) const;

  /// Whether any wall is driven by the force on it.
  bool servo() const;
  /// Moves the rigid walls from time to time + h; `force`: what each wall exerts on all particles (N), needed where
  /// servo().
  void advance(double time, double h, const std::vector<Vec3>& force);
  /// Brings the rigid walls to where they are at this time.
  void pose(double time);
  /// The longest way of a wall's shape since list(). m
  double moved() const;
  /// What a restart needs of the rigid walls' motions.
  std::vector<WallMotion::State> states() const;
  void set_states(const std::vector<WallMotion::State>& states);

  /// Distance from the nearest rigid wall, negative behind one. m
  double clearance(const Vec3& x) const;

 private:
  /// Copies what the particles of this rank can reach, periodic images included.
  void localise(double reach);
  /// Where two rigid walls meet, an end of one on the other is felt only if the other is not nearer.
  void drop_dominated(const Vec3& centre, size_t first, std::vector<WallPoint>& points) const;

  /// A wall that a particle may touch: the mesh's boundary (-1) or a rigid wall, with the items of faceted ones.
  struct Near {
    int particle, wall, shift, first, last;
  };

  Surface surface_;
  std::vector<WallBoundary> boundaries_;
  std::vector<std::string> names_;
  double smooth_angle_ = 0;  ///< rad
  WallShape shape_;
  FacetedWall local_;
  Box home_;           ///< of this rank's cells
  double reach_ = -1;  ///< m, how far from home_ local_ holds
  double gap_ = 0;     ///< m, how far from its surface a particle feels a wall
  std::vector<RigidWall> rigid_;
  std::vector<Vec3> shifts_;
  std::vector<Near> near_;
  std::vector<int> items_;
};

}  // namespace silt
