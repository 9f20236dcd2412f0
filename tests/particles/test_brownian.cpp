#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "base/philox.hpp"
#include "base/physical_constants.hpp"
#include "gas_box.hpp"
#include "particles/brownian.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double diameter = 1e-7, viscosity = 0.89e-3, temperature = 298.15, density = 2500;
const double friction = 3 * pi * viscosity * diameter;
const double diffusivity = boltzmann_constant * temperature / friction;
const double mass = density * pi / 6 * std::pow(diameter, 3);
const double response = mass / friction;  // 1.56e-9 s

/// Beads of 100 nm in water at rest, a micrometre apart.
struct Suspension {
  explicit Suspension(int n, const std::string& step, bool overdamped = false)
      : Suspension(setup(step, overdamped), n) {}
  Suspension(const BoxCase& box, int n) : run(box) {
    std::vector<Seed> seeds;
    for (int k = 0; k < n * n * n; ++k)
      seeds.push_back(sphere(1e-6 * Vec3(k % n - 0.5 * n + 0.5, k / n % n - 0.5 * n + 0.5, k / (n * n) - 0.5 * n + 0.5),
                             Vec3::Zero(), diameter / 2));
    run.particles.add(seeds);
  }
  static BoxCase setup(const std::string& step, bool overdamped) {
    BoxCase box;
    box.box(Vec3::Constant(-1e-5), Vec3::Constant(1e-5));
    box.set("brownian_temperature", "298.15").set("particles_step", step).set("particles_step_override", "yes");
    if (overdamped) box.set("brownian_overdamped", "yes");
    return box;
  }
  void advance(double dt, const Vec3& force = Vec3::Zero(), double spin_exchange = 0) {
    for (int i = 0; i < run.particles.owned(); ++i) {
      FluidAction& action = run.particles.fluid_action(i);
      action.exchange = friction;
      action.spin_exchange = spin_exchange;
      vec3(action.force) = force;
    }
    run.particles.advance(time, dt);
    time += dt;
  }
  BoxRun run;
  double time = 0;
};

double mean_square(const std::map<std::int64_t, State>& a, const std::map<std::int64_t, State>& b) {
  double sum = 0;
  for (const auto& [id, s] : a) sum += (vec3(s.x) - vec3(b.at(id).x)).squaredNorm();
  return sum / static_cast<double>(a.size());
}

}  // namespace

TEST_CASE("Philox4x32-10 gives the numbers of its authors", "[brownian]") {
  using Four = std::array<std::uint32_t, 4>;
  CHECK(philox({0, 0, 0, 0}, {0, 0}) == Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  CHECK(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}) ==
        Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("Brownian particles spread as 6 D t for steps below and far beyond their response time", "[brownian]") {
  CHECK(diffusivity == Approx(4.907e-12).epsilon(1e-3));
  struct Case {
    const char* step;
    bool overdamped;
  };
  for (const auto& [step, overdamped] : {Case{"1e-9", false}, Case{"1e-7", false}, Case{"1e-7", true}}) {
    Suspension suspension(12, step, overdamped);
    const auto start = gather(suspension.run.particles);
    const double time = 1e-6;
    suspension.advance(time);
    const double spread = mean_square(gather(suspension.run.particles), start);
    // From rest: 6 D (t - tau (2 (1 - e) - (1 - e^2)/2)), e = exp(-t/tau); three standard errors of 1728 particles.
    const double lag = overdamped ? 0 : 1.5 * response;
    CHECK(spread == Approx(6 * diffusivity * (time - lag)).epsilon(3 * std::sqrt(2.0 / (3 * 1728))));
  }
}

TEST_CASE("Brownian velocities have the energy 3/2 k_B T and forget themselves as exp(-t/tau)", "[brownian]") {
  Suspension suspension(12, "4e-10");
  suspension.advance(20 * response);
  const auto start = gather(suspension.run.particles);
  suspension.advance(response);
  const auto end = gather(suspension.run.particles);
  double energy = 0, together = 0;
  for (const auto& [id, s] : start) {
    energy += vec3(s.v).squaredNorm() / 1728;
    together += vec3(s.v).dot(vec3(end.at(id).v)) / 1728;
  }
  const double error = 3 * std::sqrt(2.0 / (3 * 1728)), thermal = 3 * boltzmann_constant * temperature / mass;
  CHECK(energy == Approx(thermal).epsilon(error));
  CHECK(together / thermal == Approx(std::exp(-1)).margin(error));
  // The ballistic law: 6 D tau (t/tau - 1 + exp(-t/tau)).
  CHECK(mean_square(start, end) == Approx(6 * diffusivity * response * std::exp(-1)).epsilon(error));
}

TEST_CASE("Brownian spins have the energy 3/2 k_B T where the viscous torque holds them", "[brownian]") {
  Suspension suspension(12, "4e-10");
  suspension.advance(20 * response, Vec3::Zero(), pi * viscosity * std::pow(diameter, 3));
  double square = 0;
  for (const auto& [id, s] : gather(suspension.run.particles)) square += vec3(s.w).squaredNorm() / 1728;
  const double inertia = 0.1 * mass * diameter * diameter;
  CHECK(square == Approx(3 * boltzmann_constant * temperature / inertia).epsilon(3 * std::sqrt(2.0 / (3 * 1728))));
}

TEST_CASE("Without inertia a step is u + F/k and the noise of (id, time, seed), the same on any ranks",
          "[brownian][mpi]") {
  Suspension suspension(4, "1e-7", true);
  const auto start = gather(suspension.run.particles);
  const Vec3 force(0, 0, 1e-13);
  suspension.advance(1e-7, force);
  const auto bits = std::bit_cast<std::uint64_t>(1e-7);
  for (const auto& [id, s] : gather(suspension.run.particles)) {
    const auto noise = normal_deviates(philox(
        {static_cast<std::uint32_t>(id), 0, static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)},
        {1, 1}));
    for (int d = 0; d < 3; ++d) {
      const double moved = s.x[d] - start.at(id).x[d];
      const double expected = 1e-7 * force[d] / friction + std::sqrt(2 * diffusivity * 1e-7) * noise[d];
      REQUIRE(std::abs(moved - expected) < 1e-18);
      REQUIRE(s.v[d] == Approx(force[d] / friction).margin(1e-18));
    }
  }
}

TEST_CASE("What Brownian motion gives the particles is accounted to the drag, that is to the fluid",
          "[brownian][mpi]") {
  Suspension suspension(4, "1e-9");
  suspension.advance(1e-8);
  const auto in = suspension.run.particles.take_impulses();
  CHECK((in.drag - suspension.run.particles.momentum()).norm() < 1e-12 * in.drag.norm());
}

TEST_CASE("The work that Brownian motion does is that of the fluid: what flies and turns has its energy from there",
          "[brownian][mpi]") {
  Suspension suspension(4, "1e-9");
  suspension.advance(1e-8, Vec3::Zero(), pi * viscosity * std::pow(diameter, 3));
  double work = 0, flight = 0, turning = 0;
  for (int i = 0; i < suspension.run.particles.owned(); ++i) work += suspension.run.particles.fluid_action(i).work;
  for (const auto& [id, s] : gather(suspension.run.particles)) {
    flight += 0.5 * mass * vec3(s.v).squaredNorm();
    turning += 0.05 * mass * diameter * diameter * vec3(s.w).squaredNorm();
  }
  CHECK(turning > 0.3 * flight);
  CHECK(mpi_sum(work) == Approx(flight + turning).epsilon(1e-10));
}

TEST_CASE("Brownian orientations forget themselves as exp(-2 D_r t), for steps below and beyond the spin's response",
          "[brownian]") {
  // Debye 1929: the mean cosine of the angle turned, D_r = k_B T/k_r; the spin's response time is 3/10 of the
  // velocity's.
  const double spin_exchange = pi * viscosity * std::pow(diameter, 3);
  const double rotational = boltzmann_constant * temperature / spin_exchange, time = 0.5 / (2 * rotational);
  for (const char* step : {"2e-6", "2e-7", "5e-11"}) {
    // The shortest step for as long as takes a few hundred of them.
    const double end = step[0] == '5' ? 20 * response : time;
    BoxCase setup = Suspension::setup(step, false);
    setup.set("magnetic_type", "permanent").set("magnetic_magnetisation", "1e-3").set("magnetic_direction", "0, 0, 1");
    setup.set("magnetic_cutoff", "2e-7").set("particles_orientation", "yes").set("particles_skin", "1e-6");
    Suspension suspension(setup, 12);
    suspension.advance(end, Vec3::Zero(), spin_exchange);
    Particles& particles = suspension.run.particles;
    const double* moment = particles.columns().values(particles.columns().find("magnetic_moment"));
    const double* q = particles.columns().values(particles.columns().find("orientation"));
    double cosine = 0, square = 0, apart = 0;
    for (int p = 0; p < particles.owned(); ++p) {
      const Vec3 m = vec3(&moment[3 * p]).normalized();
      // The particle's z axis in space, by its quaternion.
      const double* r = &q[4 * p];
      const Vec3 z(2 * (r[1] * r[3] + r[0] * r[2]), 2 * (r[2] * r[3] - r[0] * r[1]),
                   1 - 2 * (r[1] * r[1] + r[2] * r[2]));
      cosine += m[2] / 1728, square += m[2] * m[2] / 1728;
      apart = std::max(apart, (z - m).norm());
    }
    // A spin that starts at rest lags by 3/2 of its response time, as a velocity does.
    const double lag = 1.5 * 0.3 * response;
    INFO("step " << step << ": mean cosine " << cosine);
    const double error = 3 * std::sqrt((square - cosine * cosine) / 1728);
    CHECK(cosine == Approx(std::exp(-2 * rotational * (end - lag))).margin(error));
    CHECK((square - cosine * cosine) > 0);
    CHECK(apart < (step[0] == '5' ? 1e-6 : 1));
  }
}
