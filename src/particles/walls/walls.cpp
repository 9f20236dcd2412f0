#include "particles/walls/walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace silt {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

std::vector<bool> which_are_walls(const std::vector<WallBoundary>& boundaries) {
  std::vector<bool> result;
  for (const auto& boundary : boundaries) result.push_back(boundary.role == BoundaryRole::wall);
  return result;
}

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

Walls::Walls(const Mesh& mesh, Options& options, const std::vector<std::string>& materials)
    : surface_(mesh), boundaries_(read_wall_boundaries(mesh, options, materials)) {
  WallOptions chosen;
  options.read("walls", chosen);
  const double smooth = radians(chosen.smooth_angle);
  shape_ = WallShape(surface_, which_are_walls(boundaries_), smooth);
  merge_cosine_ = std::cos(2 * smooth + 1e-6);
  for (size_t k = 0; k + 2 < mesh.cell_coordinates.size(); k += 3) home_.add(vec3(&mesh.cell_coordinates[k]));
}

void Walls::localise(double reach) {
  reach_ = reach;
  local_ = WallShape();
  Box box = home_;
  box.grow(reach);
  local_.add_near(shape_, surface_.shifts(), box);
  std::vector<Box> boxes;
  for (const auto& face : local_.faces) boxes.push_back(face.box);
  for (const auto& edge : local_.edges) boxes.push_back(edge.box);
  tree_ = BoxTree(boxes);
}

void Walls::list(const Motion* particles, int count, double skin) {
  double largest = 0;
  for (int i = 0; i < count; ++i) largest = std::max(largest, particles[i].radius);
  // The centres stay within a skin of this rank's cells until the list is made anew.
  if (const double reach = largest + 2 * skin; reach > reach_) localise(reach);
  near_.clear();
  items_.clear();
  const int faces = static_cast<int>(local_.faces.size());
  for (int i = 0; i < count; ++i) {
    const Vec3 centre = vec3(particles[i].position);
    const double reach = particles[i].radius + 0.5 * skin;
    const int first = static_cast<int>(items_.size());
    tree_.within(centre, reach, [&](int item) {
      if (item < faces ? within_face(local_.faces[item], &local_.sides[local_.faces[item].first_side], centre, reach)
                       : within_edge(local_.edges[item - faces], centre, reach))
        items_.push_back(item);
    });
    const int last = static_cast<int>(items_.size());
    if (last == first) continue;
    std::sort(items_.begin() + first, items_.end());
    const auto edges = std::lower_bound(items_.begin() + first, items_.end(), faces);
    near_.push_back({i, first, static_cast<int>(edges - items_.begin()), last});
    for (auto item = edges; item != items_.end(); ++item) *item -= faces;
  }
}

void Walls::points(const Motion* particles, double time, std::vector<WallPoint>& points) const {
  points.clear();
  for (const Near& near : near_) {
    const Motion& particle = particles[near.particle];
    const size_t first = points.size();
    groups_.clear();
    for (int k = near.first; k < near.faces; ++k) touch_face(local_.faces[items_[k]], particle, points);
    for (int k = near.faces; k < near.last; ++k) touch_edge(local_.edges[items_[k]], particle, first, points);
    if (points.size() - first > 1) merge_smooth(first, points);
    for (size_t k = first; k < points.size(); ++k) {
      WallPoint& point = points[k];
      const WallBoundary& boundary = boundaries_[point.boundary];
      point.particle = near.particle;
      point.material = boundary.material;
      const Vec3 place = vec3(particle.position) - point.distance * vec3(point.normal);
      vec3(point.velocity) = boundary.velocity_at(place, time);
    }
  }
}

void Walls::touch_face(const WallFace& face, const Motion& particle, std::vector<WallPoint>& points) const {
  const Vec3 centre = vec3(particle.position);
  const double gap = face.normal.dot(centre) - face.offset;
  // A centre behind the face is not inside the domain here: the face belongs to another side of a thin wall.
  if (gap >= particle.radius || gap < 0) return;
  const WallSide* sides = &local_.sides[face.first_side];
  for (int s = 0; s < face.sides; ++s)
    if (sides[s].inward.dot(centre) - sides[s].offset < -local_.tolerance) return;
  WallPoint point;
  point.boundary = face.boundary;
  point.distance = gap;
  vec3(point.normal) = face.normal;
  points.push_back(point);
  groups_.push_back(face.group);
}

void Walls::touch_edge(const WallEdge& edge, const Motion& particle, size_t first,
                       std::vector<WallPoint>& points) const {
  const Vec3 from_start = vec3(particle.position) - edge.start;
  const double along = edge.direction.dot(from_start);
  if (along < -local_.tolerance || along > edge.length + local_.tolerance) return;
  const Vec3 arm = from_start - along * edge.direction;
  const double squared = arm.squaredNorm();
  if (squared >= particle.radius * particle.radius || squared == 0 || arm.dot(edge.outside) < 0) return;
  for (int r = edge.first_ray; r < edge.first_ray + edge.rays; ++r)
    if (arm.dot(local_.rays[r]) > local_.tolerance) return;
  WallPoint point;
  point.boundary = edge.boundary;
  point.distance = std::sqrt(squared);
  vec3(point.normal) = arm / point.distance;
  // Just where a face ends and its edge begins, round-off may give both: they are the same point.
  const double same = 1e-6 * particle.radius + 4 * local_.tolerance;
  for (size_t k = first; k < points.size(); ++k)
    if ((points[k].distance * vec3(points[k].normal) - arm).norm() < same) return;
  points.push_back(point);
  groups_.push_back(edge.group);
}

void Walls::merge_smooth(size_t first, std::vector<WallPoint>& points) const {
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
