#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gas_box.hpp"
#include "impact.hpp"
#include "law_cases.hpp"

using namespace silt;

namespace {

/// Potential energy of Lennard-Jones spheres of one radius in a periodic box.
double potential(const std::map<std::int64_t, State>& state, double radius, double energy, double period) {
  double sum = 0;
  for (auto a = state.begin(); a != state.end(); ++a)
    for (auto b = std::next(a); b != state.end(); ++b) {
      double square = 0;
      for (int d = 0; d < 3; ++d) {
        double apart = a->second.x[d] - b->second.x[d];
        apart -= period * std::nearbyint(apart / period);
        square += apart * apart;
      }
      const double six = std::pow(4 * radius * radius / square, 3);
      if (six > 0.5) sum += energy * (six * six - six + 0.25);
    }
  return sum;
}

}  // namespace

TEST_CASE(
    "Lennard-Jones spheres push with 6 eps/d at touching, from 2^(1/6) d on, and come as near as their energy takes "
    "them",
    "[particles]") {
  LawCase setup;
  setup.set("normal_type", "lennard_jones").set("normal_energy", "1e-8");
  const LawRun run(setup, 1e-3, 1e-3);
  CHECK(run.laws.setup().leave_gap == Approx(1.001 * (std::pow(2, 1.0 / 6) - 1) * 2e-3));
  std::vector<double> history(run.laws.history_components() + 1);
  Contact<double> contact{};
  contact.normal[2] = 1;
  contact.effective_radius = 0.5e-3, contact.effective_mass = 1e-6, contact.radius = 1e-3;
  const auto force = [&](double distance) {
    contact.distance = distance, contact.overlap = 2e-3 - distance;
    const Loads loads = loads_of(run.laws, contact, run.laws.pair(0, 0), 0, 0, 0, history.data());
    return loads.normal.force + loads.pull;
  };
  CHECK(force(2e-3) == Approx(6 * 1e-8 / 2e-3));
  const double end = 2e-3 * std::pow(2, 1.0 / 6);
  CHECK(std::abs(force(end * (1 - 1e-9))) < 1e-6 * 3e-5);
  CHECK(force(end * (1 + 1e-9)) == 0);
  // Speed v at infinity: eps [(d/X)^6 - 1/2]^2 = m v^2/2.
  double x = end, v = -0.1;
  const double mass = 1e-6, dt = 1e-7;
  double nearest = x;
  do {
    v += 0.5 * dt * force(x) / mass;
    x += dt * v;
    v += 0.5 * dt * force(x) / mass;
    nearest = std::min(nearest, x);
  } while (x < end);
  CHECK(nearest == Approx(2e-3 / std::pow(0.5 + std::sqrt(0.5 * mass * 0.01 / 1e-8), 1.0 / 6)).epsilon(1e-4));
  CHECK(v == Approx(0.1).epsilon(1e-6));
}

TEST_CASE("Langston's spring has the stiffness m g (c + 1)/d at touching and the restitution of its damping ratio",
          "[particles]") {
  LawCase setup;
  setup.set("normal_type", "langston").set("normal_damping_ratio", "0.1").set("normal_gravity", "1e6");
  const LawRun run(setup, 1e-3, 1e-3);
  std::vector<double> history(run.laws.history_components() + 1);
  Contact<double> contact{};
  contact.normal[2] = 1;
  contact.effective_radius = 0.5e-3, contact.effective_mass = 1e-6, contact.radius = 1e-3;
  contact.distance = 2e-3 * (1 - 1e-9), contact.overlap = 2e-12;
  const Loads loads = loads_of(run.laws, contact, run.laws.pair(0, 0), 0, 0, 0, history.data());
  CHECK(loads.normal.stiffness == Approx(1e-6 * 1e6 * 37 / 2e-3).epsilon(1e-6));
  CHECK(loads.normal.force == Approx(loads.normal.stiffness * 2e-12).epsilon(1e-6));
  const double ratio = 0.1, exact = std::exp(-std::numbers::pi * ratio / std::sqrt(1 - ratio * ratio));
  CHECK(impact(run, 1e-6, 1e-3, 1e-5, 1e-9).restitution == Approx(exact).epsilon(1e-3));
}

TEST_CASE("A gas of Lennard-Jones spheres keeps momentum, and energy to second order in the step, over periodic sides",
          "[particles][mpi]") {
  // The largest error of the energy at 40 instants, in which every sphere meets about three others.
  double errors[2];
  for (int finer = 0; finer < 2; ++finer) {
    BoxCase setup;
    const double period = 8e-3, radius = 0.5e-3, energy = 1e-8;
    setup.box(Vec3::Zero(), Vec3::Constant(period)).periodic();
    setup.set("normal_type", "lennard_jones").set("normal_energy", "1e-8").set("particles_overlap_limit", "0.6");
    setup.set("particles_step_fraction", finer ? "0.01" : "0.02").set("particles_speed", "0.3");
    setup.set("material_bead_friction", "0");
    BoxRun run(setup);
    run.particles.add(gas(6, Vec3::Zero(), Vec3::Constant(period), radius, 0.1));
    const Vec3 momentum = run.particles.momentum();
    const auto total = [&] {
      return run.particles.kinetic_energy() + potential(gather(run.particles), radius, energy, period);
    };
    const double before = total(), kinetic = run.particles.kinetic_energy();
    errors[finer] = 0;
    double swing = 0;
    for (int k = 0; k < 40; ++k) {
      run.particles.advance(k * 5e-4, 5e-4);
      errors[finer] = std::max(errors[finer], std::abs(total() / before - 1));
      swing = std::max(swing, std::abs(run.particles.kinetic_energy() / kinetic - 1));
    }
    CHECK(swing > 1e-3);  // they did meet
    CHECK((run.particles.momentum() - momentum).norm() < 1e-12 * 216 * run.particles.mass(0) * 0.1);
  }
  INFO("errors " << errors[0] << " and " << errors[1]);
  CHECK(errors[0] < 1e-4);
  CHECK(std::log2(errors[0] / errors[1]) > 1.5);
}

TEST_CASE("A wall acts over a gap: a resting sphere falls to a wall that attracts it", "[particles]") {
  BoxCase setup;
  setup.box(Vec3::Zero(), Vec3::Constant(2e-5));
  setup.set("dlvo_type", "vdw").set("material_bead_hamaker", "1e-19").set("dlvo_least_gap", "5e-9");
  setup.set("particles_speed", "0.1");
  BoxRun run(setup);
  const double radius = 1e-6, gap = 1e-7;
  run.particles.add({sphere(Vec3(radius + gap, 1e-5, 1e-5), Vec3::Zero(), radius)});
  const double force = 2.0 / 3.0 * 1e-19 * std::pow(radius, 3) / std::pow(gap * (2 * radius + gap), 2);
  const double time = 0.02 * std::sqrt(2 * gap * run.particles.mass(0) / force);
  run.particles.advance(0, time);
  CHECK(gather(run.particles).at(0).v[0] == Approx(-force / run.particles.mass(0) * time).epsilon(2e-3));
}
