// What holds for every entry of the lists of forces between fluid and particles.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "base/options.hpp"
#include "coupling/drag/drag_models.hpp"
#include "coupling/heat/nusselt.hpp"
#include "coupling/lift/magnus.hpp"
#include "coupling/lift/saffman.hpp"
#include "coupling/lift/viscous_torque.hpp"
#include "coupling/thermophoresis.hpp"

using namespace silt;

namespace {

/// Calls act(model) for every model of a list, with its options at their defaults.
template <class... Model, class Act>
void each(const char* prefix, Models<Model...>, Act&& act) {
  const auto one = [&](auto model) {
    INFO(prefix << " " << model.name);
    Options options;
    options.read(prefix, model);
    act(model);
  };
  (one(Model{}), ...);
}

/// Random flows around particles from a micrometre to a centimetre, in gas and liquid, creeping and fast.
class Flows {
 public:
  double number(double low, double high) { return low * std::pow(high / low, share_(engine_)); }
  Vec3 direction() { return Vec3(normal_(engine_), normal_(engine_), normal_(engine_)).normalized(); }
  FlowAround around() {
    return {number(1e-6, 1e-2), number(0.3, 1), number(0.1, 2000), number(1e-5, 1), number(1e-6, 100)};
  }
  ShearFlow shear() {
    return {number(1e-6, 1e-2),
            number(0.1, 2000),
            number(1e-5, 1),
            number(1e-6, 10) * direction(),
            number(1e-3, 1e4) * direction(),
            number(1e-3, 1e4) * direction()};
  }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> share_{0, 1};
  std::normal_distribution<double> normal_;
};

ShearFlow turned(const ShearFlow& flow, const Eigen::Matrix3d& turn) {
  ShearFlow other = flow;
  other.slip = turn * flow.slip, other.vorticity = turn * flow.vorticity, other.spin = turn * flow.spin;
  return other;
}

}  // namespace

TEST_CASE("Every drag law is finite at rest, never drives, and grows with speed and with crowding", "[drag]") {
  each("drag", DragModels{}, [](const auto& law) {
    const bool none = std::string(law.name) == "none";
    const auto air = [&](double reynolds, double alpha) {
      return FlowAround{1e-3, alpha, 1.2, 1.8e-5, reynolds * 1.8e-5 / (1.2 * 1e-3)};
    };
    for (const double a : {0.3, 0.45, 0.7, 0.9, 1.0}) {
      double before = 0;
      for (const double reynolds : {0.0, 1e-8, 1e-3, 1.0, 30.0, 300.0, 900.0, 1e5}) {
        const double k = law.exchange(air(reynolds, a));
        REQUIRE(std::isfinite(k));
        REQUIRE((k > 0 || none || (a == 1 && reynolds == 0)));  // Ergun's bed of no particles
        // The force grows with the speed (Di Felice's coefficient alone has a dip, where its exponent has one).
        const double now = k * air(reynolds, a).speed;
        REQUIRE(now >= before * (1 - 1e-9));
        before = now;
      }
    }
    for (const double reynolds : {0.0, 10.0})
      REQUIRE(law.exchange(air(reynolds, 0.4)) >= law.exchange(air(reynolds, 0.7)));
    Flows flows;
    for (int n = 0; n < 500; ++n) {
      const double k = law.exchange(flows.around());
      REQUIRE((std::isfinite(k) && k >= 0));
    }
  });
}

TEST_CASE("Every lift is at right angles to the slip, turns with the scene and vanishes without slip", "[forces]") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -2).normalized()).toRotationMatrix();
  const auto check = [&](const auto& law) {
    Flows flows;
    for (int n = 0; n < 300; ++n) {
      ShearFlow flow = flows.shear();
      const Vec3 force = law.force(flow);
      REQUIRE(std::isfinite(force.norm()));
      CHECK(std::abs(force.dot(flow.slip)) <= 1e-12 * force.norm() * flow.slip.norm());
      CHECK((law.force(turned(flow, turn)) - turn * force).norm() <= 1e-12 * force.norm());
      flow.slip.setZero();
      CHECK(law.force(flow).norm() == 0);
      // No lift of the law's own kind without shear or relative spin.
      flow.slip = flows.direction(), flow.vorticity.setZero(), flow.spin.setZero();
      CHECK(law.force(flow).norm() == 0);
    }
  };
  each("saffman", SaffmanModels{}, check);
  each("magnus", MagnusModels{}, check);
}

TEST_CASE("Every viscous torque brakes the spin against the fluid, and the more the faster", "[forces]") {
  each("viscous_torque", ViscousTorqueModels{}, [](const auto& law) {
    Flows flows;
    for (int n = 0; n < 300; ++n) {
      ShearFlow flow = flows.shear();
      const double slow = law.exchange(flow);
      REQUIRE((std::isfinite(slow) && slow >= 0));
      flow.spin *= 2, flow.vorticity *= 2;
      CHECK(law.exchange(flow) >= slow * (1 - 1e-9));
    }
  });
}

TEST_CASE("Every thermophoretic force goes to the cold and grows with the particle", "[forces]") {
  each("thermophoresis", ThermophoresisModels{}, [](const auto& law) {
    double before = 0;
    for (const double diameter : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4}) {
      GasAround gas{};
      gas.diameter = diameter, gas.density = 1.2, gas.viscosity = 1.8e-5, gas.temperature = 300;
      gas.mean_free_path = 6.7e-8, gas.conductivity_ratio = 0.026, gas.molecule = 4.8e-26;
      const double factor = law.factor(gas);  // F = -factor grad T
      REQUIRE((std::isfinite(factor) && factor >= before));
      before = factor;
    }
    CHECK((before > 0 || std::string(law.name) == "none"));
  });
}

TEST_CASE("Every law of heat transfer gives a lone sphere at rest Nu = 2 and more in a faster flow", "[heat]") {
  each("nusselt", NusseltModels{}, [](const auto& law) {
    CHECK(law.nusselt({0, 0.7, 1}) == Approx(2).epsilon(1e-12));
    for (const double prandtl : {0.7, 7.0, 100.0})
      for (const double alpha : {0.4, 0.7, 1.0}) {
        double before = 0;
        for (const double reynolds : {0.0, 0.1, 10.0, 1e3, 1e5}) {
          const double now = law.nusselt({reynolds, prandtl, alpha});
          REQUIRE((std::isfinite(now) && now > before));
          before = now;
        }
      }
  });
}
