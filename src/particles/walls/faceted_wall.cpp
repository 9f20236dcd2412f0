#include "particles/walls/faceted_wall.hpp"

#include <algorithm>
#include <cmath>

namespace silt {
namespace {

/// Whether a centre may come within `reach` of the face; never false when it may.
bool within_face(const WallFace& face, const WallSide* sides, const Vec3& centre, double reach) {
  if (std::abs(face.normal.dot(centre) - face.offset) > reach) return false;
  for (int s = 0; s < face.sides; ++s)
    if (sides[s].inward.dot(centre) - sides[s].offset < -reach) return false;
  return true;
}

bool within_edge(const WallEdge& edge, const Vec3& centre, double reach) {
  const double s = std::clamp(edge.direction.dot(centre - edge.start), 0.0, edge.length);
  return (centre - edge.start - s * edge.direction).squaredNorm() <= reach * reach;
}

}  // namespace

FacetedWall::FacetedWall(WallShape shape, double smooth_angle)
    : shape_(std::move(shape)), merge_cosine_(std::cos(2 * smooth_angle + 1e-6)) {
  std::vector<Box> boxes;
  for (const auto& face : shape_.faces) boxes.push_back(face.box);
  for (const auto& edge : shape_.edges) boxes.push_back(edge.box);
  tree_ = BoxTree(boxes);
}

void FacetedWall::near(const Vec3& centre, double reach, std::vector<int>& items) const {
  const auto first = static_cast<std::ptrdiff_t>(items.size());
  const int faces = static_cast<int>(shape_.faces.size());
  tree_.within(centre, reach, [&](int item) {
    if (item < faces ? within_face(shape_.faces[item], &shape_.sides[shape_.faces[item].first_side], centre, reach)
                     : within_edge(shape_.edges[item - faces], centre, reach))
      items.push_back(item);
  });
  std::sort(items.begin() + first, items.end());
}

void FacetedWall::touch(const Vec3& centre, double radius, const int* first, const int* last,
                        std::vector<WallPoint>& points) const {
  const size_t before = points.size();
  const int faces = static_cast<int>(shape_.faces.size());
  groups_.clear();
  for (; first != last; ++first)
    if (*first < faces)
      touch_face(shape_.faces[*first], centre, radius, before, points);
    else
      touch_edge(shape_.edges[*first - faces], centre, radius, before, points);
  if (points.size() - before > 1) merge_smooth(before, points);
}

/// Just where a face ends and another, or its edge, begins, round-off may give both: they are the same point.
bool FacetedWall::known(const Vec3& arm, double radius, size_t first, const std::vector<WallPoint>& points) const {
  const double same = 1e-6 * radius + 4 * shape_.tolerance;
  for (size_t k = first; k < points.size(); ++k)
    if ((points[k].distance * vec3(points[k].normal) - arm).squaredNorm() < same * same) return true;
  return false;
}

void FacetedWall::touch_face(const WallFace& face, const Vec3& centre, double radius, size_t first,
                             std::vector<WallPoint>& points) const {
  const double gap = face.normal.dot(centre) - face.offset;
  // A centre behind the face is not inside the domain here: the face belongs to another side of a thin wall.
  if (gap >= radius || gap < 0) return;
  const WallSide* sides = &shape_.sides[face.first_side];
  for (int s = 0; s < face.sides; ++s)
    if (sides[s].inward.dot(centre) - sides[s].offset < -shape_.tolerance) return;
  if (points.size() > first && known(gap * face.normal, radius, first, points)) return;
  WallPoint point;
  point.boundary = face.boundary;
  point.distance = gap;
  vec3(point.normal) = face.normal;
  points.push_back(point);
  groups_.push_back(face.group);
}

void FacetedWall::touch_edge(const WallEdge& edge, const Vec3& centre, double radius, size_t first,
                             std::vector<WallPoint>& points) const {
  const Vec3 from_start = centre - edge.start;
  const double along = edge.direction.dot(from_start);
  if (along < -shape_.tolerance || along > edge.length + shape_.tolerance) return;
  const Vec3 arm = from_start - along * edge.direction;
  const double squared = arm.squaredNorm();
  if (squared >= radius * radius || squared == 0 || arm.dot(edge.outside) < 0) return;
  for (int r = edge.first_ray; r < edge.first_ray + edge.rays; ++r)
    if (arm.dot(shape_.rays[r]) > shape_.tolerance) return;
  if (known(arm, radius, first, points)) return;
  WallPoint point;
  point.boundary = edge.boundary;
  point.distance = std::sqrt(squared);
  vec3(point.normal) = arm / point.distance;
  points.push_back(point);
  groups_.push_back(edge.group);
}

void FacetedWall::merge_smooth(size_t first, std::vector<WallPoint>& points) const {
  const size_t count = points.size() - first;
  WallPoint* found = &points[first];
  size_t kept = 0;
  // A point is dropped when a nearer one of the same smooth wall stands for it; ties go to the earlier one.
  for (size_t k = 0; k < count; ++k) {
    bool drop = false;
    for (size_t m = 0; m < count && !drop; ++m) {
      if (m == k || groups_[m] != groups_[k] || groups_[k] < 0) continue;
      if (found[m].distance > found[k].distance || (found[m].distance == found[k].distance && m > k)) continue;
      drop = vec3(found[m].normal).dot(vec3(found[k].normal)) > merge_cosine_;
    }
    found[k].particle = drop ? -1 : 0;
  }
  for (size_t k = 0; k < count; ++k)
    if (found[k].particle == 0) found[kept++] = found[k];
  points.resize(first + kept);
}

}  // namespace silt
