#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "ball_on_plane.hpp"
#include "law_cases.hpp"
#include "reference_path.hpp"

using namespace silt;

namespace {

/// A contact held at a constant load, sheared along x.
struct Sheared {
  LawRun run;
  Contact<double> contact{};
  std::vector<double> history;
  double load = 0, limit = 0, k = 0;

  explicit Sheared(const LawCase& setup) : run(setup), history(run.laws.history_components() + 1) {
    contact.normal[2] = 1;
    contact.overlap = 5e-6, contact.effective_radius = 1e-3, contact.effective_mass = 1e-6, contact.radius = 1e-3;
  }
  /// Tangential force after slipping by `distance` in `steps`.
  Vec3 slip(double distance, int steps, double across = 0) {
    Loads loads;
    loads.normal = {};
    loads.force.setZero();
    contact.slip[0] = distance / steps, contact.slip[1] = across / steps;
    for (int k_step = 0; k_step < steps; ++k_step)
      loads = loads_of(run.laws, contact, run.materials.pair(0, 0), 1e-3, 1e-3, 1.0, history.data());
    load = loads.normal.force, k = loads.normal.stiffness, limit = 0.5 * load;
    return loads.force - loads.normal.force * vec3(contact.normal);
  }
};

LawCase walton() { return LawCase().choose("normal", "linear").choose("tangential", "walton_braun"); }

}  // namespace

TEST_CASE("Below its limit viscous friction lets the slip die away exponentially", "[particles]") {
  BallOnPlane ball;
  ball.set("tangential_type", "viscous").set("tangential_damping", "2e-3");
  ball.start(1e-3);
  const double rate = 2e-3 * ball.mobility;
  ball.advance(1 / rate);
  CHECK(ball.slip() == Approx(1e-3 * std::exp(-1.0)).epsilon(2e-3));
  ball.start(1.0);  // far above the limit: mu g
  ball.advance(1e-3);
  CHECK(ball.at().v[0] == Approx(1.0 - 0.8 * 9.81 * 1e-3).epsilon(1e-6));
}

TEST_CASE("A tangential spring without dashpot lets a stuck ball swing at its frequency for good", "[particles]") {
  BallOnPlane ball;
  ball.set("tangential_type", "spring").set("tangential_stiffness", "2e3");
  const double frequency = std::sqrt(2e3 * ball.mobility), v = 0.3 * 0.8 * ball.weight / 2e3 * frequency;
  ball.start(v);
  for (int swing = 1; swing <= 4; ++swing) {
    ball.advance(std::numbers::pi / frequency);
    CHECK(ball.slip() == Approx(v * (swing % 2 ? -1 : 1)).epsilon(1e-2));
  }
}

TEST_CASE("A spring and dashpot let a stuck ball swing at the damped frequency", "[particles]") {
  BallOnPlane ball;
  ball.set("tangential_type", "spring_dashpot").set("tangential_stiffness", "2e3").set("tangential_damping", "0.01");
  ball.set("particles_step", "2e-7");
  const double square = 2e3 * ball.mobility, decay = 0.5 * 0.01 * ball.mobility;
  const double frequency = std::sqrt(square - decay * decay), v = 0.3 * 0.8 * ball.weight / 2e3 * std::sqrt(square);
  ball.start(v);
  for (int part = 1; part <= 4; ++part) {
    ball.advance(0.8 / frequency);
    const double t = part * 0.8 / frequency;
    const double exact =
        v * std::exp(-decay * t) * (std::cos(frequency * t) - decay / frequency * std::sin(frequency * t));
    CHECK(std::abs(ball.slip() - exact) < 1e-2 * v);
  }
}

TEST_CASE("Slip at the limit leaves the spring at mu F/k, so that reversal unloads at once", "[particles]") {
  Sheared contact(LawCase().choose("normal", "linear").choose("tangential", "spring"));
  contact.slip(0, 1);
  CHECK(contact.slip(1e-3, 10)[0] == Approx(-contact.limit));
  const double back = 0.25 * contact.limit / 3e3;
  contact.slip(0, 1);  // the history runs half a step ahead
  contact.slip(-back, 1000);
  CHECK(contact.slip(0, 1)[0] == Approx(-0.75 * contact.limit).epsilon(2e-3));
}

TEST_CASE("Walton-Braun friction follows the closed form of first loading, unloading and reloading", "[particles]") {
  Sheared contact(walton());
  contact.slip(0, 1);
  const double stiffness = contact.k * 0.7 / 0.85, limit = contact.limit;
  CHECK(contact.k == Approx(1e4));
  const auto grown = [&](double room, double distance) {
    return room * (1 - std::pow(std::max(1 - 2.0 / 3.0 * stiffness * distance / room, 0.0), 1.5));
  };
  const double far = 0.9 * limit / stiffness;
  const double top = grown(limit, far);
  for (const int steps : {1, 7, 50}) {  // whatever the increments
    Sheared again(walton());
    CHECK(again.slip(far, steps)[0] == Approx(-top).epsilon(1e-12));
  }
  CHECK(contact.slip(far, 9)[0] == Approx(-top).epsilon(1e-12));
  const double back = 1.4 * limit / stiffness;  // passes through zero
  const double low = top - grown(limit + top, back);
  CHECK(low < 0);
  CHECK(contact.slip(-back, 13)[0] == Approx(-low).epsilon(1e-9));
  CHECK(contact.slip(0.1 * far, 5)[0] == Approx(-(low + grown(limit - low, 0.1 * far))).epsilon(1e-9));
  CHECK(contact.slip(1, 10)[0] == Approx(-limit));
  CHECK(contact.slip(-1, 10)[0] == Approx(limit));
}

TEST_CASE("Walton-Braun friction scales the force of the last reversal with the normal force", "[particles]") {
  Sheared contact(walton());
  contact.slip(0, 1);
  const double stiffness = contact.k * 0.7 / 0.85, limit = contact.limit;
  const double top = -contact.slip(0.8 * limit / stiffness, 4)[0];
  const double before = -contact.slip(-0.1 * limit / stiffness, 4)[0];
  CHECK(before < top);
  contact.contact.overlap *= 2;  // twice the load: F* is twice what it was
  const double after = -contact.slip(-0.3 * limit / stiffness, 3)[0];
  const double room = 2 * limit + 2 * top, passed = (2 * top - before) / room;
  const double left = std::pow(1 - passed, 2.0 / 3.0) - 2.0 / 3.0 * stiffness * 0.3 * limit / stiffness / room;
  CHECK(after == Approx(2 * top - room * (1 - std::pow(left, 1.5))).epsilon(1e-9));
}

TEST_CASE("Walton-Braun friction answers displacement across the force with its first stiffness", "[particles]") {
  Sheared contact(walton());
  contact.slip(0, 1);
  const double stiffness = contact.k * 0.7 / 0.85, far = 0.5 * contact.limit / stiffness;
  const double before = contact.slip(far, 5)[0];
  const Vec3 after = contact.slip(0, 1, 1e-3 * far);
  CHECK(after[0] == Approx(before));
  CHECK(after[1] == Approx(-stiffness * 1e-3 * far).epsilon(1e-4));
}

TEST_CASE("A pyramid of three balls stands on springs and collapses on viscous friction", "[particles]") {
  for (const bool stands : {true, false}) {
    BoxCase setup;
    setup.box(Vec3(-10e-3, 0, -2e-3), Vec3(10e-3, 10e-3, 2e-3));
    setup.gravity = {0, -9.81, 0};
    setup.set("particles_plane", "yes").set("material_bead_friction", "0.6").set("material_bead_restitution", "0.5");
    setup.set("normal_type", "linear").set("normal_stiffness", "5e3");
    setup.set("tangential_type", stands ? "spring" : "viscous");
    setup.set(stands ? "tangential_stiffness" : "tangential_damping", stands ? "2e3" : "5e-4");
    BoxRun run(setup);
    const double radius = 0.5e-3, top = radius * (1 + std::sqrt(3.0));
    run.particles.add({sphere(Vec3(-radius, radius, 0), Vec3::Zero(), radius),
                       sphere(Vec3(radius, radius, 0), Vec3::Zero(), radius),
                       sphere(Vec3(0, top, 0), Vec3::Zero(), radius)});
    run.particles.advance(0, 0.2);
    const double height = gather(run.particles).at(2).x[1];
    if (stands)
      CHECK(height == Approx(top).epsilon(1e-2));
    else
      CHECK(height < 0.8 * top);
  }
}
