#pragma once
#include <cmath>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>

#include "base/mesh.hpp"
#include "base/options.hpp"
#include "fluid/fluid.hpp"

namespace silt::test {

/// A mesh and a fluid from options, for the tests of the fluid.
struct FlowCase {
  using Settings = std::vector<std::pair<std::string, std::string>>;
  Options options;
  std::unique_ptr<Mesh> mesh;
  std::unique_ptr<Fluid> fluid;
  double time = 0;

  explicit FlowCase(const Settings& settings, const Vec3& gravity = Vec3::Zero()) {
    for (const auto& [name, value] : settings) options.set(name, value);
    MeshOptions mesh_options;
    options.read("mesh", mesh_options);
    mesh = std::make_unique<Mesh>(mesh_options);
    fluid = Fluid::create(*mesh, options, gravity);
  }
  FluidStep advance(double dt) {
    const FluidStep step = fluid->advance(time, dt);
    time += dt;
    return step;
  }
  Vec3 position(int i) const { return vec3(&mesh->node_coordinates[3 * i]); }

  /// Root of the mean square over the domain of the interpolated field less the exact one, components of an interlaced
  /// field, by a rule exact enough to measure order 2.
  double error(std::span<const double> field, int components, const std::function<Vec3(const Vec3&)>& exact) const {
    const auto rule = quadrature(mesh->cell, 4);
    const int nv = mesh->nodes_per_cell;
    double sum = 0;
    for (int c = 0; c < mesh->cells; ++c)
      for (int q = 0; q < rule.points; ++q) {
        double N[8], dN[8][3];
        shape(mesh->cell, rule.point[q].data(), N, dN);
        Vec3 x = Vec3::Zero(), value = Vec3::Zero();
        Mat3 J = Mat3::Zero();
        for (int a = 0; a < nv; ++a) {
          const auto corner = vec3(&mesh->cell_coordinates[3 * (static_cast<std::size_t>(c) * nv + a)]);
          const int i = mesh->cell_nodes[static_cast<std::size_t>(c) * nv + a];
          x += N[a] * corner;
          J += corner * vec3(dN[a]).transpose();
          for (int d = 0; d < components; ++d) value[d] += N[a] * field[static_cast<std::size_t>(components) * i + d];
        }
        if (mesh->dimension == 2) J(2, 2) = 1;
        sum += rule.weight[q] * J.determinant() * (value - exact(x)).squaredNorm();
      }
    return std::sqrt(mpi_sum(sum) / mesh->volume);
  }
  /// Value of component d of a field at the node nearest to x, on every rank.
  double value(std::span<const double> field, int components, int d, const Vec3& x) const {
    double best = infinity, result = 0;
    for (int i = 0; i < mesh->nodes; ++i) {
      const double distance = (position(i) - x).norm();
      if (distance < best) best = distance, result = field[static_cast<std::size_t>(components) * i + d];
    }
    const double least = mpi_min(best);
    return mpi_max(best <= least * (1 + 1e-12) + 1e-300 ? result : -infinity);
  }
};

}  // namespace silt::test
