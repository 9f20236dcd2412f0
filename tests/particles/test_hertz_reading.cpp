#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "head_on.hpp"
#include "particles/normal/hertz.hpp"

using namespace silt;

namespace {

/// Root mean square of the relative change of the energy over elastic collisions of `steps` steps that begin in many
/// phases of a step.
double chance_of_energy(int steps) {
  constexpr double radius = 1e-3, speed = 0.7, young = 1e7, poisson = 0.25, density = 2500;
  const double mass = density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  const double k = 4.0 / 3.0 * young / (2 * (1 - poisson * poisson)) * std::sqrt(radius / 2);
  const double dt = hertz_duration(k, mass / 2, 2 * speed) / steps;
  BoxCase setup;
  setup.set("material_bead_young_modulus", "1e7").set("material_bead_poisson_ratio", "0.25");
  setup.set("material_bead_restitution", "1").set("material_bead_friction", "0");
  setup.set("particles_step", fmt::format("{:.17g}", dt)).set("particles_step_override", "yes");
  setup.set("particles_speed", "0.7");
  constexpr int phases = 32;
  double square = 0;
  for (int n = 0; n < phases; ++n) {
    const double e = head_on(setup, radius, speed, (2 + (n + 0.5) / phases) * 2 * speed * dt, dt).restitution;
    square += (e * e - 1) * (e * e - 1);
  }
  return std::sqrt(square / phases);
}

}  // namespace

TEST_CASE("An elastic Hertz collision gives its energy back wherever in a step it begins and ends", "[particles]") {
  // Readings of the force as it stands lose or gain 6e-4, 1e-4 and 1.7e-5, an order of 2.5.
  const double coarse = chance_of_energy(20), fine = chance_of_energy(40), finest = chance_of_energy(80);
  INFO(coarse << " " << fine << " " << finest);
  CHECK(coarse < 1e-4);
  CHECK(fine < 1.5e-5);
  CHECK(finest < 2.5e-6);
}
