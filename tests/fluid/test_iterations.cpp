#include <catch2/catch.hpp>

#include "flow_case.hpp"

using namespace silt;
using silt::test::FlowCase;

namespace {

struct Iterations {
  double velocity = 0, pressure = 0;
};

/// Mean over steps 5 to 8 of a starting duct flow, h dependent on the step through one Courant number.
Iterations duct(const std::string& scheme, const std::string& cell, int n) {
  FlowCase flow({{"mesh_type", "box"},
                 {"mesh_cell", cell},
                 {"mesh_upper", "2, 1, 1"},
                 {"mesh_cells", std::to_string(2 * n) + ", " + std::to_string(n) + ", " + std::to_string(n)},
                 {"fluid_scheme", scheme},
                 {"fluid_density", "1"},
                 {"fluid_viscosity", "0.001"},
                 {"boundary_x_min_type", "velocity"},
                 {"boundary_x_min_velocity", "36*y*(1-y)*z*(1-z)*(1 + 0.1*sin(20*t)), 0, 0"},
                 {"boundary_x_max_type", "pressure"},
                 {"boundary_y_min_type", "no_slip"},
                 {"boundary_y_max_type", "no_slip"},
                 {"boundary_z_min_type", "no_slip"},
                 {"boundary_z_max_type", "no_slip"}});
  Iterations mean;
  for (int k = 1; k <= 8; ++k) {
    const FluidStep step = flow.advance(0.5 / n);
    if (k <= 4) continue;
    mean.velocity += step.velocity_iterations / 4.0;
    mean.pressure += step.pressure_iterations / 4.0;
  }
  return mean;
}

}  // namespace

TEST_CASE("Iterations of a step do not grow with the mesh", "[fluid]") {
  const std::string cell = GENERATE("hexahedron", "tetrahedron");
  const Iterations coarse = duct("pressure_correction", cell, 6), fine = duct("pressure_correction", cell, 18);
  WARN(cell << ": velocity " << coarse.velocity << " -> " << fine.velocity << ", pressure " << coarse.pressure << " -> "
            << fine.pressure << " from " << 4 * 13 * 49 << " to " << 4 * 37 * 361 << " unknowns");
  CHECK(fine.velocity + fine.pressure < 1.5 * (coarse.velocity + coarse.pressure));
  // The guess is extrapolated and only the rest is solved for: a handful of multigrid cycles.
  CHECK(fine.pressure < 12);
  CHECK(fine.velocity < 12);
}
