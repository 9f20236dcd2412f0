// Periodic flows driven by a pressure gradient or at a given mass flow, and walls that turn.
#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "flow_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

FlowCase::Settings duct(const std::string& scheme, const std::string& model) {
  return {{"mesh_cell", "quadrilateral"},  {"mesh_upper", "2, 1, 0"},     {"mesh_cells", "12, 10"},
          {"mesh_periodic", "1, 0"},       {"fluid_scheme", scheme},      {"fluid_model", model},
          {"fluid_density", "2"},          {"fluid_viscosity", "0.3"},    {"boundary_y_min_type", "no_slip"},
          {"boundary_y_max_type", "slip"}, {"fluid_drive_direction", "x"}};
}

/// A plug whose void fraction falls to 0.5 in the middle, with drag.
void plug(FlowCase& flow) {
  set_bed(
      flow, [](const Vec3& x) { return 0.75 + 0.25 * std::cos(M_PI * x.x()); },
      [](const Vec3& x) { return 4 - 4 * std::cos(M_PI * x.x()); });
}

}  // namespace

TEST_CASE("A mass flow through a periodic plug is kept exactly while it changes", "[driven][mpi]") {
  const std::string scheme = GENERATE("pressure_correction", "monolithic"), model = GENERATE("a", "b");
  auto settings = duct(scheme, model);
  settings.push_back({"fluid_drive_mass_flow", "3*sin(2*t)"});
  FlowCase flow(settings);
  for (int k = 0; k < 6; ++k) {
    plug(flow);
    const FluidStep step = flow.advance(0.1 + 0.02 * k);
    const double asked = 3 * std::sin(2 * flow.time);  // rho U H, H = 1
    INFO(scheme << ", model " << model << ", t = " << flow.time);
    CHECK(step.drive_velocity * 2 == Approx(asked).epsilon(1e-9));
    CHECK(step.momentum.x() == Approx(2 * asked).epsilon(1e-9));  // over the length of 2 m
  }
}

TEST_CASE("Both schemes find the same gradient and flow through a plug", "[driven]") {
  const std::string model = GENERATE("a", "b");
  double gradient[2], largest[2];
  int k = 0;
  for (const char* scheme : {"pressure_correction", "monolithic"}) {
    auto settings = duct(scheme, model);
    settings.push_back({"fluid_drive_velocity", "1"});
    settings.push_back({"fluid_velocity_tolerance", "1e-8"});
    FlowCase flow(settings);
    FluidStep step;
    for (int n = 0; n < 60; ++n) {
      plug(flow);
      step = flow.advance(0.1);
    }
    gradient[k] = step.drive_gradient;
    largest[k] = flow.value(flow.fluid->velocity(), 3, 0, Vec3(1, 1, 0));
    ++k;
  }
  INFO("model " << model);
  CHECK(gradient[0] == Approx(gradient[1]).epsilon(0.02));
  CHECK(largest[0] == Approx(largest[1]).epsilon(0.02));
}

TEST_CASE("In model A the particles feel the driving gradient as they feel any other", "[driven]") {
  const std::string scheme = GENERATE("pressure_correction", "monolithic");
  auto settings = duct(scheme, "a");
  settings.push_back({"fluid_drive_pressure_gradient", "0.7"});
  FlowCase flow(settings);
  flow.advance(0.1);
  const auto g = flow.fluid->pressure_gradient();
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    CHECK(g[3 * i] == Approx(-0.7).margin(1e-6));
    CHECK(g[3 * i + 1] == Approx(0).margin(1e-6));
  }
}

TEST_CASE("A driven flow speeds up by what drives it less what the walls take", "[driven]") {
  const std::string scheme = GENERATE("pressure_correction", "monolithic");
  auto settings = duct(scheme, "a");
  settings.push_back({"fluid_drive_pressure_gradient", "0.7"});
  settings.push_back({"fluid_order", "1"});
  settings.push_back({"fluid_velocity_tolerance", "1e-10"});
  FlowCase flow(settings);
  double momentum = 0;
  for (int k = 0; k < 4; ++k) {
    const FluidStep step = flow.advance(0.05);
    CHECK((step.momentum.x() - momentum) / 0.05 == Approx(step.boundary_force.x()).epsilon(1e-3));
    momentum = step.momentum.x();
  }
}

TEST_CASE("A static head stands still in a bed of uneven void fraction, in models A and B", "[driven]") {
  const std::string scheme = GENERATE("pressure_correction", "monolithic"), model = GENERATE("a", "b");
  auto settings = duct(scheme, model);
  settings.pop_back();  // no drive
  settings.push_back({"fluid_hydrostatic", "yes"});
  FlowCase flow(settings, Vec3(0, -9.81, 0));
  for (int i = 0; i < flow.mesh->nodes; ++i)
    flow.fluid->load().void_fraction[i] = 0.75 + 0.25 * std::cos(M_PI * flow.position(i).y());
  for (int k = 0; k < 3; ++k) flow.advance(0.1);
  INFO(scheme << ", model " << model);
  const double below = flow.value(flow.fluid->pressure(), 1, 0, Vec3(1, 0, 0)),
               above = flow.value(flow.fluid->pressure(), 1, 0, Vec3(1, 1, 0));
  CHECK(below - above == Approx(2 * 9.81).epsilon(1e-3));
  double fastest = 0;
  for (double u : flow.fluid->velocity()) fastest = std::max(fastest, std::abs(u));
  CHECK(fastest < 1e-3);
}

TEST_CASE("What cannot drive a flow is refused", "[driven]") {
  const auto refused = [](const FlowCase::Settings& more, const std::string& words) {
    auto settings = duct("pressure_correction", "a");
    settings.insert(settings.end(), more.begin(), more.end());
    CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains(words));
  };
  refused({}, "exactly one of");
  refused({{"fluid_drive_velocity", "1"}, {"fluid_drive_mass_flow", "1"}}, "exactly one of");
  refused({{"fluid_drive_velocity", "y"}}, "depends on the place");
  refused({{"fluid_drive_velocity", "1"}, {"fluid_drive_direction", "y"}}, "not periodic along y");
  refused({{"fluid_drive_velocity", "1"}, {"fluid_type", "prescribed"}}, "not available");
  refused({{"fluid_drive_velocity", "1"}, {"boundary_y_min_velocity", "0, 1, 0"}}, "through its own surface");
  refused({{"fluid_drive_velocity", "1"}, {"boundary_y_min_rotation_rate", "1"}}, "through its own surface");
  refused({{"fluid_drive_velocity", "1"}, {"boundary_y_max_rotation_rate", "1"}}, "has no meaning");
  refused({{"fluid_drive_velocity", "1"}, {"boundary_y_min_rotation_axis", "0, 0, 1"}}, "has no meaning");
}
