#pragma once
#include <cmath>

#include "law_cases.hpp"
#include "reference_path.hpp"

namespace silt {

/// What a normal impact of two bodies does, by velocity Verlet on the law itself.
struct Impact {
  double restitution = 0;
  double duration = 0;  ///< s, while a force acts
  double largest_overlap = 0, largest_force = 0;
  double residual = 0;  ///< m, overlap at which the force vanishes on the way out
};
inline Impact impact(const LawRun& run, double mass, double radius, double speed, double dt) {
  const PairProperties& pair = run.materials.pair(0, 0);
  std::vector<double> history(run.laws.history_components() + 1);
  Contact<double> contact{};
  contact.normal[2] = 1;
  contact.effective_mass = mass, contact.effective_radius = radius, contact.radius = radius;
  double x = 0, v = speed, force = 0;
  const auto evaluate = [&] {
    contact.overlap = x, contact.approach = v, contact.distance = radius - x;
    with_law(run.laws.normal(), run.laws.setup().normal, pair, history.data(),
             [&](const auto& model, const auto& c, auto& memory) {
               const auto load = std::decay_t<decltype(model)>::template load<double>(contact, c, memory);
               force = load.force + load.jump;
             });
  };
  evaluate();
  contact.dt = dt;
  Impact result;
  for (int n = 0; n < 10000000; ++n) {
    const double before = force;
    x += dt * v - 0.5 * dt * dt * force / mass;
    v -= dt * force / mass;
    evaluate();
    v -= 0.5 * dt * (force - before) / mass;
    result.largest_overlap = std::max(result.largest_overlap, x);
    result.largest_force = std::max(result.largest_force, force);
    if (v < 0 && (x <= 0 || force == 0)) {
      result.restitution = -v / speed;
      result.duration = (n + 1) * dt;
      result.residual = x;
      return result;
    }
  }
  return result;
}

}  // namespace silt
