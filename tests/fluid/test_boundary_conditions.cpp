#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "flow_case.hpp"
#include "fluid/boundary/boundary_conditions.hpp"

using namespace silt;
using namespace silt::test;

namespace {

FlowCase::Settings box(const FlowCase::Settings& boundaries) {
  FlowCase::Settings settings = {{"mesh_cells", "3, 3, 3"}, {"fluid_density", "2"}, {"fluid_viscosity", "0.1"}};
  settings.insert(settings.end(), boundaries.begin(), boundaries.end());
  return settings;
}

FlowCase::Settings all_walls_but(const std::string& open, const FlowCase::Settings& conditions) {
  FlowCase::Settings settings = conditions;
  for (const std::string name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    if (open.find(name) == std::string::npos) settings.push_back({"boundary_" + name + "_type", "no_slip"});
  return box(settings);
}

std::string message(const FlowCase::Settings& settings) {
  try {
    FlowCase flow(settings);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

struct Conditions {
  Options options;
  std::unique_ptr<Mesh> mesh;
  std::unique_ptr<BoundaryConditions> boundaries;
  explicit Conditions(const FlowCase::Settings& settings) {
    for (const auto& [name, value] : settings) options.set(name, value);
    MeshOptions mesh_options;
    options.read("mesh", mesh_options);
    mesh = std::make_unique<Mesh>(mesh_options);
    boundaries = std::make_unique<BoundaryConditions>(*mesh, options, 2.0);
    boundaries->evaluate(0.5, nullptr);
  }
};

}  // namespace

TEST_CASE("A boundary without a condition or with one that does not fit is refused by name", "[fluid]") {
  using Catch::Contains;
  CHECK_THAT(message(box({{"boundary_x_min_type", "no_slip"}, {"boundary_z_max_type", "slip"}})),
             Contains("x_max, y_min, y_max, z_min") && Contains("no condition"));
  CHECK_THAT(message(all_walls_but("x_min", {{"boundary_x_min_type", "velocity"}})),
             Contains("boundary_x_min_velocity is missing"));
  CHECK_THAT(message(all_walls_but("x_min", {{"boundary_x_min_type", "mass_flow"}})),
             Contains("boundary_x_min_mass_flow is missing"));
  CHECK_THAT(message(all_walls_but("x_min", {{"boundary_x_min_type", "mass_flow"}, {"boundary_x_min_mass_flow", "y"}})),
             Contains("boundary_x_min_mass_flow: 'y' depends on the place") && Contains("-boundary_x_min_profile"));
  CHECK_THAT(message(all_walls_but("x_min", {{"boundary_x_min_type", "slip"}, {"boundary_x_min_profile", "y"}})),
             Contains("boundary_x_min_profile has no meaning"));
  CHECK_THAT(message(all_walls_but("x_min", {{"boundary_x_min_type", "slip"}, {"boundary_x_min_pressure", "1"}})),
             Contains("no meaning"));
  CHECK_THAT(message(all_walls_but("x_min", {{"boundary_x_min_type", "outflow"}})), Contains("pressure"));
}

TEST_CASE("Where boundaries meet the wall wins over the inflow and the inflow over slip", "[fluid][mpi]") {
  Conditions c(box({{"boundary_x_min_type", "velocity"},
                    {"boundary_x_min_velocity", "t, 0, 0"},
                    {"boundary_x_max_type", "pressure"},
                    {"boundary_x_max_pressure", "y"},
                    {"boundary_y_min_type", "no_slip"},
                    {"boundary_y_max_type", "no_slip"},
                    {"boundary_y_max_velocity", "0, 0, 3"},
                    {"boundary_z_min_type", "slip"},
                    {"boundary_z_max_type", "symmetry"}}));
  const auto& b = *c.boundaries;
  double flow = 0;
  std::vector<double> u(3 * c.mesh->nodes);
  for (int i = 0; i < c.mesh->nodes; ++i) vec3(&u[3 * i]) = Vec3(7, 8, 9);
  b.impose(u.data());
  for (int i = 0; i < c.mesh->nodes; ++i) {
    const Vec3 x = vec3(&c.mesh->node_coordinates[3 * i]);
    const bool inlet = x.x() < 1e-9, side = x.z() < 1e-9 || x.z() > 1 - 1e-9;
    const Vec3 expected = x.y() < 1e-9       ? Vec3(0, 0, 0)
                          : x.y() > 1 - 1e-9 ? Vec3(0, 0, 3)
                          : inlet            ? Vec3(0.5, 0, 0)
                                             : Vec3(7, 8, side ? 0 : 9);
    CHECK((vec3(&u[3 * i]) - expected).norm() < 1e-14);
    if (i < c.mesh->owned_nodes) flow += b.flow()[i];
    CHECK((b.pressure_boundary()[i] >= 0) == (x.x() > 0.999));
    if (x.x() > 0.999) CHECK(b.pressure()[i] == Approx(x.y()));
  }
  CHECK(mpi_sum(flow) == Approx(-0.5));
}

TEST_CASE("Slip fixes the normal of a face, two directions on an edge and three in a corner", "[fluid][mpi]") {
  FlowCase::Settings settings;
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    settings.push_back({"boundary_" + std::string(name) + "_type", "slip"});
  Conditions c(box(settings));
  std::vector<double> u(3 * c.mesh->nodes, 1.0);
  c.boundaries->impose(u.data());
  for (int i = 0; i < c.mesh->nodes; ++i)
    for (int d = 0; d < 3; ++d) {
      const double x = c.mesh->node_coordinates[3 * i + d];
      CHECK(u[3 * i + d] == Approx(x < 1e-9 || x > 1 - 1e-9 ? 0.0 : 1.0).margin(1e-14));
    }
}

TEST_CASE("A mass flow comes in uniformly and to the last gram", "[fluid][mpi]") {
  Conditions c(all_walls_but("x_min x_max", {{"boundary_x_min_type", "mass_flow"},
                                             {"boundary_x_min_mass_flow", "6*t"},
                                             {"boundary_x_max_type", "pressure"}}));
  // 3 kg/s at 2 kg/m3 through 1 m2.
  CHECK(c.boundaries->boundary_flow()[0] == Approx(-1.5).epsilon(1e-14));
  double fastest = 0;
  for (double u : c.boundaries->velocity()) fastest = std::max(fastest, std::abs(u));
  CHECK(mpi_max(fastest) == Approx(1.5));
}

TEST_CASE("A mass flow is spread as its profile says, whatever the profile's size", "[fluid][mpi]") {
  for (const std::string size : {"1", "7000*t"}) {
    Conditions c(all_walls_but("x_min x_max", {{"boundary_x_min_type", "mass_flow"},
                                               {"boundary_x_min_mass_flow", "6*t"},
                                               {"boundary_x_min_profile", size + "*y*(1 - y)*z*(1 - z)"},
                                               {"boundary_x_max_type", "pressure"}}));
    // U = 1.5*36 y (1 - y) z (1 - z), of fourth degree: exact but for the rule of the facets.
    CHECK(c.boundaries->boundary_flow()[0] == Approx(-1.5).epsilon(1e-12));
    double wrong = 0, fastest = 0;
    for (int i = 0; i < c.mesh->nodes; ++i) {
      const Vec3 x = vec3(&c.mesh->node_coordinates[3 * i]), u = vec3(&c.boundaries->velocity()[3 * i]);
      if (x.x() > 1e-9) continue;
      const double expected = 54 * x.y() * (1 - x.y()) * x.z() * (1 - x.z());
      wrong = std::max(wrong, (u - Vec3(expected, 0, 0)).norm());
      fastest = std::max(fastest, expected);
    }
    CHECK(mpi_max(fastest) == Approx(54.0 * 4 / 81));
    CHECK(mpi_max(wrong) < 1e-10);
  }
  CHECK_THROWS_WITH(Conditions(all_walls_but("x_min x_max", {{"boundary_x_min_type", "mass_flow"},
                                                             {"boundary_x_min_mass_flow", "1"},
                                                             {"boundary_x_min_profile", "y - 0.5"},
                                                             {"boundary_x_max_type", "pressure"}})),
                    Catch::Contains("-boundary_x_min_profile: its integral over the boundary is not above 0"));
}

TEST_CASE("A uniform flow through open sides stays uniform", "[fluid]") {
  FlowCase flow(box({{"boundary_x_min_type", "velocity"},
                     {"boundary_x_min_velocity", "1, 0.5, 0"},
                     {"boundary_x_max_type", "pressure"},
                     {"boundary_y_min_type", "velocity"},
                     {"boundary_y_min_velocity", "1, 0.5, 0"},
                     {"boundary_y_max_type", "pressure"},
                     {"boundary_z_min_type", "slip"},
                     {"boundary_z_max_type", "slip"},
                     {"fluid_initial_velocity", "1, 0.5, 0"}}));
  for (int k = 0; k < 5; ++k) flow.advance(0.1);
  CHECK(flow.error(flow.fluid->velocity(), 3, [](const Vec3&) { return Vec3(1, 0.5, 0); }) < 1e-8);
}

TEST_CASE("A vortex leaving through a pressure boundary does not blow up", "[fluid]") {
  // A strong jet into a short open box draws fluid back in through the outlet.
  for (const char* share : {"0.5", "1"}) {
    FlowCase flow({{"mesh_cell", "quadrilateral"},
                   {"mesh_cells", "20, 20"},
                   {"mesh_upper", "1, 1, 0"},
                   {"fluid_density", "1"},
                   {"fluid_viscosity", "1e-4"},
                   {"fluid_backflow", share},
                   {"boundary_x_min_type", "velocity"},
                   {"boundary_x_min_velocity", "exp(-200*(y-0.3)^2), 0, 0"},
                   {"boundary_x_max_type", "pressure"},
                   {"boundary_y_min_type", "no_slip"},
                   {"boundary_y_max_type", "pressure"}});
    double fastest = 0, lowest = 0;
    for (int k = 0; k < 300; ++k) flow.advance(0.05);
    for (int i = 0; i < flow.mesh->nodes; ++i) {
      const Vec3 u = vec3(flow.fluid->velocity().data() + 3 * i);
      fastest = std::max(fastest, u.norm());
      if (flow.position(i).x() > 0.999 || flow.position(i).y() > 0.999)
        lowest = std::min(lowest, flow.position(i).x() > 0.999 ? u.x() : u.y());
    }
    CAPTURE(share, fastest, lowest);
    CHECK(lowest < -1e-3);  // there is backflow
    CHECK(fastest < 1.5);
  }
}

TEST_CASE("A closed box refuses what it cannot conserve, and only that", "[boundary][fluid][mpi]") {
  const std::string scheme = GENERATE("pressure_correction", "monolithic");
  INFO(scheme);
  FlowCase leaky({{"mesh_cell", "quadrilateral"},
                  {"mesh_upper", "1, 1, 0"},
                  {"mesh_cells", "6, 4"},
                  {"fluid_scheme", scheme},
                  {"fluid_density", "1"},
                  {"fluid_viscosity", "1"},
                  {"boundary_x_min_type", "velocity"},
                  {"boundary_x_min_velocity", "1, 0, 0"},
                  {"boundary_x_max_type", "velocity"},
                  {"boundary_x_max_velocity", "0.9, 0, 0"},
                  {"boundary_y_min_type", "slip"},
                  {"boundary_y_max_type", "slip"}});
  CHECK_THROWS_WITH(leaky.advance(0.1), Catch::Contains("the flow cannot be conserved"));

  // A box of a micrometre and steps of a nanosecond: the round-off of a void fraction, 1e-13 in a step, is 100 volumes
  // a second.
  const double dt = 1e-9;
  FlowCase small({{"mesh_cell", "quadrilateral"},
                  {"mesh_upper", "1e-6, 1e-6, 0"},
                  {"mesh_cells", "6, 4"},
                  {"fluid_scheme", scheme},
                  {"fluid_density", "1000"},
                  {"fluid_viscosity", "0.001"},
                  {"boundary_x_min_type", "no_slip"},
                  {"boundary_x_max_type", "no_slip"},
                  {"boundary_y_min_type", "no_slip"},
                  {"boundary_y_max_type", "no_slip"}});
  const auto fill = [&](double lost) {
    for (int i = 0; i < small.mesh->nodes; ++i) {
      const double wave = std::cos(M_PI * 1e6 * small.position(i).x());
      small.fluid->load().void_fraction[i] = 0.9 + 1e-6 * wave;
      small.fluid->load().void_fraction_rate[i] = (1e-6 * wave - lost) / dt;
    }
  };
  fill(1e-13);
  CHECK_NOTHROW(small.advance(dt));
  fill(1e-8);
  CHECK_THROWS_WITH(small.advance(dt), Catch::Contains("the flow cannot be conserved"));
}
