#include <catch2/catch.hpp>

#include "flow_case.hpp"

using namespace silt;
using namespace silt::test;

namespace {

FlowCase::Settings channel(const std::string& cell, const std::string& cells) {
  const bool flat = cell == "triangle" || cell == "quadrilateral";
  FlowCase::Settings settings = {{"mesh_type", "box"},
                                 {"mesh_cell", cell},
                                 {"mesh_lower", "0, 0, 0"},
                                 {"mesh_upper", flat ? "2, 1, 0" : "2, 1, 0.5"},
                                 {"mesh_cells", cells},
                                 {"fluid_density", "1"},
                                 {"fluid_viscosity", "0.1"},
                                 {"boundary_x_min_type", "velocity"},
                                 {"boundary_x_min_velocity", "6*y*(1-y), 0, 0"},
                                 {"boundary_x_max_type", "pressure"},
                                 {"boundary_y_min_type", "no_slip"},
                                 {"boundary_y_max_type", "no_slip"}};
  if (!flat) {
    settings.push_back({"boundary_z_min_type", "slip"});
    settings.push_back({"boundary_z_max_type", "symmetry"});
  }
  return settings;
}

}  // namespace

TEST_CASE("Plane Poiseuille flow has its parabola and its pressure drop on every cell", "[fluid][mpi]") {
  const auto [cell, cells] = GENERATE(std::pair{"quadrilateral", "16, 8"}, std::pair{"triangle", "16, 8"},
                                      std::pair{"hexahedron", "16, 8, 2"}, std::pair{"tetrahedron", "16, 8, 2"});
  CAPTURE(cell);
  FlowCase flow(channel(cell, cells));
  FluidStep step;
  for (int k = 0; k < 60; ++k) step = flow.advance(0.1);
  // dp/dx = -12 mu U/h^2 = -1.2, over length 2. The exact flow 1 on a parabola of chords makes velocity and pressure
  // gradient larger by 1/(1 - 1/64), and the flow adapts to it behind the inlet.
  const double error =
      flow.error(flow.fluid->velocity(), 3, [](const Vec3& x) { return Vec3(6 * x.y() * (1 - x.y()), 0, 0); });
  const auto boundaries = flow.fluid->boundary_flow();
  const double drop = boundaries[0].mean_pressure - boundaries[1].mean_pressure;
  CHECK(error < 0.012);
  CHECK(drop == Approx(2.4 * 64 / 63).epsilon(0.04));
  CHECK(std::abs(step.mass_residual) < 1e-4);
  CHECK(boundaries[1].volume_flow == Approx(-boundaries[0].volume_flow).epsilon(1e-4));
}
