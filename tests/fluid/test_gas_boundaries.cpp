// Open boundaries of compressible flow, and violent changes outside.
#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "gas_case.hpp"

using namespace silt;
using namespace silt::test;

TEST_CASE("Couette flow with heating leaves through an open boundary as it is", "[fluid][compressible]") {
  // Both walls at T = 1: u = 0.3 y, T = 1 + 0.09 Pr/(2 c_p) y (1 - y), uniform pressure; the shear along the outlet is
  // that of the inside. Without it the gas would cross the outlet at a tenth of the speed.
  for (const std::string outlet : {"pressure", "far_field"}) {
    auto settings = gas("quadrilateral", "8, 16");
    settings[5].second = "0.05";
    const std::string T = "1 + 0.09*0.71/7*y*(1 - y)";
    set(settings, "y_min y_max", "type", "no_slip");
    set(settings, "y_max", "velocity", "0.3, 0, 0");
    set(settings, "y_min y_max", "temperature_type", "given");
    set(settings, "y_min y_max", "temperature_value", "1");
    set(settings, "x_min", "type", "far_field");
    set(settings, "x_max", "type", outlet);
    set(settings, "x_min x_max", "pressure", "1");
    set(settings, outlet == "far_field" ? "x_min x_max" : "x_min", "velocity", "0.3*y, 0, 0");
    set(settings, "x_min x_max", "temperature_value", T);
    settings.push_back({"fluid_march", "steady"});
    settings.push_back({"fluid_order", "1"});
    settings.push_back({"fluid_initial_velocity", "0.3*y, 0, 0"});
    settings.push_back({"fluid_initial_pressure", "1"});
    settings.push_back({"fluid_initial_temperature", T});
    FlowCase flow(settings);
    for (int k = 0; k < 20; ++k) flow.advance(0.1 * std::pow(1.5, k));
    double speed = 0, temperature = 0, pressure = 0;
    for (int i = 0; i < flow.mesh->nodes; ++i) {
      const size_t at = static_cast<size_t>(i);
      const double y = flow.position(i).y();
      speed = std::max(speed, (vec3(flow.fluid->velocity().data() + 3 * at) - Vec3(0.3 * y, 0, 0)).norm());
      pressure = std::max(pressure, std::abs(flow.fluid->pressure()[at] - 1));
      temperature = std::max(temperature, std::abs(flow.fluid->temperature()[at] - 1 - 0.09 * 0.71 / 7 * y * (1 - y)));
    }
    INFO(outlet);
    CHECK(speed < 3e-4);
    CHECK(pressure < 1e-3);
    CHECK(temperature < 3e-5);
  }
}

TEST_CASE("Poiseuille flow leaves an open pipe as it is, come as a velocity or as a mass flow with its profile",
          "[fluid][compressible]") {
  for (const std::string inlet : {"far_field", "mass_flow"}) {
    // Gravity drives it at uniform pressure: u = g rho (1 - r^2)/(4 mu), slow enough to heat nothing.
    auto settings = gas("quadrilateral", "8, 16");
    settings[5].second = "0.5";
    const std::string u = "0.05*(1 - y^2)";
    settings.push_back({"fluid_symmetry", "axisymmetric"});
    set(settings, "y_min", "type", "slip");
    set(settings, "y_max", "type", "no_slip");
    set(settings, "y_max", "temperature_type", "given");
    set(settings, "x_min", "type", inlet);
    if (inlet == "far_field") {
      set(settings, "x_min", "velocity", u + ", 0, 0");
      set(settings, "x_min", "pressure", "1");
    } else {  // the flow through the whole circumference
      set(settings, "x_min", "mass_flow", "0.05*pi/2");
      set(settings, "x_min", "profile", "3 - 3*y^2");
    }
    set(settings, "x_max", "type", "pressure");
    set(settings, "x_max", "pressure", "1");
    set(settings, "x_min x_max y_max", "temperature_value", "1");
    settings.push_back({"fluid_march", "steady"});
    settings.push_back({"fluid_order", "1"});
    settings.push_back({"fluid_initial_velocity", u + ", 0, 0"});
    settings.push_back({"fluid_initial_pressure", "1"});
    settings.push_back({"fluid_initial_temperature", "1"});
    FlowCase flow(settings, Vec3(0.1, 0, 0));
    for (int k = 0; k < 20; ++k) flow.advance(0.1 * std::pow(1.5, k));
    for (const double x : {0.5, 0.875, 1.0})
      for (const double y : {0.0, 0.25, 0.5, 0.75})
        CHECK(flow.value(flow.fluid->velocity(), 3, 0, Vec3(x, y, 0)) == Approx(0.05 * (1 - y * y)).epsilon(0.01));
    CHECK(flow.fluid->boundary_flow()[0].mass_flow ==
          Approx(-0.05 * M_PI / 2).epsilon(inlet == "far_field" ? 0.01 : 1e-9));
    // Weight and friction balance: what is lost on the wall came in along the pipe.
    double force = 0;
    for (const auto& f : flow.fluid->boundary_flow()) force += f.force.x();
    CHECK(force == Approx(0.1 * M_PI).epsilon(1e-3));
  }
}

TEST_CASE("a jet that starts at once, or whose pressure rises at once, is found in every step, and no mass is lost",
          "[fluid][compressible][mpi]") {
  // Sonic nozzle of radius 0.5 at 16 times the pressure around, on coarse cells, marched in time.
  for (const bool sudden : {false, true}) {
    auto settings = gas("quadrilateral", "24, 12");
    settings[1].second = "4, 2, 0";
    settings[5].second = "1e-3";
    const std::string p = sudden ? "y < 0.5 ? (t > 0.5 ? 16 : 1.9) : 1" : "y < 0.5 ? 16 : 1";
    settings.push_back({"fluid_symmetry", "axisymmetric"});
    set(settings, "x_min x_max y_max", "type", "far_field");
    set(settings, "y_min", "type", "slip");
    set(settings, "x_min", "pressure", p);
    set(settings, "x_min", "velocity", "y < 0.5 ? 1.0802 : 0, 0, 0");
    set(settings, "x_min", "temperature_value", "y < 0.5 ? 0.8333 : 1");
    set(settings, "x_max y_max", "pressure", "1");
    set(settings, "x_max y_max", "temperature_value", "1");
    settings.push_back({"fluid_initial_pressure", "1"});
    settings.push_back({"fluid_initial_temperature", "1"});
    FlowCase flow(settings);
    double dt = 0.2, least = 1, fastest = 0;
    int cut = 0, rescued = 0, steps = 0;
    for (; flow.time < 2 && steps < 200; ++steps) {
      try {
        const FluidStep step = flow.advance(dt);
        rescued += step.first_order;
        CHECK(std::abs(step.mass_residual) < 1e-2);
        dt = std::min(0.2, 1.3 * dt);
      } catch (const SolveFailure&) {
        dt *= 0.5;
        ++cut;
      }
      for (int i = 0; i < flow.mesh->nodes; ++i) {
        const size_t at = static_cast<size_t>(i);
        least = std::min({least, flow.fluid->pressure()[at], flow.fluid->temperature()[at]});
        fastest = std::max(fastest, vec3(flow.fluid->velocity().data() + 3 * at).norm());
      }
    }
    INFO(sudden << ": " << steps << " steps, " << rescued << " of first order, cut " << cut);
    CHECK(flow.time >= 2);
    CHECK(rescued > 0);
    CHECK(cut <= 6);
    CHECK(mpi_min(least) > 0);
    CHECK(mpi_max(fastest) < std::sqrt(7.0));  // nothing is faster than expansion into vacuum
  }
}

TEST_CASE("a stream leaves into gas at rest at the pressure there, and gas comes from rest at its stagnation pressure",
          "[fluid][compressible]") {
  // Frictionless duct, M = 0.4. Leaving into gas at rest: its pressure, whatever the speed (the characteristic
  // condition of gas at rest would raise it by rho c u, 56 %). Drawn from rest: p = p_0 (1 + 0.2 M^2)^-3.5, T = T_0/(1
  // + 0.2 M^2).
  for (const bool leaves : {true, false}) {
    auto settings = gas("quadrilateral", "8, 2");
    const double ratio = 1 + 0.2 * 0.16, T = leaves ? 0.9 : 1 / ratio, u = 0.4 * std::sqrt(1.4 * T);
    set(settings, "y_min y_max", "type", "slip");
    set(settings, "x_min", "type", leaves ? "velocity" : "far_field");
    set(settings, "x_max", "type", leaves ? "far_field" : "velocity");
    set(settings, leaves ? "x_min" : "x_max", "velocity", std::to_string(u) + ", 0, 0");
    if (leaves) set(settings, "x_min", "temperature_value", "0.9");
    if (!leaves) set(settings, "x_max", "temperature_type", "adiabatic");
    set(settings, leaves ? "x_max" : "x_min", "pressure", "1");
    set(settings, leaves ? "x_max" : "x_min", "temperature_value", "1");
    settings.push_back({"fluid_march", "steady"});
    settings.push_back({"fluid_order", "1"});
    settings.push_back({"fluid_initial_pressure", "1"});
    settings.push_back({"fluid_initial_temperature", "1"});
    FlowCase flow(settings);
    for (int k = 0; k < 40; ++k) flow.advance(std::min(5.0, 0.1 * std::pow(1.3, k)));
    INFO(leaves);
    for (const double x : {0.0, 0.5, 1.0}) {
      const Vec3 at(x, 0.5, 0);
      CHECK(flow.value(flow.fluid->pressure(), 1, 0, at) == Approx(leaves ? 1.0 : std::pow(ratio, -3.5)).epsilon(1e-4));
      CHECK(flow.value(flow.fluid->temperature(), 1, 0, at) == Approx(T).epsilon(1e-4));
      CHECK(flow.value(flow.fluid->velocity(), 3, 0, at) == Approx(u).epsilon(1e-4));
    }
  }
}

TEST_CASE("sound leaves through a far field", "[fluid][compressible]") {
  // A pulse of one part in a thousand travels to the right and out: what comes back is less than a fiftieth of it.
  auto settings = gas("quadrilateral", "64, 2");
  const std::string pulse = "exp(-((x - 0.5)/0.1)^2)";
  set(settings, "y_min y_max", "type", "slip");
  set(settings, "x_min x_max", "type", "far_field");
  set(settings, "x_min x_max", "pressure", "1");
  set(settings, "x_min x_max", "temperature_value", "1");
  settings.push_back({"fluid_initial_velocity", "1e-3/sqrt(1.4)*" + pulse + ", 0, 0"});
  settings.push_back({"fluid_initial_pressure", "1 + 1e-3*" + pulse});
  settings.push_back({"fluid_initial_temperature", "1 + 1e-3*0.4/1.4*" + pulse});
  FlowCase flow(settings);
  const auto strength = [&] {
    double most = 0;
    for (const double p : flow.fluid->pressure()) most = std::max(most, std::abs(p - 1));
    return mpi_max(most);
  };
  while (flow.time < 0.2) flow.advance(0.005);
  CHECK(strength() > 0.8e-3);
  while (flow.time < 0.8) flow.advance(0.005);
  CHECK(strength() < 2e-5);
}

TEST_CASE("a gas without viscosity takes no pressure where its velocity is given, an incompressible one never does",
          "[fluid][compressible]") {
  auto settings = gas("quadrilateral", "3, 3");
  set(settings, "y_min y_max", "type", "slip");
  set(settings, "x_min", "type", "velocity");
  set(settings, "x_min", "velocity", "0.1, 0, 0");
  set(settings, "x_min", "temperature_value", "1");
  set(settings, "x_min", "pressure", "1");
  set(settings, "x_max", "type", "pressure");
  set(settings, "x_max", "pressure", "1");
  settings.push_back({"fluid_initial_pressure", "1"});
  settings.push_back({"fluid_initial_temperature", "1"});
  settings.push_back({"fluid_initial_velocity", "0.1, 0, 0"});
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("-boundary_x_min_pressure: a gas without viscosity"));
  settings.push_back({"fluid_viscosity", "0.01"});
  FlowCase flow(settings);
  flow.advance(0.1);
  for (const double p : flow.fluid->pressure()) CHECK(p == Approx(1));
}
