#include <catch2/catch.hpp>
#include <numbers>

#include "coupling/exchange.hpp"

using namespace silt;

namespace {

/// One parcel of fluid and one particle, free or held by a damped spring, stepped with the exchange of the coupling.
struct Parcel {
  double fluid_mass = 1, mass = 5, dt = 1, push = 0;
  bool sprung = false;
  int substeps = 400;
  Vec3 u = Vec3::UnitX(), v = Vec3::Zero(), x = Vec3::Zero(), owed = Vec3::Zero();
  double h = 0;

  double step(double exchange) {
    const double ds = dt / substeps, decay = std::exp(-exchange * ds / mass);
    const double spring = mass * std::pow(2 * std::numbers::pi / (20 * ds), 2), damping = std::sqrt(spring * mass);
    const Vec3 start = v, force = owed / dt;
    Vec3 impulse = Vec3::Zero(), contact = Vec3::Zero();
    for (int s = 0; s < substeps; ++s) {
      Vec3 other = force;
      if (sprung) other += -spring * x - damping * v;
      contact += (other - force) * ds;
      const Vec3 next = u + other / exchange + (v - u - other / exchange) * decay;
      impulse += mass * (next - v) - other * ds;
      x += sprung ? Vec3(0.5 * (v + next) * ds) : Vec3(next * ds);
      v = next;
    }
    h = held(start, v, u, force, mass, exchange, dt, h);
    const Response r = response(mass, exchange, h, dt);
    const Vec3 change = (push * dt * Vec3::UnitX() - impulse) / (fluid_mass + r.mass);
    u += change;
    const Vec3 at_once = (1 - r.held) * r.free * change;
    v += at_once / mass;
    owed = r.mass * change - at_once;
    return contact.x() + push * dt;  // what came from outside
  }
  double momentum() const { return (fluid_mass * u + mass * v + owed).x(); }
};

}  // namespace

TEST_CASE("a free particle and the fluid reach their common velocity however short the response time", "[exchange]") {
  for (const double ratio : {0.1, 2.0, 10.0, 1000.0}) {
    Parcel parcel;
    for (int k = 0; k < 200; ++k) parcel.step(ratio * parcel.mass / parcel.dt);
    const double common = 1.0 / 6;  // (M u + m v)/(M + m)
    INFO("k dt/m = " << ratio);
    CHECK(parcel.u.x() == Approx(common).epsilon(1e-6));
    CHECK(parcel.v.x() == Approx(common).epsilon(1e-6));
  }
  Parcel stiff;
  stiff.step(1000 * stiff.mass);
  CHECK(stiff.u.x() == Approx(1.0 / 6).epsilon(1e-12));  // in one step
}

TEST_CASE("a particle held by its contacts lets the fluid reach Darcy's velocity however short the response time",
          "[exchange]") {
  for (const double ratio : {0.1, 2.0, 10.0, 1000.0}) {
    Parcel parcel;
    parcel.sprung = true;
    parcel.push = 3;
    for (int k = 0; k < 200; ++k) parcel.step(ratio * parcel.mass / parcel.dt);
    INFO("k dt/m = " << ratio);
    CHECK(parcel.u.x() == Approx(parcel.push / (ratio * parcel.mass / parcel.dt)).epsilon(1e-3));
    CHECK(parcel.h > 0.95);
  }
}

TEST_CASE("momentum is conserved to round-off in both limits and in between, what is owed included", "[exchange]") {
  for (const bool sprung : {false, true}) {
    for (const double ratio : {0.1, 2.0, 1000.0}) {
      Parcel parcel;
      parcel.sprung = sprung;
      parcel.push = 0.5;
      for (int k = 0; k < 20; ++k) {
        const double before = parcel.momentum();
        const double outside = parcel.step(ratio * parcel.mass / parcel.dt);
        REQUIRE(parcel.momentum() - before == Approx(outside).margin(1e-10 * (1 + ratio)));
      }
    }
  }
}

TEST_CASE("a particle that settles at its terminal velocity counts as free", "[exchange]") {
  const double mass = 1e-9, exchange = 1e-5, dt = 1e-3;  // k dt/m = 10
  const Vec3 weight = mass * Vec3(0, 0, -9.81), terminal = weight / exchange;
  // It starts from rest and reaches the terminal velocity: that is what it would do alone.
  const Vec3 reached = terminal * -std::expm1(-exchange * dt / mass);
  CHECK(held(Vec3::Zero(), reached, Vec3::Zero(), weight, mass, exchange, dt, 1) == Approx(0).margin(1e-12));
  // Then nothing moves any more, neither alone nor in fact: what was known stays.
  CHECK(held(terminal, terminal, Vec3::Zero(), weight, mass, exchange, dt, 0.25) == 0.25);
  // Stopped by a floor.
  CHECK(held(terminal, Vec3::Zero(), Vec3(0, 0, 1), weight, mass, exchange, dt, 0.25) == Approx(1).margin(0.02));
}

TEST_CASE("the response of a slow particle is k dt, held or free", "[exchange]") {
  const Response slow = response(1.0, 1e-6, 0.3, 1e-3);
  CHECK(slow.free == Approx(1e-9).epsilon(1e-6));
  CHECK(slow.mass == Approx(1e-9).epsilon(1e-6));
  const Response fast = response(2.0, 1e6, 0.0, 1.0);
  CHECK(fast.mass == Approx(2.0));
  CHECK(response(2.0, 1e6, 1.0, 1.0).mass == Approx(1e6));
  CHECK(response(2.0, 0.0, 0.5, 1.0).mass == 0);
}
