#include <catch2/catch.hpp>

#include "coupling/filter.hpp"
#include "coupling/meshes.hpp"

using namespace silt;
using namespace silt::test;

TEST_CASE("the filter is its own adjoint, keeps constants and totals, and never overshoots", "[mpi][filter]") {
  for (const auto& kind : kinds) {
    Mesh mesh(box(kind.cell, kind.cells));
    if (kind.bent) bend(mesh);
    const auto mass = lumped_mass(mesh);
    for (const bool automatic : {true, false}) {
      const Filter filter(mesh, mass, automatic ? automatic_diffusivity(mesh, 0.02) : uniform_diffusivity(0.15));
      std::vector<double> a(mesh.nodes), b(mesh.nodes), ma(mesh.nodes), mb(mesh.nodes), one(mesh.nodes, 1.0);
      for (int i = 0; i < mesh.nodes; ++i) {
        a[i] = noise(mesh, i, 1), b[i] = noise(mesh, i, 2);
        ma[i] = mass[i] * a[i], mb[i] = mass[i] * b[i];
      }
      auto sa = a, sb = b;
      filter.apply(sa.data(), 1);
      filter.apply(sb.data(), 1);
      INFO(kind.cell << " bent " << kind.bent << " passes " << filter.passes());
      const double size = std::sqrt(total(mesh, ma, a) * total(mesh, mb, b));
      CHECK(std::abs(total(mesh, ma, sb) - total(mesh, mb, sa)) < 1e-15 * size);
      CHECK(std::abs(total(mesh, mass, sa) - total(mesh, mass, a)) <
            1e-14 * std::sqrt(mesh.volume * total(mesh, ma, a)));
      filter.apply(one.data(), 1);
      CHECK(std::all_of(one.begin(), one.end(), [](double x) { return x == 1.0; }));

      // A single loaded node: what comes out is nowhere negative, and nowhere above what went in.
      std::vector<double> spike(mesh.nodes, 0.0);
      for (int i = 0; i < mesh.nodes; ++i) spike[i] = mesh.node_global[i] == mesh.total_nodes / 2 ? 1 : 0;
      filter.apply(spike.data(), 1);
      for (const double s : spike) REQUIRE((s >= 0 && s <= 1));
    }
  }
}

TEST_CASE("components filtered together come out as filtered one by one", "[mpi][filter]") {
  Mesh mesh(box("hexahedron", {4, 3, 3}));
  const auto mass = lumped_mass(mesh);
  const Filter filter(mesh, mass, uniform_diffusivity(0.2));
  for (int components = 1; components <= 6; ++components) {
    std::vector<double> together(components * mesh.nodes);
    for (int c = 0; c < components; ++c) {
      for (int i = 0; i < mesh.nodes; ++i) together[components * i + c] = noise(mesh, i, c);
    }
    filter.apply(together.data(), components);
    for (int c = 0; c < components; ++c) {
      std::vector<double> alone(mesh.nodes);
      for (int i = 0; i < mesh.nodes; ++i) alone[i] = noise(mesh, i, c);
      filter.apply(alone.data(), 1);
      for (int i = 0; i < mesh.nodes; ++i) REQUIRE(together[components * i + c] == Approx(alone[i]).margin(1e-14));
    }
  }
}

TEST_CASE("the kernel of the filter has variance 2 l^2 in each direction", "[filter]") {
  // Far from walls the second moment of what a node spreads is exact, whatever the mesh width.
  for (const auto& [cell, cells] : std::vector<std::pair<std::string, std::vector<int>>>{
           {"hexahedron", {20, 20, 20}}, {"hexahedron", {20, 12, 24}}}) {
    Mesh mesh(box(cell, cells));
    const auto mass = lumped_mass(mesh);
    const double length = 0.06;
    const Filter filter(mesh, mass, uniform_diffusivity(length));
    std::vector<double> f(mesh.nodes, 0.0);
    for (int i = 0; i < mesh.nodes; ++i)
      f[i] = (vec3(&mesh.node_coordinates[3 * i]) - Vec3::Constant(0.5)).norm() < 1e-9 ? 1 / mass[i] : 0;
    filter.apply(f.data(), 1);
    Vec3 variance = Vec3::Zero();
    for (int i = 0; i < mesh.nodes; ++i) {
      for (int d = 0; d < 3; ++d) variance[d] += mass[i] * f[i] * std::pow(mesh.node_coordinates[3 * i + d] - 0.5, 2);
    }
    for (int d = 0; d < 3; ++d) CHECK(variance[d] == Approx(2 * length * length).epsilon(1e-3));
  }
}

TEST_CASE("refined at fixed length the filter converges to diffusion, second order, up to reflecting walls",
          "[convergence][filter]") {
  // cos(pi x) cos(2 pi y) decays as exp(-l^2 (1 + 4) pi^2) under natural boundaries.
  const double length = 0.08, exact = std::exp(-5 * std::pow(std::numbers::pi * length, 2));
  for (const std::string cell : {"quadrilateral", "triangle", "hexahedron", "tetrahedron"}) {
    const bool plane = cell == "quadrilateral" || cell == "triangle";
    for (const int n : plane ? std::vector<int>{8, 16, 32, 64} : std::vector<int>{8, 20}) {
      Mesh mesh(box(cell, plane ? std::vector<int>{n, n} : std::vector<int>{n, n, n}));
      const auto mass = lumped_mass(mesh);
      const Filter filter(mesh, mass, uniform_diffusivity(length));
      std::vector<double> f(mesh.nodes), wave(mesh.nodes);
      for (int i = 0; i < mesh.nodes; ++i) {
        const double* x = &mesh.node_coordinates[3 * i];
        f[i] = wave[i] = std::cos(std::numbers::pi * x[0]) * std::cos(2 * std::numbers::pi * x[1]);
      }
      filter.apply(f.data(), 1);
      double error = 0;
      for (int i = 0; i < mesh.nodes; ++i) error += mass[i] * std::pow(f[i] - exact * wave[i], 2);
      error = std::sqrt(error) * n * n;
      INFO(cell << " n " << n << " error n^2 " << error);
      CHECK(error < 1.5);
    }
  }
}

TEST_CASE("the automatic filter is two cells or two diameters wide, whichever is more, in each direction", "[filter]") {
  const Mesh mesh(box("hexahedron", {10, 5, 20}));
  for (const double diameter : {0.01, 0.15}) {
    const Mat3 D = automatic_diffusivity(mesh, diameter)(0);
    const Vec3 cell(0.1, 0.2, 0.05);
    for (int d = 0; d < 3; ++d) CHECK(std::sqrt(2 * D(d, d)) == Approx(std::max(cell[d], diameter)));
    CHECK(std::abs(D(0, 1)) + std::abs(D(0, 2)) + std::abs(D(1, 2)) < 1e-16);
  }
}

TEST_CASE("a filter of no length leaves the field as it is", "[filter]") {
  const Mesh mesh(box("tetrahedron", {3, 3, 3}));
  const Filter filter(mesh, lumped_mass(mesh), uniform_diffusivity(0));
  CHECK(filter.passes() == 0);
}
