// What holds for every entry of the lists of laws.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "base/dual.hpp"
#include "dual_real.hpp"
#include "gas_box.hpp"
#include "law_cases.hpp"
#include "reference_path.hpp"

using namespace silt;

namespace {

constexpr double radius_a = 0.5e-3, radius_b = 0.8e-3;

Body moving(const Vec3& position, const Vec3& velocity, const Vec3& spin, double radius) {
  Body motion{};
  vec3(motion.position) = position, vec3(motion.velocity) = velocity, vec3(motion.spin) = spin;
  motion.radius = radius;
  motion.inverse_mass = 1 / (2500 * 4.18879 * std::pow(radius, 3));
  return motion;
}

/// Two spheres led through contact on given paths, turned by a rotation; the loads of each step. `swapped`: with the
/// other one first.
std::vector<Loads> led(const LawRun& run, const Eigen::Matrix3d& turn, bool swapped) {
  std::vector<double> history(run.laws.history_components() + 1);
  std::vector<Loads> loads;
  const double dt = 1e-6;
  const Vec3 axis = Vec3(2, -1, 2) / 3, along(0.02, 0.05, -0.03);
  for (int k = 0; k < 40; ++k) {
    const double gap = 4e-6 - 3e-5 * std::sin(k * 0.08);  // in, out
    const Vec3 n = (axis + 2e-3 * k * along).normalized();
    const Body a = moving(turn * n * (radius_a + radius_b + gap), turn * (along - 0.1 * std::cos(k * 0.2) * axis),
                          turn * Vec3(30, -60, 10), radius_a);
    const Body b = moving(Vec3::Zero(), turn * Vec3(0.01, 0, 0), turn * Vec3(-20, 5, 40), radius_b);
    if (!swapped) {
      loads.push_back(one_contact(run.laws, a, b, dt, history.data()));
    } else {
      Loads other = one_contact(run.laws, b, a, dt, history.data());
      std::swap(other.torque_i, other.torque_j);
      other.force = -other.force;
      loads.push_back(other);
    }
  }
  return loads;
}

double largest_of(const std::vector<Loads>& loads) {
  double largest = 0;
  for (const auto& l : loads)
    largest = std::max({largest, l.force.norm(), l.torque_i.norm() / radius_a, l.torque_j.norm() / radius_b});
  return largest;
}

}  // namespace

TEST_CASE("Every law turns with the scene and is the same seen from either particle", "[particles]") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -2).normalized()).toRotationMatrix();
  each_law([&](const char* slot, const std::string& name) {
    INFO(slot << " " << name);
    const LawRun run(LawCase().choose(slot, name), radius_a, radius_b);
    const auto straight = led(run, Eigen::Matrix3d::Identity(), false), turned = led(run, turn, false);
    const auto swapped = led(run, Eigen::Matrix3d::Identity(), true);
    const double size = largest_of(straight);
    double difference = 0, exchange = 0;
    for (size_t k = 0; k < straight.size(); ++k) {
      difference = std::max(difference, (turn * straight[k].force - turned[k].force).norm());
      difference = std::max(difference, (turn * straight[k].torque_i - turned[k].torque_i).norm() / radius_a);
      difference = std::max(difference, (turn * straight[k].torque_j - turned[k].torque_j).norm() / radius_b);
      exchange = std::max(exchange, (straight[k].force - swapped[k].force).norm());
      exchange = std::max(exchange, (straight[k].torque_i - swapped[k].torque_i).norm() / radius_a);
      exchange = std::max(exchange, (straight[k].torque_j - swapped[k].torque_j).norm() / radius_b);
    }
    CHECK(size > 0);
    CHECK(difference < 1e-9 * size);
    CHECK(exchange < 1e-9 * size);
  });
}

TEST_CASE("Every law gives finite loads whatever the contact", "[particles]") {
  each_law([&](const char* slot, const std::string& name) {
    INFO(slot << " " << name);
    const LawRun run(LawCase().choose(slot, name), radius_a, radius_b);
    Random random(5);
    std::vector<double> history(run.laws.history_components() + 1);
    bool finite = true;
    for (int k = 0; k < 2000; ++k) {
      if (k % 50 == 0) history.assign(history.size(), 0.0);
      const double gap = k % 7 == 0 ? 0.0 : k % 3 == 0 ? random(-2e-4, 2e-4) : random(-1e-6, 1e-6);
      const double still = k % 5 == 0 ? 0 : 1;
      const Vec3 n = random.vector(1).normalized();
      const Body a =
          moving(n * (radius_a + radius_b + gap), still * random.vector(10), still * random.vector(1e4), radius_a);
      const Body b = moving(Vec3::Zero(), still * random.vector(10), Vec3::Zero(), radius_b);
      const Loads loads = one_contact(run.laws, a, b, k % 11 == 0 ? 0 : 1e-6, history.data());
      finite = finite && std::isfinite(loads.force.norm() + loads.torque_i.norm() + loads.torque_j.norm());
      for (const double h : history) finite = finite && std::isfinite(h);
    }
    CHECK(finite);
  });
}

TEST_CASE("The stiffness that a normal law or adhesion tells is the slope of its force, by dual numbers",
          "[particles]") {
  using D = Dual<1>;
  const auto contact_at = [](double overlap) {
    Contact<D> contact{};
    contact.overlap = D::variable(overlap, 0);
    contact.effective_radius = D(0.5e-3), contact.effective_mass = D(1e-6), contact.radius = D(1e-3);
    contact.distance = D(2e-3) - contact.overlap;
    return contact;
  };
  const auto compare = [&](const LawRun& run) {
    const PairProperties pair = run.laws.pair(0, 0);
    for (const double overlap : {1e-7, 2e-6, 3e-5})
      std::visit(
          [&](const auto& normal, const auto& adhesion) {
            using N = std::decay_t<decltype(normal)>;
            using A = std::decay_t<decltype(adhesion)>;
            const auto dual = [](const auto& constants, auto& out) {
              const auto* from = reinterpret_cast<const double*>(&constants);
              auto* to = reinterpret_cast<D*>(&out);
              if constexpr (!std::is_empty_v<std::decay_t<decltype(constants)>>)
                for (size_t k = 0; k < sizeof constants / sizeof(double); ++k) to[k] = D(from[k]);
            };
            typename N::template Constants<D> nc;
            typename A::template Constants<D> ac;
            const auto nd = normal.constants(pair);
            const auto ad = adhesion.constants(pair);
            dual(nd, nc), dual(ad, ac);
            typename N::template History<D> nh{};
            typename A::template History<D> ah{};
            const Contact<D> contact = contact_at(overlap);
            NormalLoad<D> load = N::template load<D>(contact, nc, nh);
            load.pull_off = D(0);
            D pull(0);
            A::template adhere<D>(contact, ac, ah, load, pull);
            const D net = load.force + pull;
            CHECK(load.stiffness.value == Approx(net.derivative[0]).epsilon(1e-9));
          },
          run.laws.normal(), run.laws.adhesion());
  };
  for (const auto& name : NormalModels::names()) {
    INFO(name);
    compare(LawRun(LawCase().choose("normal", name), radius_a, radius_b));
  }
  for (const auto& name : AdhesionModels::names()) {
    INFO(name);
    compare(LawRun(LawCase().choose("adhesion", name).set("material_bead_surface_energy", "0.01"), radius_a, radius_b));
  }
}

TEST_CASE("No law of the normal force makes energy over an approach and a retreat, and none acts beyond its reach",
          "[particles]") {
  const auto drive = [&](const LawRun& run, bool dissipates) {
    std::vector<double> history(run.laws.history_components() + 1);
    const PairProperties pair = run.laws.pair(0, 0);
    const double reach = run.laws.setup().leave_gap, depth = 2e-5, span = depth + reach + 1e-7;
    const int steps = 20000;
    double work = 0, largest = 0;
    const auto force = [&](double overlap, double approach) {
      Contact<double> contact{};
      contact.normal[2] = 1;
      contact.overlap = overlap, contact.approach = approach;
      contact.effective_radius = 0.5e-3, contact.effective_mass = 1e-6, contact.radius = 1e-3;
      contact.distance = 2e-3 - overlap, contact.rolling_inertia = 1;
      const Loads loads = loads_of(run.laws, contact, pair, 1e-3, 1e-3, 1e-6, history.data());
      largest = std::max(largest, std::abs(loads.force[2]));
      return loads.force[2];
    };
    for (int k = 0; k < steps; ++k) work += force(depth - span * (1 - (k + 0.5) / steps), 0.05) * span / steps;
    for (int k = 0; k < steps; ++k) work -= force(depth - span * (k + 0.5) / steps, -0.05) * span / steps;
    CHECK(work >= -1e-9 * largest * span);
    if (dissipates) CHECK(work > 0);
    CHECK(force(-reach - 1e-6, 0) == 0);
  };
  each_law([&](const char* slot, const std::string& name) {
    const std::string kind = slot;
    if (kind == "tangential" || kind == "rolling" || kind == "twisting") return;
    INFO(slot << " " << name);
    drive(LawRun(LawCase().choose(slot, name), 1e-3, 1e-3), true);
  });
}

TEST_CASE("No law of friction, rolling or twisting makes energy over whole swings to and fro, however wide",
          "[particles]") {
  each_law([&](const char* slot, const std::string& name) {
    const std::string kind = slot;
    if ((kind != "tangential" && kind != "rolling" && kind != "twisting") || name == "none") return;
    for (const double width : {1e-8, 1e-7, 1e-6, 1e-5, 1e-4}) {  // m of slip, from stuck to sliding
      INFO(slot << " " << name << " width " << width);
      const LawRun run(LawCase().choose("normal", "linear").choose(slot, name), 1e-3, 1e-3);
      std::vector<double> history(run.laws.history_components() + 1);
      Contact<double> contact{};
      contact.normal[2] = 1;
      contact.overlap = 5e-6, contact.effective_radius = 0.5e-3, contact.effective_mass = 1e-6, contact.radius = 1e-3;
      contact.distance = 2e-3 - 5e-6, contact.rolling_inertia = 1e-12;
      const double rate = 2e4, dt = 1e-7;
      const int period = static_cast<int>(std::lround(6.283185307179586 / (rate * dt)));
      double work = 0, exchanged = 0;
      for (int k = 0; k < 4 * period; ++k) {
        const double speed = width * rate * std::cos(2 * 3.141592653589793 * (k + 0.5) / period);
        contact.slip[0] = kind == "tangential" ? speed : 0;
        contact.spin[1] = kind == "rolling" ? speed / 0.5e-3 : 0;
        contact.spin[2] = kind == "twisting" ? speed / 0.5e-3 : 0;
        const Loads loads = loads_of(run.laws, contact, run.laws.pair(0, 0), 0, 0, dt, history.data());
        const double power = -(loads.force[0] * contact.slip[0] + loads.torque_i[1] * contact.spin[1] +
                               loads.torque_i[2] * contact.spin[2]);
        work += power * dt, exchanged += std::abs(power) * dt;
      }
      CHECK(exchanged > 0);
      CHECK(work > -1e-3 * exchanged);  // what an elastic spring gives back it was given, to the reading within a step
    }
  });
}

TEST_CASE("A free pair keeps its momentum and angular momentum under every law", "[particles]") {
  each_law([&](const char* slot, const std::string& name) {
    INFO(slot << " " << name);
    BoxCase setup;
    setup.box(Vec3::Constant(-10e-3), Vec3::Constant(10e-3));
    setup.set("material_bead_rolling_friction", "0.1").set("material_bead_friction", "0.5");
    setup.set("particles_speed", "0.2").set("particles_overlap_limit", "0.5");
    for (const auto& [option, value] : law_options(slot, name)) setup.set(option, value);
    BoxRun run(setup);
    const Vec3 n = Vec3(1, 2, 2) / 3;
    run.particles.add({sphere(-(radius_a + 1e-6) * n, 0.05 * n + Vec3(0.02, 0, 0), radius_a, Vec3(40, -20, 90)),
                       sphere((radius_b + 1e-6) * n, -0.05 * n, radius_b, Vec3(-50, 10, 5))});
    const Vec3 momentum = run.particles.momentum(), spin = run.particles.angular_momentum(Vec3::Zero());
    run.particles.advance(0, 5e-4);
    const double mass = run.particles.total_mass();
    CHECK((run.particles.momentum() - momentum).norm() < 1e-13 * mass * 0.1);
    CHECK((run.particles.angular_momentum(Vec3::Zero()) - spin).norm() < 1e-12 * mass * 0.1 * radius_b);
  });
}

TEST_CASE("Under every law a pair keeps its memory on its way through all ranks", "[particles][mpi]") {
  // Two spheres that rub, turn and part move along the box through every rank, and stand still in another run.
  each_law([&](const char* slot, const std::string& name) {
    INFO(slot << " " << name);
    const auto relative = [&](double drift, int* rebuilds) {
      BoxCase setup;
      setup.box(Vec3(0, 0, 0), Vec3(60e-3, 6e-3, 6e-3));
      setup.mesh.cells = {30, 2, 2};
      setup.set("material_bead_rolling_friction", "0.1").set("material_bead_friction", "0.5");
      setup.set("particles_speed", "0.2").set("particles_overlap_limit", "0.5").set("particles_skin", "1.5e-3");
      setup.set("particles_step", "2e-6").set("particles_step_override", "yes");
      for (const auto& [option, value] : law_options(slot, name)) setup.set(option, value);
      BoxRun run(setup);
      const Vec3 n = Vec3(1, 2, 2) / 3, middle(5e-3, 3e-3, 3e-3), carried(drift, 0, 0);
      run.particles.add(
          {sphere(middle - (radius_a - 1e-6) * n, carried + 0.05 * n + Vec3(0.02, 0, 0), radius_a, Vec3(40, -20, 90)),
           sphere(middle + (radius_b - 1e-6) * n, carried - 0.05 * n, radius_b, Vec3(-50, 10, 5))});
      for (int k = 0; k < 5; ++k) *rebuilds += run.particles.advance(k * 1e-4, 1e-4).rebuilds;
      const auto state = gather(run.particles);
      const State &a = state.at(0), &b = state.at(1);
      std::vector<double> values;
      for (int d = 0; d < 3; ++d) {
        values.push_back((a.x[d] - b.x[d]) / 1e-3);
        values.push_back((a.v[d] - b.v[d]) / 0.1);
        values.push_back(a.w[d] / 100);
        values.push_back(b.w[d] / 100);
      }
      return values;
    };
    int still = 0, moving = 0;
    const auto expected = relative(0, &still), found = relative(90, &moving);
    CHECK(moving > still + 20);
    for (size_t k = 0; k < expected.size(); ++k) CHECK(found[k] == Approx(expected[k]).margin(1e-7));
  });
}
