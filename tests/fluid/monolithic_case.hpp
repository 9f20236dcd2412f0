#pragma once
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "fluid/assembly/flow_table.hpp"
#include "fluid/monolithic.hpp"

namespace silt::test {

/// A box with the monolithic scheme on it. Option names are the user's; -fluid_snes_... and the like go to PETSc too.
struct MonolithicCase {
  Options options;
  std::unique_ptr<Mesh> mesh;
  std::unique_ptr<Monolithic> fluid;
  FluidOptions common;

  MonolithicCase(const std::string& cell, std::vector<int> cells, const std::string& element) {
    mesh_options.cell = cell;
    mesh_options.cells = std::move(cells);
    options.set("fluid_element", element);
    options.set("fluid_density", "1");
    options.set("fluid_viscosity", "1");
  }
  MeshOptions mesh_options;
  void boundary(const std::string& names, const std::string& property, const std::string& value) {
    size_t start = 0;
    while (start < names.size()) {
      size_t end = names.find(' ', start);
      if (end == std::string::npos) end = names.size();
      options.set("boundary_" + names.substr(start, end - start) + "_" + property, value);
      start = end + 1;
    }
  }
  void all_boundaries(const std::string& property, const std::string& value) {
    boundary(three() ? "x_min x_max y_min y_max z_min z_max" : "x_min x_max y_min y_max", property, value);
  }
  bool three() const { return mesh_options.cell == "tetrahedron" || mesh_options.cell == "hexahedron"; }
  void start(const Vec3& gravity = Vec3::Zero()) {
    options.insert_into_petsc();
    mesh = std::make_unique<Mesh>(mesh_options);
    options.read("fluid", common);
    fluid = std::make_unique<Monolithic>(*mesh, options, common, gravity);
  }

  /// L2 norms of the errors of velocity and pressure (the mean pressure difference taken out).
  template <class U, class P>
  std::pair<double, double> errors(U u, P p) const {
    const LagrangeSpace& space = fluid->system().space();
    const FlowTable& table = flow_table(mesh->cell, 2);
    const FlowTable& own = flow_table(mesh->cell, space.order);
    (void)own;
    double velocity = 0, pressure = 0, mean = 0, volume = 0;
    const auto values = fluid->all_velocities();
    for (int pass = 0; pass < 2; ++pass) {
      for (int c = 0; c < mesh->cells; ++c) {
        const int np = mesh->nodes_per_cell, nv = space.nodes_per_cell;
        for (int q = 0; q < table.points; ++q) {
          Mat3 J = Mat3::Zero();
          Vec3 x = Vec3::Zero(), uh = Vec3::Zero();
          double ph = 0;
          for (int a = 0; a < np; ++a) {
            const auto X = vec3(&mesh->cell_coordinates[3 * (static_cast<size_t>(c) * np + a)]);
            x += table.M[q][a] * X;
            J += X * vec3(table.dM[q][a]).transpose();
            ph += table.M[q][a] * fluid->pressure()[mesh->cell_nodes[static_cast<size_t>(c) * np + a]];
          }
          if (mesh->dimension == 2) J(2, 2) = 1;
          for (int a = 0; a < nv; ++a)
            uh += (space.order == 1 ? table.M[q][a] : table.N[q][a]) *
                  vec3(&values[3 * static_cast<size_t>(space.cell_nodes[static_cast<size_t>(c) * nv + a])]);
          const double w = table.weight[q] * J.determinant(), dp = ph - p(x);
          if (pass == 0) {
            velocity += w * (uh - u(x)).squaredNorm();
            mean += w * dp;
            volume += w;
          } else {
            pressure += w * (dp - mean) * (dp - mean);
          }
        }
      }
      if (pass == 0) mean = mpi_sum(mean) / mpi_sum(volume);
    }
    return {std::sqrt(mpi_sum(velocity)), std::sqrt(mpi_sum(pressure))};
  }
};

}  // namespace silt::test
