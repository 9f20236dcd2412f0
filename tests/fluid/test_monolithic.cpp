#include <catch2/catch.hpp>
#include <random>

#include "monolithic_case.hpp"

using namespace silt;
using silt::test::MonolithicCase;

namespace {

/// A step with every term switched on, from a random state.
void fill_random(MonolithicCase& flow, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  for (double& u : flow.fluid->all_velocities()) u = number(random);
  ParticleLoad& load = flow.fluid->load();
  for (double& a : load.void_fraction) a = 0.7 + 0.2 * number(random);
  for (double& r : load.void_fraction_rate) r = 0.1 * number(random);
  for (double& f : load.force) f = number(random);
  for (double& r : load.response) r = 1 + number(random);
  for (double& s : load.following) s = 0.2 + 0.1 * number(random);
  for (auto& array : flow.fluid->state()) {  // what the step before lent comes back
    if (array.name == "lent_share")
      for (double& s : *array.values) s = 0.2 + 0.1 * number(random);
    if (array.name == "fluid_step_previous") std::fill(array.values->begin(), array.values->end(), 0.07);
  }
}

}  // namespace

TEST_CASE("The Jacobian by automatic differentiation is the derivative of the residual on every element",
          "[monolithic]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const std::string cell = GENERATE("triangle", "quadrilateral", "tetrahedron", "hexahedron");
  const std::string model = GENERATE("a", "b");
  CAPTURE(element, cell, model);
  MonolithicCase flow(cell, {2, 2, 2}, element);
  flow.options.set("fluid_model", model);
  flow.options.set("fluid_supg", "1");
  flow.options.set("fluid_grad_div", "1");
  flow.all_boundaries("type", "slip");
  flow.boundary("x_min", "type", "velocity");
  flow.boundary("x_min", "velocity", "1, 0.5, 0");
  flow.boundary("x_max", "type", "pressure");
  flow.boundary("x_max", "pressure", "1 + y");
  flow.start();
  std::mt19937 random(7);
  fill_random(flow, random);
  // A step that is not solved: only its fields are wanted.
  flow.fluid->prepare_step(0, 0.1);
  const FlowSystem& system = flow.fluid->system();
  const StepFields& fields = flow.fluid->fields();

  VecHandle x = system.create_vector(), direction = system.create_vector(), plus = system.create_vector(),
            minus = system.create_vector(), exact = system.create_vector();
  PetscInt size;
  VecGetLocalSize(x, &size);
  std::uniform_real_distribution<double> number(-1, 1);
  double *a, *b;
  VecGetArray(x, &a);
  VecGetArray(direction, &b);
  for (PetscInt i = 0; i < size; ++i) a[i] = number(random), b[i] = number(random);
  VecRestoreArray(x, &a);
  VecRestoreArray(direction, &b);
  MatHandle matrix = system.create_matrix();
  REQUIRE(system.jacobian(fields, x, matrix) == 0);
  // The columns of fixed unknowns are left out of the other rows: differences along free unknowns only.
  VecHandle fixed = system.create_vector();
  REQUIRE(system.residual(fields, x, plus) == 0);
  std::vector<double> u(3 * static_cast<size_t>(system.space().nodes), 0.0), p(flow.mesh->nodes, 0.0);
  system.from_vector(direction, u.data(), p.data());
  std::vector<double> zero(u.size(), 0.0);
  system.constraints().impose(zero.data(), u.data());
  system.to_vector(u.data(), p.data(), direction);
  MatMult(matrix, direction, exact);
  const double h = 1e-5;
  VecWAXPY(fixed, h, direction, x);
  REQUIRE(system.residual(fields, fixed, plus) == 0);
  VecWAXPY(fixed, -h, direction, x);
  REQUIRE(system.residual(fields, fixed, minus) == 0);
  VecAXPY(plus, -1, minus);
  VecScale(plus, 0.5 / h);
  double norm, difference;
  VecNorm(exact, NORM_2, &norm);
  VecAXPY(plus, -1, exact);
  VecNorm(plus, NORM_2, &difference);
  CHECK(norm > 1);
  CHECK(difference < 1e-7 * norm);
}

TEST_CASE("Newton's method converges quadratically with the exact Jacobian", "[monolithic]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  MonolithicCase flow("quadrilateral", {8, 8}, element);
  flow.options.set("fluid_viscosity", "0.01");
  flow.options.set("fluid_ksp_rtol", "1e-12");
  flow.options.set("fluid_pc_type", "lu");
  flow.options.set("fluid_snes_atol", "1e-13");
  flow.options.set("fluid_snes_rtol", "1e-14");
  flow.all_boundaries("type", "no_slip");
  flow.boundary("y_max", "velocity", "1, 0, 0");
  flow.start();
  flow.fluid->advance(0, 1e6);
  std::vector<double> r = flow.fluid->newton_norms();
  while (r.size() > 3 && r.back() < 1e-14 * r[0]) r.pop_back();  // rounding
  REQUIRE(r.size() >= 4);
  // e3/e2 falls at least like (e2/e1)^1.7.
  const double e1 = r[r.size() - 3], e2 = r[r.size() - 2], e3 = r[r.size() - 1];
  INFO(element << " norms " << e1 << " " << e2 << " " << e3);
  CHECK(std::log(e3 / e2) / std::log(e2 / e1) > 1.7);
  PetscOptionsClearValue(nullptr, "-fluid_pc_type");
  PetscOptionsClearValue(nullptr, "-fluid_snes_atol");
  PetscOptionsClearValue(nullptr, "-fluid_snes_rtol");
  PetscOptionsClearValue(nullptr, "-fluid_ksp_rtol");
}

TEST_CASE("Plane Poiseuille flow is exact for Taylor-Hood and of second order for equal order", "[monolithic]") {
  // Pressure drop 8 over length 1, mu 1, between walls: u = 4 y (1 - y), through open ends.
  const auto u = [](const Vec3& x) { return Vec3(4 * x.y() * (1 - x.y()), 0, 0); };
  const auto p = [](const Vec3& x) { return 8 * (1 - x.x()); };
  const auto solve = [&](const std::string& cell, const std::string& element, int n) {
    MonolithicCase flow(cell, {n, n}, element);
    flow.boundary("y_min y_max", "type", "no_slip");
    flow.boundary("x_min", "type", "velocity");
    flow.boundary("x_min", "velocity", "4*y*(1-y), 0, 0");
    flow.boundary("x_max", "type", "pressure");
    flow.options.set("fluid_snes_rtol", "1e-11");
    flow.start();
    flow.fluid->advance(0, 1e8);
    PetscOptionsClearValue(nullptr, "-fluid_snes_rtol");
    const auto flows = flow.fluid->boundary_flow();
    const auto& names = flow.mesh->boundaries;
    for (size_t b = 0; b < names.size(); ++b) {
      // Walls feel mu du/dy = 4 per length of 1 each; ends carry the flow 2/3.
      if (names[b] == "y_min") CHECK(flows[b].force.x() == Approx(4).epsilon(element == "taylor_hood" ? 1e-6 : 0.1));
      if (names[b] == "x_max") CHECK(flows[b].volume_flow == Approx(2.0 / 3).epsilon(1e-7));
    }
    return flow.errors(u, p);
  };
  for (const char* cell : {"triangle", "quadrilateral"}) {
    CAPTURE(cell);
    CHECK(solve(cell, "taylor_hood", 4).first < 1e-7);
    const double coarse = solve(cell, "equal_order", 8).first, fine = solve(cell, "equal_order", 16).first;
    CHECK(std::log2(coarse / fine) > 1.9);
  }
}

TEST_CASE("The lid-driven cavity at Reynolds 100 follows Ghia, Ghia & Shin (1982)", "[monolithic]") {
  MonolithicCase flow("quadrilateral", {40, 40}, "equal_order");
  flow.options.set("fluid_viscosity", "0.01");
  flow.all_boundaries("type", "no_slip");
  flow.boundary("y_max", "velocity", "1, 0, 0");
  flow.start();
  flow.fluid->advance(0, 1e6);
  // u(x = 0.5, y), figures of the paper; linear interpolation along the vertical centre line.
  const double table[][2] = {{0.9531, 0.68717},  {0.8516, 0.23151},  {0.7344, 0.00332}, {0.5, -0.20581},
                             {0.4531, -0.21090}, {0.2813, -0.15662}, {0.1016, -0.06434}};
  std::vector<double> u(41);
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    const auto x = vec3(&flow.mesh->node_coordinates[3 * static_cast<size_t>(i)]);
    if (std::abs(x.x() - 0.5) < 1e-9) u[std::lround(40 * x.y())] = flow.fluid->velocity()[3 * static_cast<size_t>(i)];
  }
  for (const auto& [y, expected] : table) {
    const int k = static_cast<int>(40 * y);
    const double s = 40 * y - k;
    CAPTURE(y);
    CHECK((1 - s) * u[k] + s * u[k + 1] == Approx(expected).margin(0.006));
  }
}

TEST_CASE("A closed box at rest under gravity carries the static head and no flow", "[monolithic]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  MonolithicCase flow("triangle", {5, 5}, element);
  flow.options.set("fluid_hydrostatic", "yes");
  flow.options.set("fluid_density", "1000");
  flow.all_boundaries("type", "no_slip");
  flow.start(Vec3(0, -10, 0));
  for (int i = 0; i < flow.mesh->nodes; ++i) flow.fluid->load().void_fraction[i] = 0.5 + 0.3 * std::sin(1.0 * i);
  flow.fluid->advance(0, 0.1);
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    const double y = flow.mesh->node_coordinates[3 * static_cast<size_t>(i) + 1];
    CHECK(flow.fluid->pressure()[i] == Approx(1e4 * (0.5 - y)).margin(1e-3));
  }
  for (double v : flow.fluid->velocity()) CHECK(std::abs(v) < 1e-7);
}

TEST_CASE("What the particles are owed is the impulse the fluid gave them, to rounding", "[monolithic][mpi]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  MonolithicCase flow("triangle", {6, 6}, element);
  flow.all_boundaries("type", "slip");
  flow.boundary("x_max", "type", "pressure");
  flow.boundary("x_min", "type", "velocity");
  flow.boundary("x_min", "velocity", "1, 0, 0");
  flow.start();
  ParticleLoad& load = flow.fluid->load();
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    const auto x = vec3(&flow.mesh->node_coordinates[3 * static_cast<size_t>(i)]);
    load.response[i] = 1 + x.x() * x.y();
    load.force[3 * static_cast<size_t>(i)] = x.y();
  }
  const std::vector<double> before(flow.fluid->all_velocities().begin(), flow.fluid->all_velocities().end());
  flow.fluid->advance(0, 0.1);
  // int r_h (u^{n+1} - u^n) (Taylor-Hood) or the sum over the rows (equal order), by our own quadrature.
  const FlowSystem& system = flow.fluid->system();
  Vec3 fluid_side = Vec3::Zero(), particle_side = Vec3::Zero();
  const auto after = flow.fluid->all_velocities();
  const auto change = flow.fluid->velocity_change();
  for (int i = 0; i < flow.mesh->owned_nodes; ++i)
    particle_side += load.response[i] * vec3(&change[3 * static_cast<size_t>(i)]);
  if (element == "equal_order") {
    for (int i = 0; i < flow.mesh->owned_nodes; ++i)
      fluid_side +=
          load.response[i] * (vec3(&after[3 * static_cast<size_t>(i)]) - vec3(&before[3 * static_cast<size_t>(i)]));
  } else {
    const FlowTable& table = flow_table(flow.mesh->cell, 2);
    for (int c = 0; c < flow.mesh->cells; ++c)
      for (int q = 0; q < table.points; ++q) {
        double r = 0;
        Vec3 du = Vec3::Zero();
        for (int a = 0; a < 3; ++a) {
          const int n = flow.mesh->cell_nodes[3 * static_cast<size_t>(c) + a];
          r += table.M[q][a] * load.response[n] / system.lumped_mass()[n];
        }
        for (int a = 0; a < 6; ++a) {
          const size_t n = 3 * static_cast<size_t>(system.space().cell_nodes[6 * static_cast<size_t>(c) + a]);
          du += table.N[q][a] * (vec3(&after[n]) - vec3(&before[n]));
        }
        fluid_side += 2 * table.weight[q] * flow.mesh->cell_volumes[c] * r * du;
      }
  }
  for (int i = 0; i < 2; ++i)
    CHECK(mpi_sum(fluid_side[i]) == Approx(mpi_sum(particle_side[i])).epsilon(1e-13).margin(1e-14));
}

TEST_CASE("The answer does not depend on the number of ranks, nor on one without cells", "[monolithic][mpi]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const std::string cell = GENERATE("triangle", "quadrilateral", "hexahedron");
  CAPTURE(element, cell);
  // Two cells in all: on three ranks one has none. Reference: the flow figures of the exact plane Poiseuille solution.
  MonolithicCase flow(cell, cell == "triangle" ? std::vector<int>{1, 1} : std::vector<int>{2, 1, 1}, element);
  flow.all_boundaries("type", "slip");
  flow.boundary("x_min", "type", "velocity");
  flow.boundary("x_min", "velocity", "2, 0, 0");
  flow.boundary("x_max", "type", "pressure");
  flow.boundary("x_max", "pressure", "3");
  flow.start();
  const FluidStep step = flow.fluid->advance(0, 1e6);
  // Plug flow: u = 2 and p = 3 everywhere, momentum 2 per unit volume.
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    CHECK(flow.fluid->velocity()[3 * static_cast<size_t>(i)] == Approx(2));
    CHECK(flow.fluid->pressure()[i] == Approx(3));
  }
  CHECK(step.momentum.x() == Approx(2));
  CHECK(std::abs(step.mass_residual) < 1e-7);
}

TEST_CASE("Lagged Jacobians and inexact Newton, by option, reach the same flow", "[monolithic]") {
  const auto solve = [](const std::vector<std::pair<std::string, std::string>>& words) {
    MonolithicCase flow("quadrilateral", {10, 10}, "equal_order");
    flow.options.set("fluid_viscosity", "0.02");
    for (const auto& [name, value] : words) flow.options.set(name, value);
    flow.all_boundaries("type", "no_slip");
    flow.boundary("y_max", "velocity", "1, 0, 0");
    flow.start();
    int linear = 0;
    for (int k = 0; k < 3; ++k) linear += flow.fluid->advance(0.1 * k, 0.1).velocity_iterations;
    for (const auto& [name, value] : words) PetscOptionsClearValue(nullptr, ("-" + name).c_str());
    return std::pair{std::vector<double>(flow.fluid->velocity().begin(), flow.fluid->velocity().end()), linear};
  };
  const auto exact = solve({{"fluid_snes_rtol", "1e-10"}});
  const auto lagged = solve({{"fluid_snes_rtol", "1e-10"}, {"fluid_snes_lag_jacobian", "2"}});
  const auto inexact = solve({{"fluid_snes_rtol", "1e-10"}, {"fluid_snes_ksp_ew", "1"}});
  double differs = 0;
  for (size_t i = 0; i < exact.first.size(); ++i)
    differs =
        std::max({differs, std::abs(exact.first[i] - lagged.first[i]), std::abs(exact.first[i] - inexact.first[i])});
  CHECK(differs < 1e-7);
  CHECK(lagged.second != exact.second);
  CHECK(inexact.second != exact.second);
}
