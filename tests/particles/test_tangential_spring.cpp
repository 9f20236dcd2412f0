#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>

#include "particles/tangential/tangential_load.hpp"
#include "particles/tangential/walton_braun.hpp"

using namespace silt;

namespace {

constexpr double mass = 2e-6, stiffness = 50;
const double frequency = std::sqrt(3.5 * stiffness / mass);  // rad/s

/// One step of a spring without dashpot, as a sweep takes it.
void step_spring(const Contact<double>& contact, double normal_force, double friction, double step, double* spring,
                 double* force) {
  const double rest = grow_spring(contact, stiffness, 0.5, step, spring);
  limit_spring(contact, normal_force, friction, SpringLaw<double>{stiffness, 0}, rest, spring, force);
}

/// A sphere that cannot roll away, pushed aside on a wall with friction, without dashpot: the velocity of the contact
/// point obeys dV/dt = 7/2 F/m, integrated as the engine does. Returns the energy of the oscillation after `radians`,
/// as a share of that at the start.
double energy_left(double step, double radians) {
  Contact<double> contact{};
  contact.normal[2] = 1;
  contact.effective_mass = mass;
  double velocity = 0.01, acceleration = 0, spring[3] = {}, force[3];
  // The first half step of the displacement, before the first reading.
  spring[0] = 0.5 * step * velocity;
  const double start = velocity * velocity;
  double energy = 0, displacement = 0;
  for (int n = 0; n < radians / (frequency * step); ++n) {
    contact.slip[0] = velocity + step * acceleration;  // predicted for the step's end
    step_spring(contact, 1.0, 1e9, step, spring, force);
    const double next = 3.5 * force[0] / mass;
    velocity += 0.5 * step * (acceleration + next);
    acceleration = next;
    displacement = force[0] / stiffness;
    energy = velocity * velocity + frequency * frequency * displacement * displacement;
  }
  return energy / start;
}

}  // namespace

TEST_CASE("a tangential spring without dashpot never gains energy and loses it to third order in the step") {
  double before = 0;
  for (const double angle : {0.2, 0.1, 0.05}) {
    const double lost = 1 - energy_left(angle / frequency, 100);
    INFO("w dt = " << angle << ": lost " << lost);
    CHECK(lost > 0);
    CHECK(lost < 100 * angle * angle * angle);
    if (before > 0) CHECK(std::log2(before / lost) > 2.5);
    before = lost;
  }
}

TEST_CASE("a sliding contact carries mu F_n, and its spring is what that force needs") {
  Contact<double> contact{};
  contact.normal[2] = 1;
  contact.effective_mass = mass;
  contact.slip[1] = 0.2;
  const double step = 1e-6, friction = 0.3, normal = 2e-3;
  double spring[3] = {}, force[3];
  for (int n = 0; n < 200; ++n) step_spring(contact, normal, friction, step, spring, force);
  CHECK(force[1] == Approx(-friction * normal).epsilon(1e-12));
  CHECK(spring[1] == Approx(friction * normal / stiffness).epsilon(0.02));
  // It turns back at once: the force falls by k V dt in a step.
  contact.slip[1] = -0.2;
  double last = force[1];
  step_spring(contact, normal, friction, step, spring, force);
  step_spring(contact, normal, friction, step, spring, force);
  const double middle = force[1];
  step_spring(contact, normal, friction, step, spring, force);
  CHECK(middle > last);
  CHECK(force[1] - middle == Approx(stiffness * 0.2 * step).epsilon(1e-6));
}

TEST_CASE("Walton-Braun friction is of second order in the step, through reversals of the slip") {
  // The ball of above under a constant load, with incremental slip up to 0.7 of the limit.
  const auto at_end = [](int steps) {
    Contact<double> contact{};
    contact.normal[2] = 1;
    contact.effective_mass = mass;
    const NormalLoad<double> normal{2e-4, 0, 1e-5, stiffness, 0};
    const WaltonBraunTangential::Constants<double> constants{1, 0.5, 0.5};
    WaltonBraunTangential::History<double> history{};
    const double step = 20 / frequency / steps;
    double velocity = 5e-5 / stiffness * frequency, acceleration = 0, force[3];
    history.owed[0] = 0.5 * step * velocity;
    for (int n = 0; n < steps; ++n) {
      contact.slip[0] = velocity + step * acceleration;
      WaltonBraunTangential::force<double>(contact, normal, constants, step, history, force);
      const double next = 3.5 * force[0] / mass;
      velocity += 0.5 * step * (acceleration + next);
      acceleration = next;
    }
    return velocity;
  };
  const double exact = at_end(256000), coarse = std::abs(at_end(500) - exact), fine = std::abs(at_end(2000) - exact);
  INFO(coarse << " " << fine);
  CHECK(std::log2(coarse / fine) / 2 > 1.7);
}
