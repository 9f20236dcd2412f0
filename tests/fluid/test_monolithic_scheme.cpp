#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>

#include "base/error.hpp"
#include "flow_case.hpp"
#include "fluid/assembly/flow_kernel.hpp"
#include "monolithic_case.hpp"

using namespace silt;
using silt::test::FlowCase;
using silt::test::MonolithicCase;

namespace {

/// The velocities of a starting lid-driven cavity at t = 0.4.
std::vector<double> cavity(const std::string& scheme, int cells, int steps) {
  FlowCase flow({{"mesh_type", "box"},
                 {"mesh_cell", "quadrilateral"},
                 {"mesh_cells", std::to_string(cells) + ", " + std::to_string(cells)},
                 {"fluid_scheme", scheme},
                 {"fluid_density", "1"},
                 {"fluid_viscosity", "0.02"},
                 {"boundary_x_min_type", "no_slip"},
                 {"boundary_x_max_type", "no_slip"},
                 {"boundary_y_min_type", "no_slip"},
                 {"boundary_y_max_type", "no_slip"},
                 {"boundary_y_max_velocity", "min(10*t, 1)*16*x^2*(1-x)^2, 0, 0"}});
  for (int s = 0; s < steps; ++s) flow.advance(0.4 / steps);
  return {flow.fluid->velocity().begin(), flow.fluid->velocity().end()};
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double result = 0;
  for (size_t i = 0; i < a.size(); ++i) result = std::max(result, std::abs(a[i] - b[i]));
  return result;
}

}  // namespace

TEST_CASE("The two schemes approach the same flow as the time step and the cells shrink", "[monolithic]") {
  std::vector<double> differences;
  for (const auto& [cells, steps] : {std::pair{12, 10}, std::pair{12, 40}, std::pair{24, 40}, std::pair{24, 160}})
    differences.push_back(
        largest_difference(cavity("monolithic", cells, steps), cavity("pressure_correction", cells, steps)));
  WARN("largest difference of the velocities: 12 cells dt 0.04, 0.01: "
       << differences[0] << " " << differences[1] << "; 24 cells dt 0.01, 0.0025: " << differences[2] << " "
       << differences[3]);
  CHECK(differences[1] < differences[0]);
  CHECK(differences[3] < differences[2]);
  // On a given mesh the two pressure stabilisations stay different, by an amount that falls with the cells.
  CHECK(differences[2] < 0.5 * differences[1]);
  CHECK(differences[3] < 0.01);
}

TEST_CASE("Fluid drawn in from rest through a pressure boundary arrives with Bernoulli's speed", "[monolithic]") {
  // Between open ends, 2 Pa at the entrance: backflow 1/2 takes out rho u^2/2 there, so rho u^2/2 = 2 Pa.
  const std::string element = GENERATE("equal_order", "taylor_hood");
  MonolithicCase flow("quadrilateral", {4, 2}, element);
  flow.options.set("fluid_viscosity", "1e-3");
  flow.boundary("y_min y_max", "type", "slip");
  flow.boundary("x_min x_max", "type", "pressure");
  flow.boundary("x_min", "pressure", "2");
  flow.start();
  for (int s = 0; s < 40; ++s) flow.fluid->advance(0.2 * s, 0.2);
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    CHECK(flow.fluid->velocity()[3 * static_cast<size_t>(i)] == Approx(2).epsilon(1e-4));
    CHECK(std::abs(flow.fluid->velocity()[3 * static_cast<size_t>(i) + 1]) < 1e-8);
  }
}

TEST_CASE("Plug flow passes a channel with slip walls at any angle to the axes", "[monolithic][mpi]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  // A unit square of 4 x 4 x 2 triangles turned by 30 degrees.
  const std::string file = "turned_square_" + element + std::to_string(mpi_size()) + ".msh";
  constexpr int n = 4;
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  if (mpi_rank() == 0) {
    std::ofstream out(file);
    out.precision(17);
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 1 \"in\"\n1 2 \"out\"\n1 3 \"side\"\n2 4 "
           "\"fluid\"\n"
        << "$EndPhysicalNames\n$Nodes\n"
        << (n + 1) * (n + 1) << "\n";
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
        out << 1 + i + (n + 1) * j << " " << c * x - s * y << " " << s * x + c * y << " 0\n";
      }
    const auto node = [](int i, int j) { return 1 + i + (n + 1) * j; };
    out << "$EndNodes\n$Elements\n" << 4 * n + 2 * n * n << "\n";
    int e = 0;
    const auto line = [&](int tag, int a, int b) {
      out << ++e << " 1 2 " << tag << " " << tag << " " << a << " " << b << "\n";
    };
    for (int k = 0; k < n; ++k) {
      line(1, node(0, k), node(0, k + 1));
      line(2, node(n, k), node(n, k + 1));
      line(3, node(k, 0), node(k + 1, 0));
      line(3, node(k, n), node(k + 1, n));
    }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        out << ++e << " 2 2 4 4 " << node(i, j) << " " << node(i + 1, j) << " " << node(i + 1, j + 1) << "\n";
        out << ++e << " 2 2 4 4 " << node(i, j) << " " << node(i + 1, j + 1) << " " << node(i, j + 1) << "\n";
      }
    out << "$EndElements\n";
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  MonolithicCase flow("triangle", {}, element);
  flow.mesh_options.type = "file";
  flow.mesh_options.file = file;
  flow.boundary("side", "type", "slip");
  flow.boundary("in", "type", "mass_flow");
  flow.boundary("in", "mass_flow", "2");
  flow.boundary("out", "type", "pressure");
  flow.start();
  const FluidStep step = flow.fluid->advance(0, 1e8);
  for (int i = 0; i < flow.mesh->nodes; ++i) {
    CHECK(flow.fluid->velocity()[3 * static_cast<size_t>(i)] == Approx(2 * c));
    CHECK(flow.fluid->velocity()[3 * static_cast<size_t>(i) + 1] == Approx(2 * s));
    CHECK(std::abs(flow.fluid->pressure()[i]) < 1e-6);
  }
  CHECK(std::abs(step.mass_residual) < 1e-7);
  MPI_Barrier(PETSC_COMM_WORLD);
  if (mpi_rank() == 0) std::remove(file.c_str());
}

TEST_CASE("A failed step leaves the flow as it was, and a restart goes on with the same bits", "[monolithic]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const auto make = [&] {
    auto flow = std::make_unique<MonolithicCase>("triangle", std::vector<int>{6, 6}, element);
    flow->options.set("fluid_viscosity", "0.01");
    flow->all_boundaries("type", "no_slip");
    flow->boundary("y_max", "velocity", "1, 0, 0");
    flow->start();
    return flow;
  };
  const auto first = make();
  first->fluid->advance(0, 0.1);
  first->fluid->advance(0.1, 0.1);
  const auto copy = [](std::span<const double> v) { return std::vector<double>(v.begin(), v.end()); };

  PetscOptionsSetValue(nullptr, "-fluid_snes_max_it", "1");
  PetscOptionsSetValue(nullptr, "-fluid_direct_snes_max_it", "1");
  const auto second = make();
  PetscOptionsClearValue(nullptr, "-fluid_snes_max_it");
  const auto from = first->fluid->state(), to = second->fluid->state();
  REQUIRE(from.size() == to.size());
  for (size_t k = 0; k < from.size(); ++k) {
    REQUIRE(from[k].name == to[k].name);
    const size_t places = from[k].on_cells ? first->mesh->cells : first->mesh->nodes;
    REQUIRE(from[k].values->size() == places * from[k].components);
    *to[k].values = *from[k].values;
  }
  second->fluid->restored();
  const auto before = copy(second->fluid->all_velocities()), pressure = copy(second->fluid->pressure());
  CHECK_THROWS_AS(second->fluid->advance(0.2, 10.0), SolveFailure);
  PetscOptionsClearValue(nullptr, "-fluid_direct_snes_max_it");
  CHECK(copy(second->fluid->all_velocities()) == before);
  CHECK(copy(second->fluid->pressure()) == pressure);

  const auto third = make();
  const auto last = third->fluid->state();
  for (size_t k = 0; k < from.size(); ++k) *last[k].values = *from[k].values;
  third->fluid->restored();
  third->fluid->advance(0.2, 0.1);
  first->fluid->advance(0.2, 0.1);
  CHECK(copy(third->fluid->all_velocities()) == copy(first->fluid->all_velocities()));
  CHECK(copy(third->fluid->pressure()) == copy(first->fluid->pressure()));
}

TEST_CASE("Model A: the pressure forces on fluid and particles add up to the whole gradient, to rounding",
          "[monolithic][mpi]") {
  const std::string cell = GENERATE("triangle", "quadrilateral", "tetrahedron", "hexahedron");
  MonolithicCase flow(cell, {3, 3, 3}, "equal_order");
  flow.all_boundaries("type", "no_slip");
  flow.options.set("fluid_initial_pressure", "x*x + sin(3*y) + x*z");
  flow.start();
  // sum_i M_i g_i = int grad p_h = closed surface integral of p_h n: by the trapezoidal rule of p_h on the box's faces.
  const auto gradient = flow.fluid->pressure_gradient();
  const auto& mass = flow.fluid->system().lumped_mass();
  Vec3 sum = Vec3::Zero(), surface = Vec3::Zero();
  for (int i = 0; i < flow.mesh->owned_nodes; ++i) sum += mass[i] * vec3(&gradient[3 * static_cast<size_t>(i)]);
  for (const FacetRule& facet : flow.fluid->system().boundary().facets())
    for (int q = 0; q < facet.points; ++q)
      for (int a = 0; a < facet.nodes; ++a)
        surface += facet.point[q].shape[a] * flow.fluid->pressure()[facet.node[a]] * facet.point[q].area;
  for (int d = 0; d < 3; ++d) CHECK(mpi_sum(sum[d]) == Approx(mpi_sum(surface[d])).margin(1e-13));
}

TEST_CASE("The element loop gives the same on every instruction set", "[monolithic]") {
  const int order = GENERATE(1, 2);
  const std::string cell = GENERATE("triangle", "quadrilateral", "tetrahedron", "hexahedron");
  MonolithicCase flow(cell, {3, 2, 2}, order == 1 ? "equal_order" : "taylor_hood");
  flow.options.set("fluid_supg", "1");
  flow.all_boundaries("type", "no_slip");
  flow.options.set("fluid_initial_velocity", "sin(x + 2*y), cos(y*z + x), x*y");
  flow.start();
  flow.fluid->prepare_step(0, 0.1);
  const FlowSystem& system = flow.fluid->system();
  VecHandle x = system.create_vector(), r = system.create_vector();
  system.to_vector(flow.fluid->all_velocities().data(), flow.fluid->pressure().data(), x);
  std::vector<double> norms;
  for (int lanes : {2, 4, 8}) {
    if (lanes == 4 && !__builtin_cpu_supports("avx2")) continue;
    if (lanes == 8 && !__builtin_cpu_supports("avx512f")) continue;
    FlowSystem other(*flow.mesh, system.boundary(), order, lanes);
    MatHandle matrix = other.create_matrix();
    REQUIRE(other.jacobian(flow.fluid->fields(), x, matrix) == 0);
    REQUIRE(other.residual(flow.fluid->fields(), x, r) == 0);
    double a, b;
    MatNorm(matrix, NORM_FROBENIUS, &a);
    VecNorm(r, NORM_2, &b);
    norms.push_back(a + b);
  }
  for (double norm : norms) CHECK(norm == Approx(norms[0]).epsilon(1e-12));
}

TEST_CASE("Flow that the element holds exactly comes out exactly on any number of ranks", "[monolithic][mpi]") {
  // Plane Poiseuille (quadratic, Taylor-Hood) and Couette flow (linear, equal order), between slip side walls in 3D.
  const std::string element = GENERATE("equal_order", "taylor_hood");
  const std::string cell = GENERATE("triangle", "quadrilateral", "tetrahedron", "hexahedron");
  CAPTURE(element, cell);
  const bool quadratic = element == "taylor_hood";
  MonolithicCase flow(cell, {4, 3, 3}, element);
  flow.options.set("fluid_ksp_rtol", "1e-8");
  flow.options.set("fluid_snes_rtol", "1e-11");
  if (flow.three()) flow.boundary("z_min z_max", "type", "slip");
  flow.boundary("y_min y_max", "type", "no_slip");
  if (!quadratic) flow.boundary("y_max", "velocity", "1, 0, 0");
  flow.boundary("x_min", "type", "velocity");
  flow.boundary("x_min", "velocity", quadratic ? "4*y*(1-y), 0, 0" : "y, 0, 0");
  flow.boundary("x_max", "type", "pressure");
  flow.start();
  flow.fluid->advance(0, 1e9);
  PetscOptionsClearValue(nullptr, "-fluid_ksp_rtol");
  PetscOptionsClearValue(nullptr, "-fluid_snes_rtol");
  const auto [u, p] =
      flow.errors([&](const Vec3& x) { return Vec3(quadratic ? 4 * x.y() * (1 - x.y()) : x.y(), 0, 0); },
                  [&](const Vec3& x) { return quadratic ? 8 * (1 - x.x()) : 0.0; });
  CHECK(u < 1e-7);
  CHECK(p < 1e-5);
}

TEST_CASE("A uniform flow in a box without boundaries goes on as it is, twice in one process", "[monolithic][mpi]") {
  const std::string element = GENERATE("equal_order", "taylor_hood");
  CAPTURE(element);
  const auto flow = std::make_unique<MonolithicCase>("hexahedron", std::vector<int>{3, 4, 3}, element);
  const auto twin = std::make_unique<MonolithicCase>("hexahedron", std::vector<int>{3, 4, 3}, element);
  for (auto* box : {flow.get(), twin.get()}) {
    box->mesh_options.periodic = {1, 1, 1};
    box->options.set("fluid_initial_velocity", "0.3, -0.2, 0.1");
    box->start();
    REQUIRE(box->mesh->boundaries.empty());
  }
  for (auto* box : {twin.get(), flow.get()}) {
    const FluidStep step = box->fluid->advance(0, 0.1);
    CHECK((step.momentum - Vec3(0.3, -0.2, 0.1)).norm() < 1e-10);
    for (int i = 0; i < box->mesh->nodes; ++i)
      CHECK((vec3(&box->fluid->velocity()[3 * static_cast<size_t>(i)]) - Vec3(0.3, -0.2, 0.1)).norm() < 1e-9);
  }
}
