#include <catch2/catch.hpp>

#include "monolithic_case.hpp"

using namespace silt;
using silt::test::MonolithicCase;

TEST_CASE("Drag, lift and pressure difference of the cylinder of DFG 2D-1 agree with the benchmark",
          "[monolithic][slow]") {
  // Schaefer & Turek (1996), figures to many digits: FeatFlow. Mean inflow 0.2 m/s, D 0.1 m, nu 1e-3, Re 20.
  constexpr double drag = 5.57953523384, lift = 0.010618948146, difference = 0.11752016697;
  const std::string element = GENERATE("equal_order", "taylor_hood");
  MonolithicCase flow("triangle", {}, element);
  flow.mesh_options.type = "file";
  flow.mesh_options.file = SILT_SOURCE_DIR "/inputs/fluid/dfg_2d1.msh";
  flow.options.set("fluid_viscosity", "1e-3");
  flow.boundary("wall cylinder", "type", "no_slip");
  flow.boundary("inlet", "type", "velocity");
  flow.boundary("inlet", "velocity", "4*0.3*y*(0.41 - y)/0.41^2, 0, 0");
  flow.boundary("outlet", "type", "pressure");
  flow.start();
  const FluidStep step = flow.fluid->advance(0, 1e6);
  const auto flows = flow.fluid->boundary_flow();
  Vec3 force = Vec3::Zero();
  for (size_t b = 0; b < flows.size(); ++b)
    if (flow.mesh->boundaries[b] == "cylinder") force = flows[b].force;
  const auto pressure_at = [&](double x, double y) {
    for (int i = 0; i < flow.mesh->nodes; ++i)
      if ((vec3(&flow.mesh->node_coordinates[3 * static_cast<size_t>(i)]) - Vec3(x, y, 0)).norm() < 1e-6)
        return flow.fluid->pressure()[i];
    FAIL("no node there");
    return 0.0;
  };
  const double scale = 2 / (0.2 * 0.2 * 0.1), found = pressure_at(0.15, 0.2) - pressure_at(0.25, 0.2);
  WARN(element << " drag " << scale * force.x() << " (" << 100 * (scale * force.x() / drag - 1) << " %), lift "
               << scale * force.y() << " (" << 100 * (scale * force.y() / lift - 1) << " %), dp " << found << " ("
               << 100 * (found / difference - 1) << " %), Newton " << step.newton_iterations << ", linear "
               << step.velocity_iterations);
  const double tolerance = element == "taylor_hood" ? 1e-3 : 5e-3;
  CHECK(scale * force.x() == Approx(drag).epsilon(tolerance));
  CHECK(scale * force.y() == Approx(lift).epsilon(element == "taylor_hood" ? 0.01 : 0.05));
  CHECK(found == Approx(difference).epsilon(tolerance));
  CHECK(std::abs(step.mass_residual) < 1e-7);
}
