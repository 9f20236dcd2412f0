#include <fmt/format.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/physical_constants.hpp"
#include "gas_box.hpp"
#include "particles/engine.hpp"
#include "particles/field/magnetic.hpp"

using namespace silt;

namespace {

constexpr double pi = std::numbers::pi, mu0 = vacuum_permeability;
constexpr double radius = 1e-7, magnetisation = 4.8e5;
const double volume = 4.0 / 3 * pi * radius * radius * radius;
const double moment = magnetisation * volume;

BoxCase magnets(const std::string& type, double side = 4e-6) {
  BoxCase setup;
  setup.box(Vec3::Constant(-side / 2), Vec3::Constant(side / 2));
  setup.set("magnetic_type", type).set("particles_speed", "1").set("material_bead_density", "5000");
  if (type != "linear") setup.set("magnetic_magnetisation", "4.8e5");
  return setup;
}

struct Magnets {
  explicit Magnets(BoxCase setup) : mesh(setup.mesh), engine(mesh, setup.options, Vec3::Zero()) {}
  Mesh mesh;
  Engine engine;
  Vec3 force(int p) const { return vec3(engine.store.present[p].force); }
  Vec3 torque(int p) const { return vec3(engine.store.present[p].torque); }
  Vec3 moment_of(int p) const {
    return vec3(engine.store.columns.row(engine.store.columns.find("magnetic_moment"), p));
  }
  Vec3 position(int p) const { return vec3(engine.store.motion[p].position); }
};

/// The force on i of (7.77), b from j to i.
Vec3 dipole_force(const Vec3& r, const Vec3& mi, const Vec3& mj) {
  const double d = r.norm();
  const Vec3 b = r / d;
  return 3 * mu0 / (4 * pi * std::pow(d, 4)) *
         (mi.dot(b) * mj + mj.dot(b) * mi + mi.dot(mj) * b - 5 * mi.dot(b) * mj.dot(b) * b);
}
Vec3 dipole_field(const Vec3& r, const Vec3& mj) {
  const double d = r.norm();
  return (3 * r.dot(mj) / (d * d) * r - mj) / (4 * pi * d * d * d);
}

std::vector<Seed> pair_at(const Vec3& apart) {
  return {sphere(-0.5 * apart, Vec3::Zero(), radius), sphere(0.5 * apart, Vec3::Zero(), radius)};
}

}  // namespace

TEST_CASE("Two dipoles attract head to tail, repel side by side with half of that, and turn when oblique",
          "[magnetic]") {
  const double gap = 1.0001, r = 2 * radius * gap;
  // 1.5160e-9 N and 7.580e-10 N in contact, for particles of 100 nm and 480 kA/m.
  const double in_contact = 3 * mu0 * moment * moment / (2 * pi * std::pow(2 * radius, 4));
  CHECK(in_contact == Approx(1.5160e-9).epsilon(1e-4));
  struct Case {
    Vec3 apart, force;  // on the second
  };
  const double oblique = pi / 6;
  const Vec3 n(std::sin(oblique), 0, std::cos(oblique));
  for (const auto& [apart, expected] :
       {Case{Vec3(0, 0, 1), Vec3(0, 0, -1)}, Case{Vec3(1, 0, 0), Vec3(0.5, 0, 0)},
        Case{n, Vec3(0.5 * (2 * std::cos(oblique) * Vec3::UnitZ() + n - 5 * std::pow(std::cos(oblique), 2) * n))}}) {
    Magnets run(magnets("saturated").set("magnetic_field", "0, 0, 1e4"));
    run.engine.add(pair_at(r * apart));
    run.engine.advance(0, 1e-15);
    const int second = run.position(0).dot(apart) > 0 ? 0 : 1;
    CHECK((run.force(second) - in_contact / std::pow(gap, 4) * expected).norm() < 1e-9 * in_contact);
    CHECK((run.force(0) + run.force(1)).norm() < 1e-15 * in_contact);
  }
}

TEST_CASE("Forces between dipoles are the sums over pairs: with images, with a cut-off, on any ranks and instructions",
          "[magnetic][mpi]") {
  __builtin_cpu_init();
  for (const std::string instructions : {"plain", "avx2", "auto"})
    for (const bool periodic : {false, true})
      for (const double cutoff : {0.0, 0.9e-6}) {
        if (instructions == "avx2" && !__builtin_cpu_supports("avx2")) continue;
        const double side = 4e-6;
        BoxCase setup = magnets("permanent", side).set("particles_instructions", instructions);
        setup.set("magnetic_cutoff", fmt::format("{}", cutoff)).set("magnetic_field", "2e3, 0, 1e3");
        if (periodic) setup.periodic();
        Magnets run(setup);
        run.engine.add(gas(5, Vec3::Constant(-side / 2), Vec3::Constant(side / 2), radius, 0, 0.2));
        run.engine.advance(0, 1e-15);
        // Everyone's place and moment by id.
        std::vector<double> all(6 * 125, 0.0);
        for (int p = 0; p < run.engine.store.owned; ++p) {
          vec3(&all[6 * run.engine.store.id[p]]) = run.position(p);
          vec3(&all[6 * run.engine.store.id[p] + 3]) = run.moment_of(p);
        }
        MPI_Allreduce(MPI_IN_PLACE, all.data(), 6 * 125, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
        double error = 0, largest = 0, torque_error = 0, largest_torque = 0;
        for (int p = 0; p < run.engine.store.owned; ++p) {
          Vec3 force = Vec3::Zero(), field(2e3, 0, 1e3);
          const Vec3 m = run.moment_of(p);
          for (int j = 0; j < 125; ++j) {
            if (j == run.engine.store.id[p]) continue;
            Vec3 apart = run.position(p) - vec3(&all[6 * j]);
            if (periodic)
              for (int d = 0; d < 3; ++d) apart[d] -= side * std::nearbyint(apart[d] / side);
            if (cutoff > 0 && apart.norm() >= cutoff) continue;
            force += dipole_force(apart, m, vec3(&all[6 * j + 3]));
            field += dipole_field(apart, vec3(&all[6 * j + 3]));
          }
          error = std::max(error, (run.force(p) - force).norm());
          largest = std::max(largest, force.norm());
          const Vec3 torque = mu0 * m.cross(field);
          torque_error = std::max(torque_error, (run.torque(p) - torque).norm());
          largest_torque = std::max(largest_torque, torque.norm());
        }
        CHECK(mpi_max(error) < 1e-12 * mpi_max(largest));
        CHECK(mpi_max(torque_error) < 1e-12 * mpi_max(largest_torque));
      }
}

TEST_CASE("Spheres that magnetise each other have the moments of two coupled dipoles", "[magnetic][mpi]") {
  const double chi = 1.2, field = 1e4, r = 2.2 * radius, coupling = chi * volume / (4 * pi * r * r * r);
  for (const bool along : {true, false}) {
    Magnets run(magnets("linear")
                    .set("magnetic_susceptibility", "1.2")
                    .set("magnetic_field", "0, 0, 1e4")
                    .set("magnetic_tolerance", "1e-13"));
    run.engine.add(pair_at(r * (along ? Vec3::UnitZ() : Vec3::UnitX())));
    run.engine.advance(0, 1e-15);
    const double expected = chi * volume * field / (along ? 1 - 2 * coupling : 1 + coupling);
    for (int p = 0; p < run.engine.store.owned; ++p)
      CHECK((run.moment_of(p) - Vec3(0, 0, expected)).norm() < 1e-11 * expected);
  }
  // The same across periodic sides, within a cut-off and without.
  for (const char* cutoff : {"0", "3e-7"}) {
    Magnets run(magnets("linear")
                    .set("magnetic_susceptibility", "1.2")
                    .set("magnetic_field", "0, 0, 1e4")
                    .set("magnetic_cutoff", cutoff)
                    .set("magnetic_tolerance", "1e-13")
                    .periodic());
    const Vec3 end(0, 0, 2e-6 - 0.5 * r);
    run.engine.add({sphere(-end, Vec3::Zero(), radius), sphere(end, Vec3::Zero(), radius)});
    run.engine.advance(0, 1e-15);
    for (int p = 0; p < run.engine.store.owned; ++p)
      CHECK(run.moment_of(p)[2] == Approx(chi * volume * field / (1 - 2 * coupling)).epsilon(1e-11));
  }
  LinearMagnetism iron;
  iron.permeability = 1e9;
  CHECK(iron.effective() == Approx(3));
}

TEST_CASE("Langevin's moment is chi V H in weak fields and saturates in strong ones", "[magnetic]") {
  LangevinMagnetism law;
  law.magnetisation = 1e5, law.susceptibility = 2;
  CHECK(law.moment(Vec3(1, 0, 0), 1)[0] == Approx(2).epsilon(1e-8));
  CHECK(law.moment(Vec3(0, 1e9, 0), 2)[1] == Approx(2e5).epsilon(1e-4));
  CHECK(LangevinMagnetism::langevin(0.00999999) == Approx(LangevinMagnetism::langevin(0.01000001)).epsilon(1e-5));
  CHECK(LangevinMagnetism::langevin(1) == Approx(0.3130352855));
}

TEST_CASE("A field gradient draws a magnet with mu0 grad(m.H), and the ledger has the impulse", "[magnetic][mpi]") {
  Magnets run(magnets("fixed").set("magnetic_direction", "1, 0, 2").set("magnetic_field", "3e9*z, 0, 3e9*x - 1e9*z"));
  run.engine.add({sphere(Vec3(2e-7, 1e-7, -3e-7), Vec3::Zero(), radius)});
  run.engine.advance(0, 1e-8);
  const Vec3 m = moment * Vec3(1, 0, 2).normalized(), expected = mu0 * Vec3(3e9 * m[2], 0, 3e9 * m[0] - 1e9 * m[2]);
  for (int p = 0; p < run.engine.store.owned; ++p) {
    CHECK((run.force(p) - expected).norm() < 1e-9 * expected.norm());
    CHECK((run.engine.impulses.fields - 1e-8 * expected).norm() < 1e-9 * 1e-8 * expected.norm());
    CHECK((run.engine.impulses.fields -
           vec3(run.engine.store.motion[p].velocity) / run.engine.store.motion[p].inverse_mass)
              .norm() < 1e-12 * 1e-8 * expected.norm());
  }
}

TEST_CASE("A permanent magnet swings in a field with omega^2 = m B/I, of second order in the step", "[magnetic]") {
  const double field = 1e4, inertia = 0.4 * 5000 * volume * radius * radius;
  const double omega = std::sqrt(mu0 * moment * field / inertia), end = 2 / omega, angle = 1e-3;
  double error[2];
  for (int k = 0; k < 2; ++k) {
    BoxCase setup = magnets("permanent").set("magnetic_field", "0, 0, 1e4").set("particles_step_override", "yes");
    setup.set("magnetic_direction", fmt::format("{:.17g}, 0, {:.17g}", std::sin(angle), std::cos(angle)));
    setup.set("particles_step", fmt::format("{:.17g}", end / (k == 0 ? 40 : 80)));
    Magnets run(setup);
    run.engine.add({sphere(Vec3::Zero(), Vec3::Zero(), radius)});
    run.engine.advance(0, end);
    // The period of a pendulum of this amplitude: 1 + angle^2/16.
    const double expected = angle * std::cos(omega * end / (1 + angle * angle / 16));
    error[k] = std::abs(run.moment_of(0)[0] / moment - expected) / angle;
  }
  CHECK(error[1] < 1e-3);
  CHECK(error[0] / error[1] == Approx(4).epsilon(0.25));
}

TEST_CASE("Two free magnets keep momentum and angular momentum, spin included, to round-off", "[magnetic]") {
  Magnets run(magnets("permanent"));
  run.engine.add({sphere(Vec3(-2e-7, 0, 1e-8), Vec3(0, 0.1, 0), radius, Vec3(1e5, 0, 3e5)),
                  sphere(Vec3(2e-7, 3e-8, 0), Vec3(0, -0.1, 0.02), radius, Vec3(0, 2e5, 0))});
  const auto angular = [&] {
    Vec3 sum = Vec3::Zero();
    for (int p = 0; p < 2; ++p) {
      const Motion& motion = run.engine.store.motion[p];
      const double mass = 1 / motion.inverse_mass;
      sum += mass * run.position(p).cross(Vec3(vec3(motion.velocity))) +
             0.4 * mass * radius * radius * vec3(run.engine.store.rotation[p].spin);
    }
    return sum;
  };
  const Vec3 before = angular();
  run.engine.advance(0, 1e-7);
  CHECK((angular() - before).norm() < 1e-11 * before.norm());
  CHECK(vec3(run.engine.store.rotation[0].spin).norm() != Approx(std::sqrt(10) * 1e5).epsilon(1e-3));
}

TEST_CASE("A magnet in a viscous fluid follows a turning field behind by arcsin(w/w_c), and slips beyond w_c",
          "[magnetic]") {
  // k_w dphi/dt = k_w w - mu0 m H sin(phi) for the angle phi behind: steady below w_c = mu0 m H/k_w; above it the
  // magnet turns at w - (w^2 - w_c^2)^1/2 on average. Inertia: I/k_w = 3.3 ns, also far below the step.
  const double torque = mu0 * moment * 1e4, friction = 8 * pi * 1e-3 * radius * radius * radius;
  const double critical = torque / friction;
  for (const double ratio : {0.5, 2.0})
    for (const char* step : {"0", "1e-7"}) {
      const double rate = ratio * critical, beat = std::sqrt(std::abs(rate * rate - critical * critical));
      const double end = ratio < 1 ? 15 / critical : 3 * 2 * pi / beat;
      BoxCase setup = magnets("permanent").set("magnetic_direction", "1, 0, 0");
      setup.set("magnetic_field", fmt::format("1e4*cos({0:.17g}*t), 1e4*sin({0:.17g}*t), 0", rate));
      setup.set("particles_step", step).set("particles_step_override", "yes");
      Magnets run(setup);
      run.engine.add({sphere(Vec3::Zero(), Vec3::Zero(), radius)});
      run.engine.store.want_actions();
      run.engine.store.action[0].spin_exchange = friction;
      double turned = 0, before = 0;
      constexpr int parts = 200;
      for (int k = 0; k < parts; ++k) {
        run.engine.advance(k * end / parts, end / parts);
        const double now = std::atan2(run.moment_of(0)[1], run.moment_of(0)[0]);
        turned += std::remainder(now - before, 2 * pi);
        before = now;
      }
      INFO("w/w_c " << ratio << ", step " << step << ": turned by " << turned << " of " << rate * end);
      if (ratio < 1) {
        CHECK(run.engine.store.rotation[0].spin[2] == Approx(rate).epsilon(2e-3));
        CHECK(rate * end - turned == Approx(std::asin(ratio)).epsilon(0.02));
      } else {
        // After whole beats, from any angle.
        CHECK(turned == Approx((rate - beat) * end).epsilon(0.02));
      }
    }
}

TEST_CASE("A magnet that a fluid holds turns on its way through all ranks as one that stands still",
          "[magnetic][mpi]") {
  const auto end_of = [](double drift) {
    BoxCase setup;
    setup.box(Vec3::Zero(), Vec3(6e-6, 1e-6, 1e-6));
    setup.mesh.cells = {30, 2, 2};
    setup.set("magnetic_type", "permanent").set("magnetic_magnetisation", "4.8e5").set("particles_speed", "1");
    setup.set("material_bead_density", "5000").set("magnetic_direction", "1, 0, 0.5");
    setup.set("magnetic_field", "1e4*cos(5e5*t), 1e4*sin(5e5*t), 0");
    setup.set("particles_step", "1e-8").set("particles_step_override", "yes");
    Magnets run(setup);
    run.engine.add({sphere(Vec3(5e-7, 5e-7, 5e-7), Vec3(drift, 0, 0), radius)});
    for (int k = 0; k < 20; ++k) {
      run.engine.store.want_actions();
      for (auto& action : run.engine.store.action) action.spin_exchange = 8 * pi * 1e-3 * radius * radius * radius;
      run.engine.advance(k * 1e-7, 1e-7);
    }
    Vec3 m = Vec3::Zero();
    for (int p = 0; p < run.engine.store.owned; ++p) m = run.moment_of(p);
    MPI_Allreduce(MPI_IN_PLACE, m.data(), 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
    return m;
  };
  const Vec3 still = end_of(0), moved = end_of(2.4);
  CHECK(still.norm() == Approx(moment).epsilon(1e-9));
  CHECK(std::abs(still[2]) < 0.3 * moment);  // it has turned
  CHECK((moved - still).norm() < 1e-9 * moment);
}

TEST_CASE("Saturated moments turn with the field at once, and the force on a soft sphere goes with its square",
          "[magnetic]") {
  const double rate = 2 * pi * 1e5;
  Magnets pair(magnets("saturated").set("magnetic_field", "1e4*cos(2e5*pi*t), 0, 1e4*sin(2e5*pi*t)"));
  pair.engine.add(pair_at(2.5 * radius * Vec3::UnitX()));
  const double size = 3 * mu0 * moment * moment / (4 * pi * std::pow(2.5 * radius, 4));
  for (auto& motion : {0, 1}) pair.engine.store.motion[motion].inverse_mass = 1e-9;  // nothing moves
  Magnets soft(magnets("linear")
                   .set("magnetic_susceptibility", "1.5")
                   .set("magnetic_field", "(1e4 + 1e10*x)*cos(2e5*pi*t), 0, 0"));
  soft.engine.add({sphere(Vec3::Zero(), Vec3::Zero(), radius)});
  soft.engine.store.motion[0].inverse_mass = 1e-9;
  for (int k = 0; k < 8; ++k) {
    const double from = k * 0.7e-6, phase = rate * (from + 0.7e-6);
    pair.engine.advance(from, 0.7e-6);
    soft.engine.advance(from, 0.7e-6);
    // On the second, b = x: 2 (m.b) m + (1 - 5 (m.b)^2) b, moments along (cos, 0, sin).
    const double c = std::cos(phase), s = std::sin(phase);
    const Vec3 expected = size * Vec3(2 * c * c + 1 - 5 * c * c, 0, 2 * c * s);
    const int second = pair.position(0)[0] > 0 ? 0 : 1;
    CHECK((pair.force(second) - expected).norm() < 1e-6 * size);
    // mu0 chi V H dH/dx: never backwards, half of its largest value on average.
    CHECK(soft.force(0)[0] == Approx(mu0 * 1.5 * volume * 1e4 * 1e10 * c * c).margin(1e-9 * mu0 * volume * 1e14));
  }
}

TEST_CASE("Magnets in a viscous fluid and a uniform field form chains along it", "[magnetic][slow]") {
  const double side = 3e-6;
  BoxCase setup = magnets("saturated", side).set("magnetic_field", "0, 0, 1e5").periodic();
  setup.set("brownian_overdamped", "yes").set("particles_step", "2e-9").set("particles_step_override", "yes");
  setup.set("material_bead_young_modulus", "1e7");
  Magnets run(setup);
  run.engine.add(gas(5, Vec3::Constant(-side / 2), Vec3::Constant(side / 2), radius, 0));
  // Mean of (3 cos^2 - 1)/2 of the direction to the nearest neighbour: 0 at random, 1 in chains along the field.
  const auto order = [&] {
    double sum = 0;
    for (int p = 0; p < 125; ++p) {
      double nearest = 1;
      Vec3 to = Vec3::UnitX();
      for (int j = 0; j < 125; ++j) {
        Vec3 apart = run.position(j) - run.position(p);
        for (int d = 0; d < 3; ++d) apart[d] -= side * std::nearbyint(apart[d] / side);
        if (j != p && apart.norm() < nearest) nearest = apart.norm(), to = apart.normalized();
      }
      sum += (1.5 * to[2] * to[2] - 0.5) / 125;
    }
    return sum;
  };
  const double before = order();
  for (int n = 0; n < 20; ++n) {
    run.engine.store.want_actions();
    for (auto& action : run.engine.store.action) action.exchange = 6 * pi * 1e-3 * radius;
    run.engine.advance(n * 4e-6, 4e-6);
  }
  CHECK(before < 0.3);
  CHECK(order() > 0.8);
}

TEST_CASE("Magnetic options that contradict each other or are missing are refused", "[magnetic]") {
  CHECK_THROWS_AS(Magnets(magnets("linear")), UserError);
  CHECK_THROWS_AS(Magnets(magnets("linear").set("magnetic_susceptibility", "1").set("magnetic_permeability", "2")),
                  UserError);
  CHECK_THROWS_AS(Magnets(magnets("fixed").set("magnetic_field", "1, 0, 0").set("magnetic_flux_density", "1, 0, 0")),
                  UserError);
}

TEST_CASE("The time step resolves the attraction of magnets in contact", "[magnetic]") {
  Magnets run(magnets("saturated").set("magnetic_field", "0, 0, 1e5").set("material_bead_young_modulus", "1e12"));
  run.engine.add(pair_at(3 * radius * Vec3::UnitX()));
  Magnets soft(magnets("saturated").set("magnetic_field", "0, 0, 1e5").set("material_bead_young_modulus", "1e2"));
  soft.engine.add(pair_at(3 * radius * Vec3::UnitX()));
  const double stiffness = 6 * mu0 * moment * moment / (pi * std::pow(2 * radius, 5));
  CHECK(soft.engine.limit.step <= 0.05 * pi * std::sqrt(0.5 * 5000 * volume / stiffness) * (1 + 1e-12));
}

TEST_CASE("Every magnetic model turns with the scene and gives a free pair opposite forces", "[magnetic][mpi]") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Vec3(1, -2, 2).normalized()).toRotationMatrix();
  for (const auto& name : MagneticModels::names()) {
    if (name == "none") continue;
    INFO(name);
    const auto loads = [&](const Eigen::Matrix3d& by) {
      BoxCase setup = magnets(name);
      const Vec3 field = by * Vec3(3e4, 5e4, -2e4), axis = by * Vec3(2, -1, 1);
      const auto text = [](const Vec3& v) { return fmt::format("{:.17g}, {:.17g}, {:.17g}", v[0], v[1], v[2]); };
      setup.set("magnetic_field", text(field));
      if (name == "linear" || name == "langevin") setup.set("magnetic_susceptibility", "1.5");
      if (name == "fixed" || name == "permanent") setup.set("magnetic_direction", text(axis));
      Magnets run(setup);
      run.engine.add(pair_at(by * Vec3(1.2, 1.8, 0.9) * radius));
      run.engine.advance(0, 1e-15);
      std::vector<double> values(12, 0.0);  // force and torque of both, on all ranks
      for (int p = 0; p < run.engine.store.owned; ++p) {
        const int at = 6 * static_cast<int>(run.engine.store.id[p]);
        for (int d = 0; d < 3; ++d) values[at + d] = run.force(p)[d], values[at + 3 + d] = run.torque(p)[d];
      }
      MPI_Allreduce(MPI_IN_PLACE, values.data(), 12, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
      return values;
    };
    const auto straight = loads(Eigen::Matrix3d::Identity()), turned = loads(turn);
    const double size = vec3(straight.data()).norm();
    CHECK(size > 0);
    CHECK((vec3(straight.data()) + vec3(&straight[6])).norm() < 1e-12 * size);
    for (int k = 0; k < 12; k += 3) {
      const double scale = k % 6 == 0 ? size : size * radius;
      CHECK((turn * vec3(&straight[k]) - vec3(&turned[k])).norm() < 1e-7 * scale);
    }
  }
}
