#include <catch2/catch.hpp>

#include "gas_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

/// A normal shock of Mach 3 or 1.05 at x = 0.5 (Rankine and Hugoniot: M 3, p 10.3333, rho 3.857; M 1.05, p 1.1195833).
struct Shock {
  double mach, p, density, u;
  explicit Shock(double mach_in) : mach(mach_in) {
    const double m2 = mach * mach;
    u = mach * std::sqrt(1.4);
    p = 1 + 2.8 / 2.4 * (m2 - 1);
    density = 2.4 * m2 / (0.4 * m2 + 2);
  }
  auto settings(const char* sensor) const {
    auto result = gas("quadrilateral", "40, 1");
    result[1].second = "1, 0.025, 0";
    const auto split = [&](double left, double right) {
      return "x < 0.5 ? " + std::to_string(left) + " : " + std::to_string(right);
    };
    set(result, "y_min y_max", "type", "slip");
    set(result, "x_min", "type", "supersonic_inflow");
    set(result, "x_min", "pressure", "1");
    set(result, "x_min", "velocity", std::to_string(u) + ", 0, 0");
    set(result, "x_min", "temperature_value", "1");
    set(result, "x_max", "type", "pressure");
    set(result, "x_max", "pressure", std::to_string(p));
    result.push_back({"fluid_order", "1"});
    result.push_back({"fluid_shock_sensor", sensor});
    result.push_back({"fluid_initial_pressure", split(1, p)});
    result.push_back({"fluid_initial_temperature", split(1, p / density)});
    result.push_back({"fluid_initial_velocity", split(u, u / density) + ", 0, 0"});
    return result;
  }
};

}  // namespace

TEST_CASE("the shock sensor leaves plane shocks as they are, strong and weak", "[fluid][compressible]") {
  for (const double mach : {3.0, 1.05}) {
    const Shock shock(mach);
    std::vector<double> pressure[2];
    GasFrozen frozen[2];
    for (const int k : {0, 1}) {
      FlowCase flow(shock.settings(k ? "1" : "0"));
      while (flow.time < 1) flow.advance(0.01);
      CHECK(flow.value(flow.fluid->pressure(), 1, 0, Vec3(0.8, 0, 0)) == Approx(shock.p).epsilon(0.005));
      frozen[k] = gas_of(flow).last_step().frozen;
      pressure[k].assign(flow.fluid->pressure().begin(), flow.fluid->pressure().end());
    }
    for (size_t i = 0; i < pressure[0].size(); ++i) CHECK(pressure[1][i] == Approx(pressure[0][i]).epsilon(1e-4));
    // Viscosity is added in the shock's plane, none through it.
    double added = 0;
    for (size_t c = 0; c < frozen[1].viscosity.size(); ++c) {
      const double through = frozen[1].normal[2 * c], along = frozen[1].normal[2 * c + 1];
      CHECK(frozen[1].viscosity[c] - through * through == Approx(frozen[0].viscosity[c]).margin(1e-4));
      CHECK(std::abs(along) < 1e-6);
      added = std::max(added, through * through);
    }
    if (mach > 2)
      CHECK(added > 0.01);  // h (|u| + c)/2 is 0.06
    else
      CHECK(added == 0);
  }
}

TEST_CASE(
    "no viscosity captures a layer that shears, at any angle to the mesh, and one does where the gas is compressed",
    "[fluid][compressible]") {
  // A stream along (1, 0.3) in gas at rest, pressure and temperature uniform: the residual of cells five of which span
  // the layer is not zero. Then the same cells with a pressure that rises tenfold across the layer.
  for (const bool shock : {false, true}) {
    auto settings = gas("quadrilateral", "20, 20");
    const std::string layer = "0.5*(1 + tanh((y - 0.35 - 0.3*x)/0.06))", speed = "0.6*" + layer;
    const std::string pressure = shock ? "1 + 9*" + layer : "1";
    settings.push_back({"fluid_order", "1"});
    settings.push_back({"fluid_shock_capturing", "10"});
    settings.push_back({"fluid_initial_velocity", speed + ", 0.3*" + speed + ", 0"});
    settings.push_back({"fluid_initial_pressure", pressure});
    settings.push_back({"fluid_initial_temperature", "1"});
    set(settings, "x_min x_max y_min y_max", "type", "far_field");
    set(settings, "x_min x_max y_min y_max", "pressure", pressure);
    set(settings, "x_min x_max y_min y_max", "velocity", speed + ", 0.3*" + speed + ", 0");
    set(settings, "x_min x_max y_min y_max", "temperature_value", "1");
    FlowCase flow(settings);
    flow.advance(1e-6);
    const auto& viscosity = gas_of(flow).last_step().frozen.viscosity;
    const double most = *std::max_element(viscosity.begin(), viscosity.end());
    if (shock)
      CHECK(most > 0.01);
    else
      CHECK(most == 0);
  }
}
