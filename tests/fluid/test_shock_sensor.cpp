#include <catch2/catch.hpp>

#include "gas_case.hpp"

using namespace silt;
using namespace silt::test;

TEST_CASE("the shock sensor spreads a strong shock over more cells, and leaves its jump and a weak one alone",
          "[fluid][compressible]") {
  // Steady normal shocks of Rankine and Hugoniot: Mach 3, p 10.3333 and M 0.47519; Mach 1.05, p 1.1195833.
  const auto inside = [](bool strong, const char* sensor, double& pressure) {
    auto settings = gas("quadrilateral", "40, 1");
    settings[1].second = "1, 0.025, 0";
    const double mach = strong ? 3 : 1.05, m2 = mach * mach, u = mach * std::sqrt(1.4);
    const double p = 1 + 2.8 / 2.4 * (m2 - 1), density = 2.4 * m2 / (0.4 * m2 + 2), T = p / density;
    const auto split = [](double left, double right) {
      return "x < 0.5 ? " + std::to_string(left) + " : " + std::to_string(right);
    };
    set(settings, "y_min y_max", "type", "slip");
    set(settings, "x_min", "type", "supersonic_inflow");
    set(settings, "x_min", "pressure", "1");
    set(settings, "x_min", "velocity", std::to_string(u) + ", 0, 0");
    set(settings, "x_min", "temperature_value", "1");
    set(settings, "x_max", "type", "pressure");
    set(settings, "x_max", "pressure", std::to_string(p));
    settings.push_back({"fluid_order", "1"});
    settings.push_back({"fluid_shock_sensor", sensor});
    settings.push_back({"fluid_initial_pressure", split(1, p)});
    settings.push_back({"fluid_initial_temperature", split(1, T)});
    settings.push_back({"fluid_initial_velocity", split(u, u / density) + ", 0, 0"});
    FlowCase flow(settings);
    while (flow.time < 1) flow.advance(0.01);
    pressure = flow.value(flow.fluid->pressure(), 1, 0, Vec3(0.8, 0, 0)) / p;
    int count = 0;  // nodes of the lower side between 5 and 95 % of the jump
    for (int i = 0; i < flow.mesh->owned_nodes; ++i) {
      const double part = (flow.fluid->pressure()[static_cast<size_t>(i)] - 1) / (p - 1);
      count += flow.position(i).y() < 0.01 && part > 0.05 && part < 0.95;
    }
    return count;
  };
  double sharp, wide, weak, weak_wide;
  const int cells = inside(true, "0", sharp), more = inside(true, "1", wide);
  CHECK(sharp == Approx(1).epsilon(0.005));
  CHECK(wide == Approx(1).epsilon(0.005));
  CHECK(more > cells);
  CHECK(more < cells + 6);
  CHECK(inside(false, "0", weak) == inside(false, "1", weak_wide));
  CHECK(weak == weak_wide);
}
