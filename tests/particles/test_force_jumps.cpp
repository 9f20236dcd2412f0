// Forces that jump where surfaces meet or part: a dashpot's, a neck's, a bridge's. The work they do within the step of
// the jump is right to second order, wherever in the step that falls.
#include <catch2/catch.hpp>
#include <cmath>

#include "gas_box.hpp"
#include "law_cases.hpp"

using namespace silt;

namespace {

using Given = std::vector<std::pair<std::string, std::string>>;

struct Jumping {
  const char *slot, *name;
  Given more;
  double speed, gap, time;  ///< m/s of each sphere; m at the start; s until they are apart again
  double order;             ///< that the rest of the force allows
};

/// Speeds at which spheres of 1 mm leave each other (or a wall) with steps of this share of the shortest duration, met
/// in several phases of the step.
std::vector<double> rebounds(const Jumping& law, double fraction, bool wall,
                             const std::vector<double>& phases = {0.03, 0.17, 0.31, 0.43, 0.55, 0.69, 0.82, 0.95}) {
  BoxCase setup;
  setup.box(Vec3::Constant(-10e-3), Vec3::Constant(10e-3));
  if (law.slot != std::string("normal")) setup.set("material_bead_restitution", "1");
  setup.set("material_bead_young_modulus", "1e7");
  setup.set("particles_speed", std::to_string(2 * law.speed)).set("particles_overlap_limit", "0.5");
  setup.set("particles_step_fraction", std::to_string(fraction));
  for (const auto& [option, value] : law_options(law.slot, law.name)) setup.set(option, value);
  for (const auto& [option, value] : law.more) setup.set(option, value);
  const double radius = 1e-3, far = -10e-3 + radius;
  BoxRun alone(setup);
  alone.particles.add({sphere(Vec3::Zero(), Vec3::Zero(), radius)});
  const double step = law.time / std::ceil(law.time / alone.particles.time_step());
  std::vector<double> speeds;
  for (const double phase : phases) {
    BoxRun run(setup);
    const Vec3 speed(wall ? -2 * law.speed : -law.speed, 0, 0);
    const double gap = law.gap - phase * 2 * law.speed * step;
    if (wall)
      run.particles.add({sphere(Vec3(far + gap, 0, 0), speed, radius)});
    else
      run.particles.add({sphere(Vec3(-radius, 0, 0), -speed, radius), sphere(Vec3(radius + gap, 0, 0), speed, radius)});
    run.particles.advance(0, law.time);
    const auto state = gather(run.particles);
    speeds.push_back(wall ? state.at(0).v[0] : state.at(1).v[0] - state.at(0).v[0]);
  }
  return speeds;
}

/// Root of the mean square of the errors over the phases.
double error_of(const std::vector<double>& found, double exact) {
  double square = 0;
  for (const double speed : found) square += (speed - exact) * (speed - exact);
  return std::sqrt(square / static_cast<double>(found.size()));
}

const Given slow_bridge = {
    {"bridge_surface_tension", "0.07"}, {"bridge_liquid_content", "0.01"}, {"bridge_viscosity", "0"}};
const std::vector<Jumping> jumping = {
    {"normal", "linear", {{"material_bead_restitution", "0.6"}}, 0.05, 3e-6, 2e-4, 1.8},
    {"normal", "lee_herrmann", {{"normal_damping", "0.01"}}, 0.05, 3e-6, 8e-4, 1.8},
    {"normal", "langston", {{"normal_gravity", "1e5"}, {"normal_damping_ratio", "0.3"}}, 0.05, 3e-6, 1e-3, 1.8},
    {"normal", "lennard_jones", {{"normal_damping_rate", "300"}, {"normal_energy", "1e-6"}}, 0.05, 0.26e-3, 3e-2, 1.8},
    {"adhesion", "dmt", {{"material_bead_surface_energy", "0.1"}}, 0.05, 3e-6, 8e-4, 1.8},
    // The force rises from the break like a root, which the trapezoid follows to the order 3/2.
    {"adhesion", "jkr", {{"material_bead_surface_energy", "0.1"}}, 0.05, 3e-6, 8e-4, 1.4},
    {"bridge", "capillary", slow_bridge, 0.08, 3e-6, 8e-3, 1.8},
    {"bridge", "capillary", {{"bridge_viscosity", "2e-3"}, {"bridge_roughness", "2e-5"}}, 0.15, 3e-6, 5e-3, 1.8},
};

}  // namespace

TEST_CASE("A force that jumps within a step does work that is right to second order, between spheres and at a wall",
          "[particles]") {
  for (const Jumping& law : jumping)
    for (const bool wall : {false, true}) {
      INFO(law.slot << " " << law.name << (wall ? " at a wall" : ""));
      const double exact = rebounds(law, 0.05 / 256, wall, {0.5}).front(), met = 2 * law.speed;
      CHECK(exact > 0);
      CHECK(exact < met * (law.slot == std::string("adhesion") ? 1.0 + 1e-4 : 0.99));
      // With the step that is taken unless another is asked for; the order from a quarter of it on, for a bridge's
      // error at the whole step is a third and less of what second order would make of the finer ones.
      CHECK(error_of(rebounds(law, 0.05, wall), exact) < 0.01 * met);
      const double coarse = error_of(rebounds(law, 0.0125, wall), exact);
      const double fine = error_of(rebounds(law, 0.0015625, wall), exact);
      INFO("leaves with " << exact << " m/s; errors " << coarse << " " << fine);
      CHECK(std::log(coarse / fine) / std::log(8.0) > law.order);
    }
}
