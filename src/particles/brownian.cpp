#include "particles/brownian.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/philox.hpp"
#include "base/physical_constants.hpp"
#include "particles/orientation.hpp"

namespace silt {
namespace {

/// 2 (z - 2 tanh(z/2)) without loss of digits.
double rest_variance(double z) {
  if (z > 0.05) return 2 * (z - 2 * std::tanh(0.5 * z));
  return z * z * z / 6 * (1 - z * z / 10 * (1 - 17 * z * z / 168));
}

/// A step's jointly normal changes: of velocity `kick` a, of position `together` a + `alone` b.
struct Noise {
  double kick = 0, together = 0, alone = 0;
};
/// `thermal`: k_B T over the mass, or over the inertia of a spin.
Noise noise_of(double thermal, double rate, double h) {
  const double z = rate * h, relaxed = -std::expm1(-z), kick = std::sqrt(thermal * -std::expm1(-2 * z));
  return {kick, thermal * relaxed * relaxed / (rate * kick), std::sqrt(thermal * rest_variance(z)) / rate};
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
      const double inverse_mass = motion.inverse_mass * drag.share, thermal = energy * inverse_mass;
      Noise noise;
      if (options_.overdamped) {
        noise.alone = std::sqrt(2 * thermal * h / drag.rate);
      } else {
        noise = noise_of(thermal, drag.rate, h);
      }
      const auto a = deviates(0), b = deviates(1);
      for (int d = 0; d < 3; ++d) {
        if (step.move[d] == 0) continue;
        const double dv = noise.kick * a[d];
        drag.impulse[3] += dv / motion.inverse_mass * (motion.velocity[d] + 0.5 * dv);
        motion.velocity[d] += dv;
        const double way = noise.together * a[d] + noise.alone * b[d];
        motion.position[d] += way;
        jump += way * way;
        drag.impulse[d] += dv / motion.inverse_mass;
      }
    }
    if (step.turning && store.turning[p].rate > 0) {
      const double inverse_inertia = 2.5 * motion.inverse_mass / (motion.radius * motion.radius);
      // Rotation vectors add up where they are small, as those of a step.
      const auto [kick, together, alone] = noise_of(energy * inverse_inertia, store.turning[p].rate, h);
      const auto c = deviates(2), e = deviates(3);
      double way[3];
      for (int d = 0; d < 3; ++d) {
        const double turned = step.turn[d] * kick * c[d];
        drag.impulse[3] += turned / inverse_inertia * (store.rotation[p].spin[d] + 0.5 * turned);
        store.rotation[p].spin[d] += turned;
        way[d] = step.turn[d] * (together * c[d] + alone * e[d]);
        if (step.turned) step.turned[p][d] += way[d];
      }
      if (step.orientation) turn_by(step.orientation[p], way[0], way[1], way[2]);
    }
    largest = std::max(largest, store.way(p));
    longest = std::max(longest, jump);
  }
  return {largest, std::sqrt(longest)};
}

}  // namespace silt
