// How the fluid acts in the substeps: drag integrated exactly, every other fluid force constant.
#include <cmath>

#include "particles/engine.hpp"

namespace silt {

void Engine::prepare_fluid(double h) {
  bool acts = false;
  for (const auto& action : store.action)
    acts |= action.exchange != 0 || action.force[0] != 0 || action.force[1] != 0 || action.force[2] != 0;
  fluid_ = mpi_any(acts);
  if (!fluid_) return;
  store.drag.reserve(store.owned);
  for (int p = 0; p < store.owned; ++p) {
    const FluidAction& action = store.action[p];
    DragStep step{};
    for (int d = 0; d < 3; ++d) {
      step.velocity[d] = action.velocity[d];
      step.acceleration[d] = action.force[d] * store.motion[p].inverse_mass;
    }
    step.rate = action.exchange * store.motion[p].inverse_mass;
    const double z = step.rate * h;
    // phi = (1 - exp(-z))/rate, psi = (h - phi)/rate; their series where the differences would lose digits.
    step.first = z > 0 ? -std::expm1(-z) / step.rate : h;
    step.second = z > 1e-2
                      ? (h - step.first) / step.rate
                      : h * h * (0.5 - z * (1.0 / 6 - z * (1.0 / 24 - z * (1.0 / 120 - z * (1.0 / 720 - z / 5040)))));
    step.corrector = step.second / h;
    store.drag[p] = step;
  }
}

void Engine::collect_fluid() {
  if (!fluid_) return;
  for (int p = 0; p < store.owned; ++p)
    for (int d = 0; d < 3; ++d) {
      store.action[p].impulse[d] += store.drag[p].impulse[d];
      impulses.drag[d] += store.drag[p].impulse[d];
      store.drag[p].impulse[d] = 0;
    }
}

}  // namespace silt
