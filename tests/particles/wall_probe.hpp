#pragma once
#include <algorithm>
#include <vector>

#include "particles/walls/walls.hpp"

namespace silt::test {

inline Motion sphere(const Vec3& centre, double radius) {
  Motion motion{};
  vec3(motion.position) = centre;
  motion.radius = radius;
  motion.inverse_mass = 1;
  return motion;
}

/// The points at which one sphere touches the walls.
inline std::vector<WallPoint> touches(Walls& walls, const Vec3& centre, double radius, double time = 0) {
  const Motion motion = sphere(centre, radius);
  std::vector<WallPoint> points;
  walls.list(&motion, 1, 0.2 * radius);
  walls.points(&motion, time, points);
  return points;
}

/// On one rank only the facets near this rank's cells are known: tests of single spheres run serially.
inline Walls walls_of(const Mesh& mesh, Options options = {}) { return Walls(mesh, options, {"steel"}); }

}  // namespace silt::test
