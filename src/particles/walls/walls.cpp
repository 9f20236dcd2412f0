#include "particles/walls/walls.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"

namespace silt {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

std::vector<bool> which_are_walls(const std::vector<WallBoundary>& boundaries) {
  std::vector<bool> result;
  for (const auto& boundary : boundaries) result.push_back(boundary.role == BoundaryRole::wall);
  return result;
}

std::vector<RigidWall> read_rigid_walls(const Surface& domain, Options& options,
                                        const std::vector<std::string>& materials,
                                        const std::vector<std::string>& boundaries, double smooth_angle) {
  std::vector<RigidWall> result;
  for (const auto& name : options.names("wall", Options::declared<RigidWallOptions>())) {
    const std::string prefix = "wall_" + name;
    if (std::find(boundaries.begin(), boundaries.end(), name) != boundaries.end())
      throw UserError(fmt::format("-{}_...: {} is a boundary of the mesh; another name is needed", prefix, name));
    RigidWallOptions chosen;
    options.read(prefix, chosen);
    const int material = wall_material(chosen.material, prefix, options, materials);
    result.emplace_back(name, chosen, domain, material, smooth_angle);
  }
  return result;
}

}  // namespace

Walls::Walls(const Mesh& mesh, Options& options, const std::vector<std::string>& materials)
    : surface_(mesh),
      boundaries_(read_wall_boundaries(mesh, options, materials)),
      names_(mesh.boundaries),
      shifts_(surface_.shifts()) {
  WallOptions chosen;
  options.read("walls", chosen);
  smooth_angle_ = radians(chosen.smooth_angle);
  shape_ = WallShape(surface_, which_are_walls(boundaries_), smooth_angle_);
  for (size_t k = 0; k + 2 < mesh.cell_coordinates.size(); k += 3) home_.add(vec3(&mesh.cell_coordinates[k]));
  rigid_ = read_rigid_walls(surface_, options, materials, mesh.boundaries, smooth_angle_);
  for (const auto& wall : rigid_) names_.push_back(wall.name());
}

int Walls::material(int wall) const {
  const int boundaries = static_cast<int>(boundaries_.size());
  return wall < boundaries ? boundaries_[wall].material : rigid_[wall - boundaries].material();
}

const Expression* Walls::temperature(int wall) const {
  const int boundaries = static_cast<int>(boundaries_.size());
  if (wall >= boundaries) return rigid_[wall - boundaries].temperature();
  const auto& temperature = boundaries_[wall].temperature;
  return temperature ? &*temperature : nullptr;
}

void Walls::localise(double reach) {
  reach_ = reach;
  WallShape near;
  Box box = home_;
  box.grow(reach);
  near.add_near(shape_, shifts_, box);
  local_ = FacetedWall(std::move(near), smooth_angle_);
}

void Walls::list(const Motion* particles, int count, double skin, double gap) {
  gap_ = gap;
  if (shape_.faces.empty() && shape_.edges.empty() && rigid_.empty()) return;
  double largest = 0;
  for (int i = 0; i < count; ++i) largest = std::max(largest, particles[i].radius);
  // The centres stay within a skin of this rank's cells until the list is made anew.
  if (const double reach = largest + gap + 2 * skin; reach > reach_) localise(reach);
  near_.clear();
  items_.clear();
  if (local_.shape().faces.empty() && local_.shape().edges.empty() && rigid_.empty()) return;
  for (auto& wall : rigid_) wall.mark();
  for (int i = 0; i < count; ++i) {
    const Vec3 centre = vec3(particles[i].position);
    int first = static_cast<int>(items_.size());
    local_.near(centre, particles[i].radius + gap + 0.5 * skin, items_);
    if (static_cast<int>(items_.size()) > first) near_.push_back({i, -1, 0, first, static_cast<int>(items_.size())});
    for (int w = 0; w < static_cast<int>(rigid_.size()); ++w) {
      const double reach = particles[i].radius + gap + (rigid_[w].motion().moves() ? 1.0 : 0.5) * skin;
      for (int s = 0; s < static_cast<int>(shifts_.size()); ++s) {
        first = static_cast<int>(items_.size());
        if (rigid_[w].repeats(shifts_[s]) && rigid_[w].near(centre, shifts_[s], reach, items_))
          near_.push_back({i, w, s, first, static_cast<int>(items_.size())});
      }
    }
  }
}

void Walls::points(const Motion* particles, double time, std::vector<WallPoint>& points, double beyond) const {
  points.clear();
  const int boundaries = static_cast<int>(boundaries_.size());
  for (size_t n = 0; n < near_.size();) {
    const int i = near_[n].particle;
    const Vec3 centre = vec3(particles[i].position);
    const double radius = particles[i].radius + gap_ + beyond;
    const size_t first = points.size();
    int rigid = 0;
    for (; n < near_.size() && near_[n].particle == i; ++n) {
      const Near& near = near_[n];
      const size_t before = points.size();
      const int *begin = items_.data() + near.first, *end = items_.data() + near.last;
      if (near.wall < 0) {
        local_.touch(centre, radius, begin, end, points);
        continue;
      }
      const RigidWall& wall = rigid_[near.wall];
      wall.touch(centre, shifts_[near.shift], radius, begin, end, points);
      rigid += points.size() > before;
      for (size_t k = before; k < points.size(); ++k) {
        points[k].boundary = boundaries + near.wall;
        vec3(points[k].shift) = shifts_[near.shift];
      }
    }
    if (rigid > 1) drop_dominated(centre, first, points);
    for (size_t k = first; k < points.size(); ++k) {
      WallPoint& point = points[k];
      point.particle = i;
      const Vec3 place = centre - point.distance * vec3(point.normal);
      if (point.boundary < boundaries) {
        point.material = boundaries_[point.boundary].material;
        vec3(point.velocity) = boundaries_[point.boundary].velocity_at(place, time);
        vec3(point.shift).setZero();
      } else {
        const RigidWall& wall = rigid_[point.boundary - boundaries];
        point.material = wall.material();
        vec3(point.velocity) =
            wall.motion().velocity_at(place - vec3(point.shift));  // an image turns about its own axis
      }
    }
  }
}

void Walls::drop_dominated(const Vec3& centre, size_t first, std::vector<WallPoint>& points) const {
  const int boundaries = static_cast<int>(boundaries_.size());
  std::vector<char> keep(points.size() - first, 1);
  for (size_t k = first; k < points.size(); ++k) {
    if (points[k].boundary < boundaries) continue;
    const double distance = points[k].distance, same = 1e-6 * (distance + 1e-30);
    const Vec3 place = centre - distance * vec3(points[k].normal);
    for (size_t m = first; m < points.size() && keep[k - first]; ++m) {
      if (m == k || points[m].boundary < boundaries || !keep[m - first]) continue;
      const bool alike = (vec3(points[m].normal) - vec3(points[k].normal)).norm() < 1e-6 &&
                         std::abs(points[m].distance - distance) < same;
      if (alike && m < k) keep[k - first] = 0;  // an image of the same wall, or two walls that share an edge
      if (alike || points[m].boundary == points[k].boundary || points[m].distance > distance) continue;
      const RigidWall& other = rigid_[points[m].boundary - boundaries];
      for (const Vec3& shift : shifts_)
        if (other.repeats(shift) && std::abs(other.clearance(place, shift)) < same) keep[k - first] = 0;
    }
  }
  size_t kept = first;
  for (size_t k = first; k < points.size(); ++k)
    if (keep[k - first]) points[kept++] = points[k];
  points.resize(kept);
}

bool Walls::servo() const {
  return std::any_of(rigid_.begin(), rigid_.end(), [](const RigidWall& wall) { return wall.motion().servo(); });
}

void Walls::advance(double time, double h, const std::vector<Vec3>& force) {
  for (size_t w = 0; w < rigid_.size(); ++w) rigid_[w].motion().advance(time, h, force[boundaries_.size() + w]);
}

void Walls::pose(double time) {
  for (auto& wall : rigid_) wall.motion().pose(time);
}

double Walls::moved() const {
  double most = 0;
  for (const auto& wall : rigid_) most = std::max(most, wall.moved());
  return most;
}

std::vector<WallMotion::State> Walls::states() const {
  std::vector<WallMotion::State> states;
  for (const auto& wall : rigid_) states.push_back(wall.motion().state());
  return states;
}

void Walls::set_states(const std::vector<WallMotion::State>& states) {
  for (size_t w = 0; w < rigid_.size() && w < states.size(); ++w) rigid_[w].motion().set_state(states[w]);
}

double Walls::clearance(const Vec3& x) const {
  double least = infinity;
  for (const auto& wall : rigid_)
    for (const Vec3& shift : shifts_)
      if (wall.repeats(shift)) least = std::min(least, wall.clearance(x, shift));
  return least;
}

}  // namespace silt
