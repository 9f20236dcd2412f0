#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "flow_case.hpp"

using namespace silt;
using silt::test::FlowCase;

namespace {

/// A starting flow through a duct of length 2 and unit section.
FlowCase duct(const std::string& scheme, const std::string& cell, int n,
              const std::vector<std::pair<std::string, std::string>>& more = {}) {
  std::vector<std::pair<std::string, std::string>> settings = {
      {"mesh_type", "box"},
      {"mesh_cell", cell},
      {"mesh_upper", "2, 1, 1"},
      {"mesh_cells", std::to_string(2 * n) + ", " + std::to_string(n) + ", " + std::to_string(n)},
      {"fluid_scheme", scheme},
      {"fluid_density", "1"},
      {"fluid_viscosity", "0.001"},
      {"boundary_x_min_type", "velocity"},
      {"boundary_x_min_velocity", "36*y*(1-y)*z*(1-z)*(1 + 0.1*sin(20*t)), 0, 0"},
      {"boundary_x_max_type", "pressure"}};
  for (const char* side : {"y_min", "y_max", "z_min", "z_max"})
    settings.emplace_back(std::string("boundary_") + side + "_type", "no_slip");
  settings.insert(settings.end(), more.begin(), more.end());
  return FlowCase(settings);
}

struct Iterations {
  double velocity = 0, pressure = 0, newton = 0;
};

/// Mean over steps `first` to 8 at one Courant number.
Iterations mean_iterations(FlowCase flow, int n, int first) {
  Iterations mean;
  const double share = 1.0 / (9 - first);
  for (int k = 1; k <= 8; ++k) {
    const FluidStep step = flow.advance(0.5 / n);
    if (k < first) continue;
    mean.velocity += step.velocity_iterations * share;
    mean.pressure += step.pressure_iterations * share;
    mean.newton += step.newton_iterations * share;
  }
  return mean;
}

}  // namespace

TEST_CASE("Iterations of the pressure correction do not grow with the mesh", "[fluid]") {
  const std::string cell = GENERATE("hexahedron", "tetrahedron");
  const Iterations coarse = mean_iterations(duct("pressure_correction", cell, 6), 6, 5),
                   fine = mean_iterations(duct("pressure_correction", cell, 18), 18, 5);
  WARN(cell << ": velocity " << coarse.velocity << " -> " << fine.velocity << ", pressure " << coarse.pressure << " -> "
            << fine.pressure << " from " << 4 * 13 * 49 << " to " << 4 * 37 * 361 << " unknowns");
  CHECK(fine.velocity + fine.pressure < 1.5 * (coarse.velocity + coarse.pressure));
  // The guess is extrapolated and only the rest is solved for: a handful of multigrid cycles.
  CHECK(fine.pressure < 12);
  CHECK(fine.velocity < 12);
}

TEST_CASE("With the pressure stage the iterations of the monolithic scheme do not grow with the mesh",
          "[monolithic][slow]") {
  const std::string cell = GENERATE("hexahedron", "tetrahedron");
  const auto linear = [&](int n, const char* stage) {
    PetscOptionsSetValue(nullptr, "-fluid_ksp_rtol", "1e-4");
    const Iterations mean = mean_iterations(duct("monolithic", cell, n, {{"fluid_pressure_stage", stage}}), n, 5);
    PetscOptionsClearValue(nullptr, "-fluid_ksp_rtol");
    return mean.velocity / mean.newton;
  };
  const double coarse = linear(4, "yes"), fine = linear(10, "yes"), local = linear(10, "no");
  WARN(cell << ": linear iterations a Newton iteration " << coarse << " -> " << fine << ", without the stage "
            << local);
  CHECK(fine < 1.5 * coarse);
  CHECK(fine < 0.7 * local);
}

TEST_CASE("The pressure stage changes how the flow is found, not the flow", "[monolithic][mpi]") {
  const std::string cell = GENERATE("hexahedron", "triangle");
  std::shared_ptr<Mesh> mesh;  // of both: two meshes of the same options may be partitioned differently
  const auto velocity = [&](const char* stage) {
    std::vector<std::pair<std::string, std::string>> settings = {{"mesh_type", "box"},
                                                                 {"mesh_cell", cell},
                                                                 {"fluid_scheme", "monolithic"},
                                                                 {"fluid_density", "1"},
                                                                 {"fluid_viscosity", "0.01"},
                                                                 {"fluid_pressure_stage", stage},
                                                                 {"boundary_y_max_velocity", "1, 0, 0"}};
    settings.emplace_back("mesh_cells", cell == "triangle" ? "10, 10" : "6, 6, 6");
    for (const char* side : {"x_min", "x_max", "y_min", "y_max"})
      settings.emplace_back(std::string("boundary_") + side + "_type", "no_slip");
    if (cell != "triangle")
      for (const char* side : {"z_min", "z_max"})
        settings.emplace_back(std::string("boundary_") + side + "_type", "slip");
    PetscOptionsSetValue(nullptr, "-fluid_snes_rtol", "1e-11");
    FlowCase flow(settings, Vec3::Zero(), mesh);
    mesh = flow.mesh;
    for (int k = 0; k < 3; ++k) flow.advance(0.05);
    PetscOptionsClearValue(nullptr, "-fluid_snes_rtol");
    return std::vector<double>(flow.fluid->velocity().begin(), flow.fluid->velocity().end());
  };
  const auto with = velocity("yes"), without = velocity("no");
  REQUIRE(with.size() == without.size());
  double difference = 0;
  for (size_t i = 0; i < with.size(); ++i) difference = std::max(difference, std::abs(with[i] - without[i]));
  CHECK(mpi_max(difference) < 1e-8);
}
