#pragma once
#include <vector>

#include "particles/contact.hpp"
#include "particles/walls/box_tree.hpp"
#include "particles/walls/wall_shape.hpp"

namespace silt {

/// Faces, convex edges and convex vertices of a wall, and the points at which a sphere touches them.
class FacetedWall {
 public:
  FacetedWall() = default;
  /// `smooth_angle`: where the wall turns by less than this it is one smooth wall (rad).
  FacetedWall(WallShape shape, double smooth_angle);

  const WallShape& shape() const { return shape_; }

  /// Appends the items that a sphere may touch whose centre stays within `reach` of them, in ascending order.
  void near(const Vec3& centre, double reach, std::vector<int>& items) const;
  /// Appends the points nearer than `radius` to the centre among items [first, last) as near() gave them: their
  /// boundary, distance and normal. The points of one smooth wall that belong to one touch are one point.
  void touch(const Vec3& centre, double radius, const int* first, const int* last,
             std::vector<WallPoint>& points) const;

 private:
  void touch_face(const WallFace& face, const Vec3& centre, double radius, size_t first,
                  std::vector<WallPoint>& points) const;
  void touch_edge(const WallEdge& edge, const Vec3& centre, double radius, size_t first,
                  std::vector<WallPoint>& points) const;
  bool known(const Vec3& arm, double radius, size_t first, const std::vector<WallPoint>& points) const;
  void merge_smooth(size_t first, std::vector<WallPoint>& points) const;

  WallShape shape_;
  BoxTree tree_;
  double merge_cosine_ = 1;
  mutable std::vector<int> groups_;  ///< of the points of the sphere at hand
};

}  // namespace silt
