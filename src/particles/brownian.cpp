#include "particles/brownian.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/philox.hpp"
#include "base/physical_constants.hpp"

namespace silt {
namespace {

/// 2 (z - 2 tanh(z/2)) without loss of digits.
double rest_variance(double z) {
  if (z > 0.05) return 2 * (z - 2 * std::tanh(0.5 * z));
  return z * z * z / 6 * (1 - z * z / 10 * (1 - 17 * z * z / 168));
}

}  // namespace

double Brownian::speed(double mass) const {
  return 3 * std::sqrt(3 * boltzmann_constant * options_.temperature / mass);
}

BrownianWay Brownian::act(Store& store, const Integration& step, double time) const {
  const double h = step.dt, energy = boltzmann_constant * options_.temperature;
  const auto moment = std::bit_cast<std::uint64_t>(time);
  double largest = 0, longest = 0;
  for (int p = 0; p < store.owned; ++p) {
    Motion& motion = store.motion[p];
    DragStep& drag = store.drag[p];
    double jump = 0;
    const auto id = static_cast<std::uint64_t>(store.id[p]);
    const auto deviates = [&](std::uint32_t stream) {
      return normal_deviates(philox({static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(id >> 32),
                                     static_cast<std::uint32_t>(moment), static_cast<std::uint32_t>(moment >> 32)},
                                    {static_cast<std::uint32_t>(options_.seed), stream}));
    };
    if (drag.rate > 0) {
      const double z = drag.rate * h, inverse_mass = motion.inverse_mass * drag.share, thermal = energy * inverse_mass;
      double kick = 0, together = 0, alone = 0;  // dv = kick a, dx = together a + alone b
      if (options_.overdamped) {
        alone = std::sqrt(2 * thermal * h / drag.rate);
      } else {
        const double relaxed = -std::expm1(-z);
        kick = std::sqrt(thermal * -std::expm1(-2 * z));
        together = thermal * relaxed * relaxed / (drag.rate * kick);
        alone = std::sqrt(thermal * rest_variance(z)) / drag.rate;
      }
      const auto a = deviates(0), b = deviates(1);
      for (int d = 0; d < 3; ++d) {
        if (step.move[d] == 0) continue;
        const double dv = kick * a[d];
        drag.impulse[3] += dv / motion.inverse_mass * (motion.velocity[d] + 0.5 * dv);
        motion.velocity[d] += dv;
        const double way = together * a[d] + alone * b[d];
        motion.position[d] += way;
        jump += way * way;
        drag.impulse[d] += dv / motion.inverse_mass;
      }
    }
    if (step.turning && store.turning[p].rate > 0) {
      const double inverse_inertia = 2.5 * motion.inverse_mass / (motion.radius * motion.radius);
      const double kick = std::sqrt(energy * inverse_inertia * -std::expm1(-2 * store.turning[p].rate * h));
      const auto c = deviates(2);
      for (int d = 0; d < 3; ++d) store.rotation[p].spin[d] += step.turn[d] * kick * c[d];
    }
    largest = std::max(largest, store.way(p));
    longest = std::max(longest, jump);
  }
  return {largest, std::sqrt(longest)};
}

}  // namespace silt
