// How the fluid acts in the substeps: drag integrated exactly, every other fluid force constant.
#include <cmath>

#include "particles/engine.hpp"

namespace silt {

void Engine::prepare_fluid(double h) {
  bool acts = false, turns = false;
  for (const auto& action : store.action) {
    turns |= action.spin_exchange != 0;
    acts |= action.exchange != 0 || action.added_mass != 0 || action.force[0] != 0 || action.force[1] != 0 ||
            action.force[2] != 0;
  }
  turning_ = mpi_any(turns);
  fluid_ = mpi_any(acts) || turning_;
  if (!fluid_) return;
  store.drag.reserve(store.owned);
  for (int p = 0; p < store.owned; ++p) {
    const FluidAction& action = store.action[p];
    DragStep step{};
    for (int d = 0; d < 3; ++d) {
      step.velocity[d] = action.velocity[d];
      step.acceleration[d] = action.force[d] * store.motion[p].inverse_mass;
    }
    step.share = 1 / (1 + action.added_mass * store.motion[p].inverse_mass);
    step.rate = action.exchange * store.motion[p].inverse_mass * step.share;
    const double z = step.rate * h;
    // phi = (1 - exp(-z))/rate, psi = (h - phi)/rate; their series where the differences would lose digits.
    step.first = z > 0 ? -std::expm1(-z) / step.rate : h;
    step.second = z > 1e-2
                      ? (h - step.first) / step.rate
                      : h * h * (0.5 - z * (1.0 / 6 - z * (1.0 / 24 - z * (1.0 / 120 - z * (1.0 / 720 - z / 5040)))));
    step.corrector = step.second / h;
    if (options_.late_share() == 0) step.second = h * step.first;
    if (brownian_.overdamped() && step.rate > 0) {  // without inertia: v = u + F/k at once
      step.first = step.corrector = 1 / step.rate;
      step.second = h / step.rate;
    }
    store.drag[p] = step;
  }
  if (turning_) prepare_turning(h);
}

void Engine::prepare_turning(double h) {
  store.turning.reserve(store.owned);
  for (int p = 0; p < store.owned; ++p) {
    const FluidAction& action = store.action[p];
    const Motion& motion = store.motion[p];
    TurnStep step{};
    for (int d = 0; d < 3; ++d) step.spin[d] = action.spin[d];
    step.rate = action.spin_exchange * 2.5 * motion.inverse_mass / (motion.radius * motion.radius);
    const double z = step.rate * h;
    step.first = z > 0 ? -std::expm1(-z) / step.rate : h;
    step.corrector = z > 1e-2 ? (1 - step.first / h) / step.rate
                              : h * (0.5 - z * (1.0 / 6 - z * (1.0 / 24 - z * (1.0 / 120 - z / 720))));
    step.second = options_.late_share() == 0 ? h * step.first : h * step.corrector;
    store.turning[p] = step;
  }
}

void Engine::collect_fluid() {
  if (!fluid_) return;
  for (int p = 0; p < store.owned; ++p) {
    for (int d = 0; d < 3; ++d) {
      store.action[p].impulse[d] += store.drag[p].impulse[d];
      impulses.drag[d] += store.drag[p].impulse[d];
      store.drag[p].impulse[d] = 0;
    }
    store.action[p].work += store.drag[p].impulse[3];
    store.drag[p].impulse[3] = 0;
  }
}

}  // namespace silt
