// The energy equation of incompressible flow, both schemes.
#include <algorithm>
#include <catch2/catch.hpp>

#include "flow_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

constexpr double pi = M_PI;

bool flat(const std::string& cell) { return cell == "quadrilateral" || cell == "triangle"; }

FlowCase::Settings box(const std::string& cell, int n, const std::string& scheme) {
  const std::string k = std::to_string(n);
  return {{"mesh_cell", cell},
          {"mesh_upper", flat(cell) ? "1, 1, 0" : "1, 1, 0.5"},
          {"mesh_cells", flat(cell) ? k + ", " + k : k + ", " + k + ", " + std::to_string(n / 2)},
          {"fluid_scheme", scheme},
          {"fluid_density", "2"},
          {"fluid_viscosity", "0.1"},
          {"fluid_energy", "yes"},
          {"fluid_heat_capacity", "3"},
          {"fluid_conductivity", "0.3"}};
}

void set_all(FlowCase::Settings& settings, const std::string& cell, const std::string& property,
             const std::string& value) {
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    if (!flat(cell) || name[0] != 'z') settings.push_back({"boundary_" + std::string(name) + "_" + property, value});
}

/// T = 300 + sin(pi x) cos(pi y) cos(t), carried by U = (0.5, -0.3) through alpha = 0.6 + 0.2 sin(pi x) sin(pi y),
/// held by a response that dwarfs the other forces: error at t = 0.5.
double manufactured(const std::string& cell, int n, const std::string& scheme) {
  auto settings = box(cell, n, scheme);
  set_all(settings, cell, "type", "velocity");
  set_all(settings, cell, "velocity", "0.5, -0.3, 0");
  set_all(settings, cell, "temperature_type", "given");
  set_all(settings, cell, "temperature_value", "300 + sin(pi*x)*cos(pi*y)*cos(t)");
  const std::string alpha = "(0.6 + 0.2*sin(pi*x)*sin(pi*y))";
  settings.push_back({"fluid_initial_velocity", "0.5/" + alpha + ", -0.3/" + alpha + ", 0"});
  settings.push_back({"fluid_initial_temperature", "300 + sin(pi*x)*cos(pi*y)"});
  // rho c_p (alpha T_t + U.grad T) - lambda div(alpha grad T)
  settings.push_back({"fluid_heat_source",
                      "6*(-" + alpha +
                          "*sin(pi*x)*cos(pi*y)*sin(t) + pi*cos(t)*(0.5*cos(pi*x)*cos(pi*y) + 0.3*sin(pi*x)*sin(pi*y)))"
                          " - 0.3*cos(t)*(-2*pi^2*" +
                          alpha +
                          "*sin(pi*x)*cos(pi*y) + 0.2*pi^2*(cos(pi*x)*sin(pi*y)*cos(pi*x)*cos(pi*y) - "
                          "sin(pi*x)*cos(pi*y)*sin(pi*x)*sin(pi*y)))"});
  FlowCase flow(settings);
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    const Vec3 x = flow.position(i);
    flow.fluid->load().void_fraction[i] = 0.6 + 0.2 * std::sin(pi * x.x()) * std::sin(pi * x.y());
    flow.fluid->load().response[i] = 1e6;  // holds the velocity
  }
  for (int k = 0; k < n; ++k) flow.advance(0.5 / n);
  return flow.error(flow.fluid->temperature(), 1, [&](const Vec3& x) {
    return Vec3(300 + std::sin(pi * x.x()) * std::cos(pi * x.y()) * std::cos(flow.time), 0, 0);
  });
}

double boundary_heat(const Fluid& fluid) {
  double sum = 0;
  for (const auto& flow : fluid.boundary_flow()) sum += flow.heat_flow;
  return sum;
}

}  // namespace

TEST_CASE("temperature converges with order 2 in space and time, for every cell and both schemes", "[fluid][energy]") {
  for (const char* scheme : {"pressure_correction", "monolithic"})
    for (const char* cell : {"triangle", "quadrilateral", "tetrahedron", "hexahedron"}) {
      const int n = flat(cell) ? 16 : 8;
      const double coarse = manufactured(cell, n / 2, scheme), fine = manufactured(cell, n, scheme);
      INFO(scheme << ", " << cell << ": " << coarse << ", " << fine);
      CHECK(std::log2(coarse / fine) > (flat(cell) ? 1.85 : 1.75));
    }
}

TEST_CASE("a uniform temperature stays uniform in any flow, also where the void fraction changes", "[fluid][energy]") {
  for (const char* scheme : {"pressure_correction", "monolithic"}) {
    auto settings = box("quadrilateral", 8, scheme);
    for (const char* wall : {"y_min", "y_max"})
      settings.push_back({"boundary_" + std::string(wall) + "_type", "no_slip"});
    settings.push_back({"boundary_x_min_type", "velocity"});
    settings.push_back({"boundary_x_min_velocity", "4*y*(1-y), 0, 0"});
    settings.push_back({"boundary_x_min_temperature_value", "350"});
    settings.push_back({"boundary_x_max_type", "pressure"});
    settings.push_back({"fluid_initial_temperature", "350"});
    FlowCase flow(settings);
    for (int k = 0; k < 6; ++k) {
      for (int i = 0; i < flow.mesh->nodes; ++i) {
        double& alpha = flow.fluid->load().void_fraction[i];
        const double before = alpha, x = flow.position(i).x();
        alpha = 0.7 + 0.2 * std::sin(5 * x + k);
        flow.fluid->load().void_fraction_rate[i] = k > 0 ? (alpha - before) / 0.05 : 0;
      }
      flow.advance(0.05);
    }
    for (double T : flow.fluid->temperature()) CHECK(T == Approx(350).epsilon(1e-12));
  }
}

TEST_CASE("the heat that the fluid gains is what sources, particles and boundaries give", "[fluid][energy][mpi]") {
  for (const char* scheme : {"pressure_correction", "monolithic"}) {
    auto settings = box("hexahedron", 6, scheme);
    settings.push_back({"fluid_order", "1"});
    settings.push_back({"fluid_expansion", "0.01"});
    settings.push_back({"fluid_reference_temperature", "290"});
    settings.push_back({"fluid_initial_temperature", "300 + 5*x"});
    settings.push_back({"fluid_heat_source", "20*x*y"});
    settings.push_back({"fluid_ksp_rtol", "1e-10"});
    set_all(settings, "hexahedron", "type", "no_slip");
    settings.push_back({"boundary_x_min_temperature_type", "given"});
    settings.push_back({"boundary_x_min_temperature_value", "310 + y"});
    settings.push_back({"boundary_x_max_temperature_type", "flux"});
    settings.push_back({"boundary_x_max_temperature_flux", "40"});
    settings.push_back({"boundary_y_max_temperature_type", "heat_transfer"});
    settings.push_back({"boundary_y_max_temperature_value", "280"});
    settings.push_back({"boundary_y_max_temperature_coefficient", "5"});
    FlowCase flow(settings, Vec3(0, -9.81, 0));
    const auto& T = flow.fluid->temperature();
    double heat = 0;
    for (int k = 0; k < 3; ++k) {
      auto& load = flow.fluid->load();
      double given = 0;
      for (int i = 0; i < flow.mesh->nodes; ++i) {
        load.heat[i] = 0.3 * flow.position(i).x();
        load.heat_response[i] = 0.2;
      }
      const double before = heat;
      const FluidStep step = flow.advance(0.02);
      heat = step.heat;
      for (int i = 0; i < flow.mesh->owned_nodes; ++i)
        given += load.heat[i] - load.heat_response[i] * flow.fluid->temperature_change()[i];
      given = mpi_sum(given);
      const double volume_source = 20 * 0.25 * 0.5;
      const double out = boundary_heat(*flow.fluid);
      if (k > 0) CHECK((heat - before) / 0.02 == Approx(volume_source + given - out).epsilon(2e-6));
    }
    CHECK(flow.value(flow.fluid->velocity(), 3, 1, Vec3(5.0 / 6, 0.5, 0.25)) > 0);  // the warm side rises
    CHECK(T.size() == static_cast<size_t>(flow.mesh->nodes));
  }
}

TEST_CASE("fluid that flows through leaves with the heat it was given", "[fluid][energy][mpi]") {
  for (const char* scheme : {"pressure_correction", "monolithic"}) {
    auto settings = box("quadrilateral", 12, scheme);
    for (const char* wall : {"y_min", "y_max"})
      settings.push_back({"boundary_" + std::string(wall) + "_type", "no_slip"});
    settings.push_back({"boundary_y_min_temperature_type", "flux"});
    settings.push_back({"boundary_y_min_temperature_flux", "60"});
    settings.push_back({"boundary_x_min_type", "velocity"});
    settings.push_back({"boundary_x_min_velocity", "6*y*(1-y), 0, 0"});
    settings.push_back({"boundary_x_min_temperature_value", "300"});
    settings.push_back({"boundary_x_max_type", "pressure"});
    settings.push_back({"fluid_reference_temperature", "300"});
    settings.push_back({"fluid_initial_temperature", "300"});
    settings.push_back({"fluid_initial_velocity", "6*y*(1-y), 0, 0"});
    FlowCase flow(settings);
    for (int k = 0; k < 60; ++k) flow.advance(k < 20 ? 0.1 : 2.0);
    const auto flows = flow.fluid->boundary_flow();
    const auto& names = flow.mesh->boundaries;
    double in = 0, out = 0;
    for (size_t b = 0; b < names.size(); ++b) (names[b] == "x_max" ? out : in) += flows[b].heat_flow;
    CHECK(out == Approx(-in).epsilon(1e-5));
    CHECK(in == Approx(-60).epsilon(1e-12));  // what enters brings nothing: it is as warm as the reference
  }
}

TEST_CASE("conduction between walls of a wall temperature and a heat-transfer coefficient is linear",
          "[fluid][energy]") {
  auto settings = box("triangle", 6, "pressure_correction");
  set_all(settings, "triangle", "type", "no_slip");
  settings.push_back({"fluid_initial_temperature", "300"});
  settings.push_back({"boundary_x_min_temperature_type", "given"});
  settings.push_back({"boundary_x_min_temperature_value", "400"});
  settings.push_back({"boundary_x_max_temperature_type", "heat_transfer"});
  settings.push_back({"boundary_x_max_temperature_value", "300"});
  settings.push_back({"boundary_x_max_temperature_coefficient", "0.6"});
  FlowCase flow(settings);
  for (int k = 0; k < 8; ++k) flow.advance(1000);
  // q = (400 - 300)/(1/0.3 + 1/0.6) = 20
  CHECK(flow.value(flow.fluid->temperature(), 1, 0, Vec3(1, 0.5, 0)) == Approx(300 + 20 / 0.6).epsilon(1e-6));
  CHECK(flow.value(flow.fluid->temperature(), 1, 0, Vec3(0.5, 0.5, 0)) == Approx(400 - 20 * 0.5 / 0.3).epsilon(1e-6));
}

TEST_CASE("fluid that enters an outlet is as warm as it was there at the start", "[fluid][energy]") {
  for (const char* scheme : {"pressure_correction", "monolithic"}) {
    auto settings = box("quadrilateral", 6, scheme);
    for (const char* wall : {"y_min", "y_max"})
      settings.push_back({"boundary_" + std::string(wall) + "_type", "no_slip"});
    for (const char* opening : {"x_min", "x_max"})
      settings.push_back({"boundary_" + std::string(opening) + "_type", "pressure"});
    settings.push_back({"boundary_x_max_pressure", "1"});  // drives the fluid in here
    settings.push_back({"fluid_initial_temperature", "300 + 10*x"});
    FlowCase flow(settings);
    for (int k = 0; k < 80; ++k) flow.advance(0.5);
    const auto T = flow.fluid->temperature();
    CHECK(flow.value(flow.fluid->velocity(), 3, 0, Vec3(0.5, 0.5, 0)) < -0.5);
    CHECK(*std::max_element(T.begin(), T.end()) == Approx(310).epsilon(1e-6));
    CHECK(*std::min_element(T.begin(), T.end()) == Approx(310).epsilon(1e-6));
  }
}

TEST_CASE("thermal conditions that make no sense are refused", "[fluid][energy]") {
  auto settings = box("quadrilateral", 4, "pressure_correction");
  set_all(settings, "quadrilateral", "type", "no_slip");
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("-fluid_initial_temperature is missing"));
  settings.push_back({"fluid_initial_temperature", "300"});
  settings.push_back({"boundary_x_min_temperature_flux", "3"});
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("-boundary_x_min_temperature_flux has no meaning"));
  settings.back() = {"boundary_x_min_temperature_type", "given"};
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("-boundary_x_min_temperature_value is missing"));
  settings.back() = {"boundary_x_min_temperature_type", "inflow"};
  CHECK_THROWS_WITH(FlowCase(settings), Catch::Contains("inflow is for boundaries of type velocity and mass_flow"));
  settings.back() = {"fluid_energy", "no"};
  CHECK_THROWS_WITH(FlowCase(settings),
                    Catch::Contains("-fluid_heat_capacity has no meaning without -fluid_energy yes"));
}
