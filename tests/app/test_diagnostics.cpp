#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

#include "app/budget.hpp"
#include "app/diagnostics.hpp"
#include "app/probes.hpp"
#include "base/error.hpp"
#include "support/temporary_directory.hpp"

using namespace silt;

namespace {

/// A fluid whose fields are given: u = (1 + x, 0, 2), p = 100 - 40 z, on any mesh.
struct GivenFluid : Fluid {
  explicit GivenFluid(const Mesh& on) : mesh(on), u(3 * on.nodes, 0.0), p(on.nodes) {
    density_ = 3;
    load_ = ParticleLoad(on.nodes);
    for (int i = 0; i < on.nodes; ++i) {
      const double* x = &on.node_coordinates[3 * i];
      u[3 * i] = 1 + x[0];
      u[3 * i + 2] = 2;
      p[i] = 100 - 40 * x[2];
      load_.void_fraction[i] = 0.5;
    }
  }
  FluidStep advance(double, double) override { return {}; }
  double courant_rate() const override { return 0; }
  std::span<const double> velocity() const override { return u; }
  std::span<const double> velocity_change() const override { return u; }
  std::span<const double> pressure() const override { return p; }
  std::span<const double> pressure_gradient() const override { return u; }
  std::vector<BoundaryFlow> boundary_flow() const override {
    std::vector<BoundaryFlow> flow(mesh.boundaries.size());
    for (size_t b = 0; b < flow.size(); ++b) {
      const std::string& name = mesh.boundaries[b];
      flow[b].mean_pressure = name == "z_min" ? 100 : name == "z_max" ? 60 : 80;
      flow[b].volume_flow = name == "z_min" ? -1 : name == "z_max" ? 1 : 0;
      flow[b].force = Vec3(0, 0, static_cast<double>(b));
    }
    return flow;
  }
  std::vector<StateArray> state() override { return {}; }
  const Mesh& mesh;
  std::vector<double> u, p;
};

Mesh box(const std::string& cell = "hexahedron") {
  MeshOptions options;
  options.cell = cell;
  options.cells = {2, 2, 3};
  return Mesh(options);
}

Moment moment_of(const Fluid& fluid, double time = 0) {
  Moment moment;
  moment.time = time;
  moment.fluid = &fluid;
  return moment;
}

OutputDirectory made(const TemporaryDirectory& folder) {
  OutputOptions options;
  options.directory = folder / "run";
  OutputDirectory directory(options);
  directory.prepare("");
  return directory;
}

}  // namespace

TEST_CASE("the pressure drop is that from where fluid is given to where pressure is, or the largest there is",
          "[app][mpi]") {
  const Mesh mesh = box();
  const GivenFluid fluid(mesh);
  TemporaryDirectory folder;
  const OutputDirectory directory = made(folder);
  const auto drop = [&](std::vector<std::pair<std::string, std::string>> types) {
    Options options;
    for (const auto& [name, type] : types) options.set("boundary_" + name + "_type", type);
    Diagnostics diagnostics(mesh, options, Vec3(0, 0, -9.81), &fluid, nullptr);
    diagnostics.start(directory);
    Quantities quantities;
    diagnostics.sample(moment_of(fluid), quantities);
    return *quantities.find("pressure_drop");
  };
  CHECK(drop({{"z_min", "velocity"}, {"z_max", "pressure"}}) == Approx(40));
  CHECK(drop({{"z_min", "mass_flow"}, {"x_min", "mass_flow"}, {"z_max", "pressure"}}) == Approx(30));
  CHECK(drop({{"z_min", "no_slip"}, {"z_max", "no_slip"}}) == Approx(40));
  CHECK(drop({{"x_min", "velocity"}, {"z_max", "pressure"}}) == Approx(20));
}

TEST_CASE("integrals of the fluid are those of its fields", "[app][mpi]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box(cell);
    const GivenFluid fluid(mesh);
    TemporaryDirectory folder;
    const OutputDirectory directory = made(folder);
    Options options;
    Diagnostics diagnostics(mesh, options, Vec3(0, 0, -9.81), &fluid, nullptr);
    diagnostics.start(directory);
    Quantities q;
    diagnostics.sample(moment_of(fluid), q);
    CHECK(*q.find("mean_void_fraction") == Approx(0.5));
    CHECK(*q.find("least_void_fraction") == Approx(0.5));
    CHECK(*q.find("fluid_velocity_x") == Approx(1.5));
    CHECK(*q.find("fluid_velocity_z") == Approx(2));
    CHECK(*q.find("largest_fluid_speed") == Approx(std::sqrt(8)));
    // The nodal rule for int (1 + x)^2 on two cells: 7/3 + h^2/6.
    CHECK(*q.find("fluid_kinetic_energy") ==
          Approx(0.5 * 3 * 0.5 * (4 + 7.0 / 3 + 0.25 / 6)).epsilon(cell[0] == 'h' ? 1e-12 : 0.01));
    CHECK(*q.find("inflow") == Approx(1));
    CHECK(*q.find("outflow") == Approx(1));
    CHECK(*q.find("z_min.pressure") == Approx(100));
    for (const auto& column : diagnostics.columns()) CHECK(q.find(column));
  }
}

TEST_CASE("a probe gives linear fields exactly, on every rank", "[app][mpi]") {
  for (const char* cell : {"hexahedron", "tetrahedron"}) {
    const Mesh mesh = box(cell);
    const GivenFluid fluid(mesh);
    TemporaryDirectory folder;
    const OutputDirectory directory = made(folder);
    Options options;
    options.set("probe_tip_point", "0.3,0.7,0.45");
    options.set("line_axis_from", "0,0.5,0");
    options.set("line_axis_to", "1,0.5,1");
    options.set("line_axis_points", "5");
    Probes probes(mesh, options, &fluid);
    probes.start(directory);
    Quantities q;
    probes.sample(moment_of(fluid), q);
    CHECK(*q.find("tip.velocity_x") == Approx(1.3));
    CHECK(*q.find("tip.pressure") == Approx(82));
    CHECK(*q.find("tip.void_fraction") == Approx(0.5));
    probes.write_lines(moment_of(fluid));
    const auto p = probes.line("axis.pressure");
    REQUIRE(p.size() == 5);
    for (size_t k = 0; k < 5; ++k) CHECK(p[k] == Approx(100 - 10.0 * static_cast<double>(k)));
    CHECK(probes.line("axis.temperature").empty());
    options.set("probe_tip_point", "0.3,0.7,1.45");
    CHECK_THROWS_WITH(Probes(mesh, options, &fluid),
                      Catch::Contains("-probe_tip_point") && Catch::Contains("outside the mesh"));
    CHECK_THROWS_AS(Probes(mesh, options, nullptr), UserError);
  }
}

TEST_CASE("the ledger stops a run whose exchange is out of balance, on every rank", "[app][mpi]") {
  const Mesh mesh = box();
  const GivenFluid fluid(mesh);
  TemporaryDirectory folder;
  const OutputDirectory directory = made(folder);
  Options options;
  Budget budget(options, true, false);
  budget.start(directory, &fluid, nullptr);
  ExchangeLedger exchange;
  exchange.residual = 1e-13;
  CHECK(budget.close(moment_of(fluid, 0.1), nullptr, {&exchange}) == 1e-13);
  exchange.residual = 2e-10;
  CHECK_THROWS_WITH(budget.close(moment_of(fluid, 0.2), nullptr, {&exchange}),
                    Catch::Contains("out of balance at t = 0.2"));
  exchange.residual = std::nan("");
  CHECK_THROWS_AS(budget.close(moment_of(fluid, 0.3), nullptr, {&exchange}), RunError);
  MPI_Barrier(PETSC_COMM_WORLD);
  std::ifstream in(directory.path("ledger.csv"));
  int lines = 0;
  for (std::string line; std::getline(in, line);) ++lines;
  CHECK(lines == 4);  // the row that stops the run is written too
}
