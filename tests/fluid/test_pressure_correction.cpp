#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "base/nodal_matrix.hpp"
#include "flow_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

FlowCase::Settings stirred_box() {
  FlowCase::Settings settings = {{"mesh_cells", "5, 4, 4"},
                                 {"fluid_density", "1.2"},
                                 {"fluid_viscosity", "0.01"},
                                 {"fluid_initial_velocity", "y*(1-y), 0, 0"},
                                 {"boundary_x_max_type", "pressure"},
                                 {"boundary_x_min_type", "velocity"},
                                 {"boundary_x_min_velocity", "y*(1-y)*(1 + 0.3*sin(3*t)), 0, 0"}};
  for (const char* name : {"y_min", "y_max", "z_min", "z_max"})
    settings.push_back({"boundary_" + std::string(name) + "_type", "no_slip"});
  return settings;
}

void load_bed(FlowCase& flow) {
  set_bed(
      flow, [](const Vec3& x) { return 0.8 + 0.15 * std::sin(5 * x.x() + 4 * x.y() + 3 * x.z()); },
      [](const Vec3& x) { return 5 * (1 + std::cos(4 * x.x() * x.z())); });
}

double difference(std::span<const double> a, std::span<const double> b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return mpi_max(worst);
}

}  // namespace

TEST_CASE("Every vector width of the element loops gives the same flow", "[fluid]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    std::vector<std::vector<double>> results;
    for (const char* width : {"2", "4", "8"}) {
      auto settings = stirred_box();
      settings.push_back({"mesh_cell", cell});
      settings.push_back({"fluid_width", width});
      FlowCase flow(settings);
      for (int k = 0; k < 3; ++k) {
        load_bed(flow);
        flow.advance(0.05);
      }
      results.emplace_back(flow.fluid->velocity().begin(), flow.fluid->velocity().end());
    }
    CHECK(difference(results[0], results[1]) < 1e-10);
    CHECK(difference(results[0], results[2]) < 1e-10);
  }
}

TEST_CASE("A force that is nothing beside the momentum of the flow moves it all the same", "[fluid][mpi]") {
  // In a step the force gives 1e-6 of what the equation's right-hand side holds, a tenth of the default tolerance.
  FlowCase flow({{"mesh_cells", "3, 3, 3"},
                 {"mesh_periodic", "1, 1, 1"},
                 {"fluid_density", "2"},
                 {"fluid_viscosity", "1e-3"},
                 {"fluid_initial_velocity", "100, 0, 0"},
                 {"fluid_body_force", "0, 0.02, 0"}});
  for (int n = 0; n < 20; ++n) flow.advance(0.01);
  for (int i = 0; i < flow.mesh->nodes; ++i)
    CHECK(flow.fluid->velocity()[3 * static_cast<std::size_t>(i) + 1] == Approx(0.01 * 0.2).epsilon(1e-3));
}

TEST_CASE("A step that fails leaves the flow as it was", "[fluid][mpi]") {
  FlowCase flow(stirred_box()), twin(stirred_box(), Vec3::Zero(), flow.mesh);
  for (int k = 0; k < 3; ++k) flow.advance(0.05), twin.advance(0.05);
  auto& force = flow.fluid->load().force;
  for (double& f : force) f = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(flow.fluid->advance(flow.time, 0.05), SolveFailure);
  std::fill(force.begin(), force.end(), 0.0);
  for (int k = 0; k < 3; ++k) flow.advance(0.05), twin.advance(0.05);
  CHECK(difference(flow.fluid->velocity(), twin.fluid->velocity()) < 5e-4);
  for (double u : flow.fluid->velocity()) CHECK(std::isfinite(u));
}

TEST_CASE("A flow goes on from its saved state as if it had not stopped, on one rank to the bit", "[fluid][mpi]") {
  FlowCase flow(stirred_box()), restarted(stirred_box(), Vec3::Zero(), flow.mesh);
  const auto go = [](FlowCase& f) {
    load_bed(f);
    f.advance(f.time < 0.1 ? 0.05 : 0.03);
  };
  for (int k = 0; k < 4; ++k) go(flow);
  auto from = flow.fluid->state(), to = restarted.fluid->state();
  REQUIRE(from.size() == to.size());
  for (std::size_t k = 0; k < from.size(); ++k) *to[k].values = *from[k].values;
  restarted.time = flow.time;
  for (int k = 0; k < 3; ++k) go(flow), go(restarted);
  // On several ranks PETSc's matrix assembly adds the contributions to a shared entry in the order of their arrival.
  const double allowed = mpi_size() == 1 ? 0 : 1e-10;
  CHECK(difference(flow.fluid->velocity(), restarted.fluid->velocity()) <= allowed);
  CHECK(difference(flow.fluid->pressure(), restarted.fluid->pressure()) <= allowed);
  CHECK(difference(flow.fluid->pressure_gradient(), restarted.fluid->pressure_gradient()) <= 10 * allowed);
}

TEST_CASE("A direct pressure solver by option gives the same flow, also in a closed box", "[fluid][mpi]") {
  const bool closed = GENERATE(false, true);
  auto settings = stirred_box();
  if (closed)
    for (const char* name : {"boundary_x_max", "boundary_x_min"}) {
      settings.push_back({std::string(name) + "_type", "velocity"});
      settings.push_back({std::string(name) + "_velocity", "y*(1-y)*(1 + 0.3*sin(3*t)), 0, 0"});
    }
  std::shared_ptr<Mesh> mesh;
  const auto run = [&](const FlowCase::Settings& solver, FluidStep& step) {
    for (const auto& [name, value] : solver)
      PetscOptionsSetValue(nullptr, ("-fluid_pressure_" + name).c_str(), value.c_str());
    FlowCase flow(settings, Vec3::Zero(), mesh);
    mesh = flow.mesh;
    for (int k = 0; k < 4; ++k) step = flow.advance(0.05);
    for (const auto& [name, value] : solver) PetscOptionsClearValue(nullptr, ("-fluid_pressure_" + name).c_str());
    return std::vector<double>(flow.fluid->velocity().begin(), flow.fluid->velocity().end());
  };
  FluidStep step;
  const auto iterative = run({}, step), tight = run({{"ksp_rtol", "1e-10"}}, step);
  const auto direct = run({{"ksp_type", "preonly"}, {"pc_type", "lu"}, {"pc_factor_mat_solver_type", "mumps"}}, step);
  CHECK(std::abs(step.mass_residual) < 1e-10);
  CHECK(difference(direct, tight) < 1e-7);
  CHECK(difference(direct, iterative) < 1e-3);
}

TEST_CASE("A closed box at rest keeps still, with the static head when the pressure is to hold it", "[fluid][mpi]") {
  const std::string hydrostatic = GENERATE("no", "yes"), cell = GENERATE("hexahedron", "tetrahedron");
  FlowCase::Settings settings = {{"mesh_cells", "4, 4, 4"},
                                 {"mesh_cell", cell},
                                 {"fluid_density", "1000"},
                                 {"fluid_viscosity", "1e-3"},
                                 {"fluid_hydrostatic", hydrostatic}};
  for (const char* name : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    settings.push_back({"boundary_" + std::string(name) + "_type", "no_slip"});
  PetscOptionsSetValue(nullptr, "-fluid_pressure_ksp_rtol", "1e-8");
  FlowCase flow(settings, Vec3(0, 0, -9.81));
  CHECK(flow.fluid->reduced_pressure() == (hydrostatic == "no"));
  for (int k = 0; k < 10; ++k) flow.advance(0.1);
  PetscOptionsClearValue(nullptr, "-fluid_pressure_ksp_rtol");
  const auto p = [&](double z) { return flow.value(flow.fluid->pressure(), 1, 0, Vec3(0.5, 0.5, z)); };
  CHECK(p(0) - p(1) == Approx(hydrostatic == "yes" ? 9810 : 0).epsilon(1e-5).margin(1e-9));
  CHECK(flow.error(flow.fluid->velocity(), 3, [](const Vec3&) { return Vec3(0, 0, 0); }) < 1e-4);
}

TEST_CASE("Wall friction and pressure drop of a duct balance, and the momentum follows the forces", "[fluid][mpi]") {
  FlowCase flow({{"mesh_cell", "quadrilateral"},
                 {"mesh_cells", "16, 12"},
                 {"mesh_upper", "2, 1, 0"},
                 {"fluid_density", "1.5"},
                 {"fluid_viscosity", "0.1"},
                 {"fluid_backflow", "0"},
                 {"boundary_x_min_type", "pressure"},
                 {"boundary_x_min_pressure", "3"},
                 {"boundary_x_max_type", "pressure"},
                 {"boundary_y_min_type", "no_slip"},
                 {"boundary_y_max_type", "no_slip"}});
  Vec3 before = Vec3::Zero();
  FluidStep step;
  const double dt = 0.02;
  for (int k = 0; k < 60; ++k) {
    step = flow.advance(dt);
    if (k > 5 && k < 50) {
      // dM/dt = sum of the forces, to the order of the step: the flow speeds up under 3 Pa less the growing friction.
      const Vec3 rate = (step.momentum - before) / dt;
      CHECK(rate.x() == Approx(step.boundary_force.x()).margin(0.08));
    }
    before = step.momentum;
  }
  for (int k = 0; k < 400; ++k) step = flow.advance(0.1);
  const auto b = flow.fluid->boundary_flow();
  CHECK(b[2].force.x() + b[3].force.x() == Approx(3).epsilon(3e-3));
  CHECK(step.boundary_force.norm() < 1e-2);
  // Flow of the parabola: dp/dx h^3/(12 mu), with chords on 12 cells.
  CHECK(b[1].volume_flow == Approx(1.5 / 1.2).epsilon(0.01));
}
