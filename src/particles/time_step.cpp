#include "particles/time_step.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"

namespace silt {

StepLimit limit_step(const ParticleOptions& options, const Materials& materials, const ContactLaws& laws,
                     const SmallestRadii& smallest, double speed, const std::vector<StepBound>& others) {
  StepLimit limit;
  const auto lower = [&](double step, const std::string& reason) {
    if (step < limit.step) limit = {step, reason};
  };
  for (int a = 0; a < materials.count(); ++a) {
    const double radius = smallest.radius[a];
    if (radius >= infinity) continue;
    const Material& material = materials[a];
    const double mass = *material.density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    if (laws.hertzian()) {
      const double shear = material.young_modulus / (2 * (1 + material.poisson_ratio));
      const double rayleigh =
          std::numbers::pi * radius * std::sqrt(*material.density / shear) / (0.1631 * material.poisson_ratio + 0.8766);
      lower(options.rayleigh_fraction * rayleigh, fmt::format("{:.3g} of the Rayleigh time {:.3g} s of {}",
                                                              options.rayleigh_fraction, rayleigh, material.name));
    }
    for (int b = 0; b < materials.count(); ++b) {
      // Any material may be that of a wall, which is as a partner of infinite mass and radius.
      const double other = smallest.radius[b] < infinity ? smallest.radius[b] : infinity;
      const double other_mass = *materials[b].density * 4.0 / 3.0 * std::numbers::pi * other * other * other;
      const Encounter encounter = meeting(mass, radius, other_mass, other, speed);
      const double duration = laws.duration(a, b, encounter);
      lower(options.step_fraction * duration,
            fmt::format("{:.3g} of the collision time {:.3g} s of {} with {}{}", options.step_fraction, duration,
                        material.name, materials[b].name,
                        laws.hertzian() ? fmt::format(" at {:.3g} m/s", speed) : std::string()));
      for (const auto& [law, time] : laws.pull_durations(a, b, encounter))
        lower(options.step_fraction * time,
              fmt::format("{:.3g} of half an oscillation {:.3g} s by {} of {} with {}", options.step_fraction, time,
                          law, material.name, materials[b].name));
      // Friction's springs decide over no restitution: twice the step.
      for (const auto& [law, time] : laws.swing_durations(a, b, encounter))
        lower(2 * options.step_fraction * time,
              fmt::format("{:.3g} of half a swing {:.3g} s by {} of {} with {}", 2 * options.step_fraction, time, law,
                          material.name, materials[b].name));
    }
  }
  for (const StepBound& other : others)
    lower(options.step_fraction * other.duration,
          fmt::format("{:.3g} of the time {:.3g} s of the {}", options.step_fraction, other.duration, other.reason));
  if (options.step > 0 && limit.step < infinity) {
    if (options.step > limit.step * (1 + 1e-12) && !options.step_override)
      throw UserError(
          fmt::format("-particles_step {:g} s is longer than {:.4g} s, {}; allowed: at most that, 0 (automatic), or "
                      "-particles_step_override yes",
                      options.step, limit.step, limit.reason));
    limit = {options.step, options.step > limit.step * (1 + 1e-12)
                               ? fmt::format("given; longer than {:.4g} s, {}", limit.step, limit.reason)
                               : "given"};
  }
  return limit;
}

}  // namespace silt
