#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "coupling/drag/drag_models.hpp"

using namespace silt;

namespace {
constexpr double pi = std::numbers::pi;
/// A sphere in air such that rho d |u - v| / mu = reynolds.
FlowAround air(double reynolds, double alpha, double d = 1e-3) {
  return {d, alpha, 1.2, 1.8e-5, reynolds * 1.8e-5 / (1.2 * d)};
}
double force(const FlowAround& flow, double exchange) { return exchange * flow.speed; }
}  // namespace

TEST_CASE("Stokes' drag is 3 pi mu d, less by Cunningham's factor in a rarefied gas", "[drag]") {
  const auto flow = air(0.1, 1, 1e-6);
  CHECK(StokesDrag{}.exchange(flow) == Approx(3 * pi * 1.8e-5 * 1e-6));
  StokesDrag slip;
  slip.mean_free_path = 0.068e-6;
  // Kn = 0.136: C_c = 1 + 0.136 (1.257 + 0.4 exp(-8.088)) = 1.17097
  CHECK(StokesDrag{}.exchange(flow) / slip.exchange(flow) == Approx(1.170968).epsilon(1e-6));
}

TEST_CASE("Schiller-Naumann gives the drag coefficients of its formula", "[drag]") {
  for (const auto& [reynolds, coefficient] : std::vector<std::pair<double, double>>{
           {1, 24 * 1.15}, {100, 0.24 * (1 + 0.15 * std::pow(100, 0.687))}, {1e4, 0.44}}) {
    const auto flow = air(reynolds, 0.6);
    const double area = pi / 4 * 1e-6;
    CHECK(force(flow, SchillerNaumannDrag{}.exchange(flow)) ==
          Approx(coefficient * 0.5 * 1.2 * area * flow.speed * flow.speed));
  }
}

TEST_CASE("Gidaspow's drag of all particles in a volume is Ergun's and Wen-Yu's beta", "[drag]") {
  const double d = 1e-3, volume = pi / 6 * d * d * d, rho = 1.2, mu = 1.8e-5;
  for (const double reynolds : {0.5, 50.0, 5000.0}) {
    for (const double a : {0.4, 0.6, 0.79}) {
      const auto flow = air(reynolds, a);
      const double beta = 150 * (1 - a) * (1 - a) * mu / (a * d * d) + 1.75 * (1 - a) * rho * flow.speed / d;
      CHECK(GidaspowDrag{}.exchange(flow) * (1 - a) / volume == Approx(beta));
      CHECK(ErgunDrag{}.exchange(flow) * (1 - a) / volume == Approx(beta));
    }
    for (const double a : {0.81, 0.95}) {
      const auto flow = air(reynolds, a);
      const double re = a * reynolds, c = re > 1000 ? 0.44 : 24 / re * (1 + 0.15 * std::pow(re, 0.687));
      const double beta = 0.75 * c * a * (1 - a) * rho * flow.speed / d * std::pow(a, -2.65);
      CHECK(GidaspowDrag{}.exchange(flow) * (1 - a) / volume == Approx(beta));
      CHECK(WenYuDrag{}.exchange(flow) * (1 - a) / volume == Approx(beta));
    }
  }
}

TEST_CASE("Ergun's drag with the pressure gradient it causes gives Ergun's pressure drop of a fixed bed", "[drag]") {
  // Model A: the fluid feels -a grad p - n k u = 0 with n V_p = 1 - a, so grad p = -n k u / a; Ergun: 150 (1-a)^2 mu
  // U/(a^3 d^2) + 1.75 (1-a) rho U^2/(a^3 d).
  const double d = 1e-3, a = 0.42, rho = 1.2, mu = 1.8e-5, speed = 0.7, superficial = a * speed;
  const double number = (1 - a) / (pi / 6 * d * d * d);
  const double drop = number * ErgunDrag{}.exchange({d, a, rho, mu, speed}) * speed / a;
  const double ergun = 150 * (1 - a) * (1 - a) * mu * superficial / (a * a * a * d * d) +
                       1.75 * (1 - a) * rho * superficial * superficial / (a * a * a * d);
  CHECK(drop == Approx(ergun));
}

TEST_CASE("blended Gidaspow joins its two branches smoothly and keeps them away from the joint", "[drag]") {
  GidaspowDrag blended;
  blended.blending = true;
  const double jump = std::abs(blended.exchange(air(50, 0.8 + 1e-7)) / blended.exchange(air(50, 0.8 - 1e-7)) - 1);
  CHECK(jump < 1e-4);
  CHECK(blended.exchange(air(50, 0.8)) ==
        Approx(0.5 * (ErgunDrag{}.exchange(air(50, 0.8)) + WenYuDrag{}.exchange(air(50, 0.8)))));
  CHECK(blended.exchange(air(50, 0.5)) == Approx(ErgunDrag{}.exchange(air(50, 0.5))).epsilon(0.01));
  CHECK(blended.exchange(air(50, 0.98)) == Approx(WenYuDrag{}.exchange(air(50, 0.98))).epsilon(0.02));
}

TEST_CASE("Di Felice's exponent is 3.7 in creeping and in turbulent flow and least, 3.05, at Re = 10^1.5", "[drag]") {
  DiFeliceDrag law;
  const double a = 0.5;
  for (const auto& [reynolds, chi] :
       std::vector<std::pair<double, double>>{{1e-6, 3.7}, {std::pow(10, 1.5) / a, 3.05}, {1e9, 3.7}}) {
    // Single sphere in the superficial velocity, area and density of air().
    const auto flow = air(reynolds, a);
    const double re = a * reynolds, c = std::pow(0.63 + 4.8 / std::sqrt(re), 2);
    const double single = c * 0.5 * 1.2 * pi / 4 * 1e-6 * std::pow(a * flow.speed, 2);
    CHECK(force(flow, law.exchange(flow)) == Approx(single * std::pow(a, -chi)).epsilon(1e-9));
  }
  CHECK(law.exchange(air(0, a)) == Approx(3 * pi * 1.8e-5 * 1e-3 * 0.96 * std::pow(a, 1 - 3.7)));
}

TEST_CASE("Beetstra's drag tends to Carman-Kozeny's in a creeping packed bed and to a single sphere's in a dilute one",
          "[drag]") {
  const double a = 0.4, s = 0.6;
  CHECK(BeetstraDrag{}.exchange(air(0, a)) ==
        Approx(3 * pi * 1.8e-5 * 1e-3 * a * (10 * s / (a * a) + a * a * (1 + 1.5 * std::sqrt(s)))));
  CHECK(BeetstraDrag{}.exchange(air(1e-4, 1)) == Approx(3 * pi * 1.8e-5 * 1e-3).epsilon(1e-3));
}

TEMPLATE_TEST_CASE("every drag law is finite at rest, positive, and grows with speed and with crowding", "[drag]",
                   StokesDrag, SchillerNaumannDrag, WenYuDrag, ErgunDrag, GidaspowDrag, DiFeliceDrag, BeetstraDrag) {
  const TestType law;
  for (const double a : {0.3, 0.45, 0.7, 0.9, 1.0}) {
    double before = 0;
    for (const double reynolds : {0.0, 1e-8, 1e-3, 1.0, 30.0, 300.0, 900.0, 1e5}) {
      const double k = law.exchange(air(reynolds, a));
      REQUIRE(std::isfinite(k));
      REQUIRE((k > 0 || (a == 1 && reynolds == 0)));  // Ergun's bed of no particles
      // The force grows with the speed (Di Felice's coefficient alone has a dip, where its exponent has one).
      const double now = k * air(reynolds, a).speed;
      REQUIRE(now >= before * (1 - 1e-9));
      before = now;
    }
  }
  for (const double reynolds : {0.0, 10.0})
    REQUIRE(law.exchange(air(reynolds, 0.4)) >= law.exchange(air(reynolds, 0.7)));
}

TEST_CASE("an unknown drag law is refused with the list of known ones", "[drag]") {
  Options options;
  options.set("drag_type", "gidaspw");
  CHECK_THROWS_AS(DragModels::read(options, "drag", "gidaspow", "drag law"), UserError);
  Options chosen;
  chosen.set("drag_type", "di_felice");
  chosen.set("drag_single", "schiller_naumann");
  const auto law = DragModels::read(chosen, "drag", "gidaspow", "drag law");
  REQUIRE(std::holds_alternative<DiFeliceDrag>(law));
  CHECK(std::get<DiFeliceDrag>(law).schiller_naumann);
}
