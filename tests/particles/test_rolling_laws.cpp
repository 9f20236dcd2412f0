#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "ball_on_plane.hpp"
#include "law_cases.hpp"
#include "reference_path.hpp"

using namespace silt;

namespace {

/// Inertia of a ball that rolls about its contact. kg m2
double rocking_inertia(const BallOnPlane& ball) { return ball.inertia + ball.mass * ball.radius * ball.radius; }

}  // namespace

TEST_CASE("Viscous rolling resistance dies away exponentially below its limit and brakes evenly at it", "[particles]") {
  BallOnPlane ball;
  ball.set("rolling_type", "viscous_coulomb").set("rolling_damping", "1e-9").set("rolling_length", "1e-5");
  const double rate = 1e-9 / rocking_inertia(ball), limit = 1e-5 * ball.weight;
  const double slow = 0.5 * limit / 1e-9 * ball.radius;
  ball.start(0, slow);
  ball.advance(1 / rate);
  CHECK(ball.at().v[0] == Approx(slow * std::exp(-1.0)).epsilon(2e-3));
  const double deceleration = limit * ball.radius / rocking_inertia(ball), fast = 20 * slow;
  ball.start(0, fast);
  ball.advance(0.5 * fast / deceleration);
  CHECK(ball.at().v[0] == Approx(0.5 * fast).epsilon(2e-3));
}

TEST_CASE("The elastic-plastic rolling spring rocks at its damped frequency and stops a rolling ball", "[particles]") {
  for (const double damping : {0.0, 0.3}) {
    BallOnPlane ball;
    ball.set("rolling_type", "epsd").set("material_bead_rolling_friction", "0.05");
    ball.set("rolling_damping_ratio", std::to_string(damping));
    const double arm = 0.05 * ball.radius, spring = 2.25 * ball.stiffness * arm * arm;
    const double natural = std::sqrt(spring / rocking_inertia(ball));
    const double speed = 0.3 * arm * ball.weight / spring * natural * ball.radius;
    const double damped = natural * std::sqrt(1 - damping * damping), decay = damping * natural;
    ball.start(0, speed);
    for (int part = 1; part <= 4; ++part) {
      ball.advance(0.8 / damped);
      const double t = part * 0.8 / damped;
      const double exact =
          speed * std::exp(-decay * t) * (std::cos(damped * t) - decay / damped * std::sin(damped * t));
      CHECK(std::abs(ball.at().v[0] - exact) < 1.5e-2 * speed);
    }
  }
  BallOnPlane ball;
  ball.set("rolling_type", "epsd").set("material_bead_rolling_friction", "0.05");
  const double deceleration = 5.0 / 7.0 * 0.05 * ball.gravity, speed = 0.05;
  ball.start(0, speed);
  ball.advance(1.3 * speed / deceleration);
  CHECK(ball.at().x[0] == Approx(0.5 * speed * speed / deceleration).epsilon(1e-2));
  CHECK(std::abs(ball.at().v[0]) < 1e-3 * speed);
}

TEST_CASE("The rolling spring rocks at its frequency and yields at the critical rolling displacement", "[particles]") {
  BallOnPlane ball;
  ball.set("rolling_type", "spring").set("rolling_stiffness", "3e-2").set("rolling_critical_angle", "1e-3");
  const double natural = std::sqrt(3e-2 * ball.radius / rocking_inertia(ball));
  const double speed = 0.3e-3 * natural * ball.radius;
  ball.start(0, speed);
  for (int part = 1; part <= 4; ++part) {
    ball.advance(0.8 / natural);
    CHECK(std::abs(ball.at().v[0] - speed * std::cos(part * 0.8)) < 1.5e-2 * speed);
  }
  const double limit = 3e-2 * 1e-3 * ball.radius, deceleration = limit * ball.radius / rocking_inertia(ball);
  const double fast = 0.05;
  ball.start(0, fast);
  ball.advance(0.5 * fast / deceleration);
  CHECK(ball.at().v[0] == Approx(0.5 * fast).epsilon(1e-2));
}

TEST_CASE("The twisting spring swings at its frequency, and stops a spinning ball at two thirds of mu F a",
          "[particles]") {
  BallOnPlane ball;
  ball.set("twisting_type", "twisting").set("twisting_stiffness", "1e-6").set("twisting_damping", "0");
  const double natural = std::sqrt(1e-6 / ball.inertia);
  const double limit = 2.0 / 3.0 * 0.8 * ball.weight * ball.contact_radius;
  const double slow = 0.3 * limit / 1e-6 * natural;
  ball.start(0, 0, slow);
  for (int part = 1; part <= 4; ++part) {
    ball.advance(0.8 / natural);
    CHECK(std::abs(ball.at().w[2] - slow * std::cos(part * 0.8)) < 1e-2 * slow);
  }
  ball.start(0, 0, 1.0);
  ball.advance(0.5 * ball.inertia / limit);
  CHECK(ball.at().w[2] == Approx(0.5).epsilon(5e-3));
}

TEST_CASE("Unless given, the twisting spring and dashpot are Mindlin's times half the contact radius squared",
          "[particles]") {
  const LawRun run(LawCase().choose("twisting", "twisting").set("material_bead_friction", "1e6"));
  std::vector<double> history(run.laws.history_components() + 1);
  Contact<double> contact{};
  contact.normal[2] = 1;
  contact.overlap = 2e-6, contact.effective_radius = 1e-3, contact.effective_mass = 1e-6, contact.radius = 1e-3;
  contact.spin[2] = 3;
  const PairProperties& pair = run.materials.pair(0, 0);
  const double dt = 1e-6;
  loads_of(run.laws, contact, pair, 1e-3, 1e-3, dt, history.data());
  const Loads loads = loads_of(run.laws, contact, pair, 1e-3, 1e-3, dt, history.data());
  const double square = 1e-3 * 2e-6, stiffness = 8 * pair.effective_shear * std::sqrt(square);
  const double damping = 2 * std::sqrt(pair.effective_shear / pair.effective_young) * loads.normal.damping;
  CHECK(loads.torque_i[2] == Approx(-0.5 * square * (stiffness * 1.5 * dt * 3 + damping * 3)));
}
