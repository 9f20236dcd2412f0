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
  std::shared_ptr<Mesh> mesh;
  std::unique_ptr<Fluid> fluid;
  double time = 0;

  /// `shared`: the mesh of another case (two meshes of the same options may be partitioned differently).
  explicit FlowCase(const Settings& settings, const Vec3& gravity = Vec3::Zero(),
                    std::shared_ptr<Mesh> shared = nullptr) {
    for (const auto& [name, value] : settings) options.set(name, value);
    MeshOptions mesh_options;
    options.read("mesh", mesh_options);
    mesh = shared ? shared : std::make_shared<Mesh>(mesh_options);
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

/// A held bed: drag -alpha_e kappa_e U, U = alpha u interpolated and kappa_e the cell mean of beta/alpha^2, as
/// particles spread evenly over each cell would exert it: the force at u^n as a load, and the row sums of its
/// derivative as the response. `void_fraction` and `drag` (beta, kg/m3/s) at the nodes.
inline void set_bed(FlowCase& flow, const std::function<double(const Vec3&)>& void_fraction,
                    const std::function<double(const Vec3&)>& drag) {
  const Mesh& mesh = *flow.mesh;
  auto& load = flow.fluid->load();
  const auto u = flow.fluid->carrying_velocity();
  std::vector<double> sums(4 * static_cast<std::size_t>(mesh.nodes), 0.0), beta(mesh.nodes);
  for (int i = 0; i < mesh.nodes; ++i) {
    load.void_fraction[i] = void_fraction(flow.position(i));
    beta[i] = drag(flow.position(i));
  }
  const auto rule = quadrature(mesh.cell, 3);
  const int nv = mesh.nodes_per_cell;
  for (int c = 0; c < mesh.cells; ++c) {
    const int* node = &mesh.cell_nodes[static_cast<std::size_t>(c) * nv];
    double mean = 0, kappa = 0;
    for (int a = 0; a < nv; ++a) {
      const double alpha = load.void_fraction[node[a]];
      mean += alpha / nv;
      kappa += beta[node[a]] / (alpha * alpha) / nv;
    }
    for (int q = 0; q < rule.points; ++q) {
      double N[8], dN[8][3], alpha = 0;
      shape(mesh.cell, rule.point[q].data(), N, dN);
      Vec3 U = Vec3::Zero();
      Mat3 J = Mat3::Zero();
      for (int a = 0; a < nv; ++a) {
        J += vec3(&mesh.cell_coordinates[3 * (static_cast<std::size_t>(c) * nv + a)]) * vec3(dN[a]).transpose();
        alpha += N[a] * load.void_fraction[node[a]];
        U += N[a] * load.void_fraction[node[a]] * vec3(u.data() + 3 * node[a]);
      }
      if (mesh.dimension == 2) J(2, 2) = 1;
      const double weight = rule.weight[q] * J.determinant() * mean * kappa;
      for (int a = 0; a < nv; ++a) {
        vec3(&sums[4 * node[a]]) -= weight * N[a] * U;
        sums[4 * node[a] + 3] += weight * N[a] * alpha;
      }
    }
  }
  mesh.sum_shared(sums.data(), 4);
  for (int i = 0; i < mesh.nodes; ++i) {
    vec3(&load.force[3 * i]) = vec3(&sums[4 * i]);
    load.response[i] = sums[4 * i + 3];
  }
}

}  // namespace silt::test
