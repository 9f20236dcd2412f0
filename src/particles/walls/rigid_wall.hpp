#pragma once
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/expression.hpp"
#include "particles/insertion/room.hpp"
#include "particles/walls/faceted_wall.hpp"
#include "particles/walls/rigid_wall_options.hpp"
#include "particles/walls/smooth_shapes.hpp"
#include "particles/walls/wall_motion.hpp"

namespace silt {

/// A shape made of facets: a box or an STL surface.
struct FacetShape {
  std::shared_ptr<const Surface> surface;
  std::shared_ptr<const Room> room;  ///< distances, for insertions
  FacetedWall wall;
  bool both = false;
  Box box;
  double clearance(const Vec3& x) const;
};

/// A wall that is no boundary of the mesh (`-wall_<name>_...`): a plane, box, cylinder, cone, sphere, surface of
/// revolution or STL surface of one material, at rest or in rigid motion. All ranks hold all of it.
class RigidWall {
 public:
  /// Reads and checks the options; `domain` is the mesh's surface, whose periods the wall shares. Throws UserError, the
  /// same on every rank. Collective.
  RigidWall(const std::string& name, const RigidWallOptions& options, const Surface& domain, int material,
            double smooth_angle);

  const std::string& name() const { return name_; }
  int material() const { return material_; }
  /// K; null: it conducts no heat.
  const Expression* temperature() const { return temperature_ ? &*temperature_ : nullptr; }
  WallMotion& motion() { return motion_; }
  const WallMotion& motion() const { return motion_; }
  /// The point that torques are about: the centre of rotation where it is now.
  Vec3 reference() const { return motion_.centre() + motion_.shift(); }

  /// Remembers the present pose, for moved().
  void mark() { marked_ = motion_.present(); }
  /// The longest way that a point of the domain would have gone with the wall since mark(), as far as its shape shows.
  /// m
  double moved() const;

  /// Whether a sphere whose centre stays within `reach` of here may touch the wall; for faceted ones the items are
  /// appended. `shift`: the period by which the wall is repeated.
  bool near(const Vec3& centre, const Vec3& shift, double reach, std::vector<int>& items) const;
  /// Appends the points nearer than the radius, in present coordinates (no velocity yet).
  void touch(const Vec3& centre, const Vec3& shift, double radius, const int* first, const int* last,
             std::vector<WallPoint>& points) const;
  /// Distance of a point from the wall, negative behind it; in present coordinates. m
  double clearance(const Vec3& x, const Vec3& shift) const;
  /// Whether it is repeated by this period of the domain: what has no ends in that direction is not.
  bool repeats(const Vec3& shift) const;

 private:
  Vec3 to_shape(const Vec3& x) const { return still_shape_ ? motion_.to_start_unturned(x) : motion_.to_start(x); }

  std::string name_;
  int material_;
  std::optional<Expression> temperature_;
  std::variant<PlaneShape, SphereShape, RevolutionShape, FacetShape> shape_;
  bool still_shape_ = false;  ///< its rotation leaves the shape as it is
  bool endless_ = false;
  Vec3 lower_, upper_;  ///< of the domain
  WallMotion motion_;
  WallMotion::Pose marked_;
};

}  // namespace silt
