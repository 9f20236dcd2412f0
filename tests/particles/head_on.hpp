#pragma once
#include <cmath>

#include "gas_box.hpp"

namespace silt {

/// Two equal spheres of radius R that meet head on in the middle of a large box.
struct HeadOn {
  double restitution = 0, duration = 0, largest_overlap = 0;
};
inline HeadOn head_on(BoxCase setup, double radius, double speed, double gap, double dt) {
  const double span = 40 * radius;
  setup.box(Vec3::Constant(-span / 2), Vec3::Constant(span / 2));
  BoxRun run(setup);
  const Vec3 normal = Vec3(2, 1, 2) / 3;
  run.particles.add({sphere(-(radius + gap / 2) * normal, speed * normal, radius),
                     sphere((radius + gap / 2) * normal, -speed * normal, radius)});
  HeadOn result;
  const auto separation = [&] {
    const auto state = gather(run.particles);
    return (vec3(state.at(0).x) - vec3(state.at(1).x)).norm() - 2 * radius;
  };
  double before = separation(), begin = gap <= 0 ? 0 : -1, end = -1;
  for (int n = 0; end < 0 && n < 100000; ++n) {
    run.particles.advance(n * dt, dt);
    const double now = separation();
    // The instants at which the surfaces touch and part, by linear interpolation (speeds hardly change there).
    if (begin < 0 && now < 0) begin = (n + before / (before - now)) * dt;
    if (begin >= 0 && now >= 0) end = (n + before / (before - now)) * dt;
    result.largest_overlap = std::max(result.largest_overlap, -now);
    before = now;
  }
  run.particles.advance(0, 2 * dt);
  const auto state = gather(run.particles);
  result.duration = end - begin;
  result.restitution = (vec3(state.at(1).v) - vec3(state.at(0).v)).dot(normal) / (2 * speed);
  return result;
}

}  // namespace silt
