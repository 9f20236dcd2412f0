#include <catch2/catch.hpp>

#include "base/locator.hpp"
#include "coupling/filter.hpp"
#include "coupling/kernel.hpp"
#include "coupling/meshes.hpp"

using namespace silt;
using namespace silt::test;

namespace {

/// Spheres anywhere in the box, some with their centres on its walls, edges and corners and on facets between cells;
/// each held by one rank.
struct Cloud {
  std::vector<Vec3> position;
  std::vector<double> volume;
  Kernel kernel;
  double total_volume = 0;

  Cloud(const Mesh& mesh, const Locator& locator, int count, double diameter) : kernel(mesh) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Vec3> points(count);
    for (int k = 0; k < count; ++k) {
      for (int d = 0; d < mesh.dimension; ++d) {
        double s = unit(random);
        if (k % 5 == 1) s = std::round(s * 60) / 60;
        if (k % 5 == 2 && d == k % 3) s = s < 0.5 ? 0 : 1;
        points[k][d] = mesh.lower[d] + s * (mesh.upper[d] - mesh.lower[d]);
      }
      if (mesh.dimension == 2) points[k][2] = 0;
    }
    const auto places = locator.claim(points);
    for (int k = 0; k < count; ++k) {
      const double v = std::numbers::pi / 6 * std::pow(diameter * (0.5 + 0.01 * (k % 50)), 3);
      total_volume += v;
      if (!places[k].inside()) continue;
      position.push_back(points[k]);
      volume.push_back(v);
    }
    kernel.resize(static_cast<int>(position.size()));
    for (int k = 0, p = 0; k < count; ++k) {
      if (places[k].inside()) kernel.place(p++, places[k].cell, places[k].xi.data());
    }
  }
};

}  // namespace

TEST_CASE("the volume deposited is the particles', for every cell kind, cell size, near walls and over ranks",
          "[mpi][kernel]") {
  const double diameter = 0.05;
  for (const auto& [cell, plane] : std::vector<std::pair<std::string, bool>>{
           {"hexahedron", false}, {"tetrahedron", false}, {"quadrilateral", true}, {"triangle", true}}) {
    for (const bool bent : {false, true}) {
      for (const double size : {4.0, 2.0, 1.0, 0.5}) {
        const int n = static_cast<int>(std::lround(0.4 / (size * diameter)));
        Mesh mesh(box(cell, plane ? std::vector<int>{n, n} : std::vector<int>{n, n, n}, Vec3::Constant(0.4)));
        if (bent) bend(mesh);
        const auto mass = lumped_mass(mesh);
        const Locator locator(mesh);
        const Cloud cloud(mesh, locator, 300, diameter);
        const Filter filter(mesh, mass, automatic_diffusivity(mesh, diameter));
        std::vector<double> field(mesh.nodes);
        cloud.kernel.deposit(cloud.volume, field, 1);
        for (int i = 0; i < mesh.nodes; ++i) field[i] /= mass[i];
        INFO(cell << " bent " << bent << " cells of " << size << " d, passes " << filter.passes());
        CHECK(total(mesh, mass, field) == Approx(cloud.total_volume).epsilon(1e-13));
        filter.apply(field.data(), 1);
        CHECK(total(mesh, mass, field) == Approx(cloud.total_volume).epsilon(1e-13));
        for (const double f : field) REQUIRE(f >= 0);
      }
    }
  }
}

TEST_CASE("sampling is the adjoint of depositing, with and without the filter", "[mpi][kernel]") {
  for (const auto& kind : kinds) {
    Mesh mesh(box(kind.cell, kind.cells));
    if (kind.bent) bend(mesh);
    const auto mass = lumped_mass(mesh);
    const Locator locator(mesh);
    const Cloud cloud(mesh, locator, 200, 0.1);
    const Filter filter(mesh, mass, automatic_diffusivity(mesh, 0.1));
    const int count = cloud.kernel.count();
    std::vector<double> f(3 * mesh.nodes), q(3 * count), b(3 * mesh.nodes), values(3 * count);
    for (std::size_t k = 0; k < f.size(); ++k) f[k] = noise(mesh, static_cast<int>(k / 3), static_cast<int>(k % 3));
    for (int p = 0; p < count; ++p) {
      for (int d = 0; d < 3; ++d) q[3 * p + d] = std::sin(1e3 * cloud.position[p][d % 2] + d);
    }
    const auto on_particles = [&] {
      double sum = 0;
      for (int k = 0; k < 3 * count; ++k) sum += q[k] * values[k];
      return mpi_sum(sum);
    };
    cloud.kernel.deposit(q, b, 3);
    cloud.kernel.sample(f, values, 3);
    INFO(kind.cell << " bent " << kind.bent);
    CHECK(std::abs(mesh.dot(b.data(), f.data(), 3) - on_particles()) < 1e-13);
    // The load of the filtered deposit is M S M^-1 b; the filtered field is S f.
    for (std::size_t k = 0; k < b.size(); ++k) b[k] /= mass[k / 3];
    filter.apply(b.data(), 3);
    for (std::size_t k = 0; k < b.size(); ++k) b[k] *= mass[k / 3];
    const double fluid_side = mesh.dot(b.data(), f.data(), 3);
    filter.apply(f.data(), 3);
    cloud.kernel.sample(f, values, 3);
    CHECK(std::abs(fluid_side - on_particles()) < 1e-13);
  }
}

TEST_CASE("sampling reproduces constants, and linear fields on affine cells", "[mpi][kernel]") {
  for (const auto& kind : kinds) {
    Mesh mesh(box(kind.cell, kind.cells));
    if (kind.bent) bend(mesh);  // linear fields are reproduced there too: the map is isoparametric
    const Locator locator(mesh);
    const Cloud cloud(mesh, locator, 200, 0.1);
    std::vector<double> f(2 * mesh.nodes), values(2 * cloud.kernel.count());
    const Vec3 slope(2, -3, 5);
    for (int i = 0; i < mesh.nodes; ++i) {
      f[2 * i] = 7;
      f[2 * i + 1] = 1 + slope.dot(vec3(&mesh.node_coordinates[3 * i]));
    }
    cloud.kernel.sample(f, values, 2);
    for (int p = 0; p < cloud.kernel.count(); ++p) {
      REQUIRE(values[2 * p] == Approx(7).epsilon(1e-14));
      REQUIRE(values[2 * p + 1] == Approx(1 + slope.dot(cloud.position[p])).margin(1e-9));
    }
  }
}

TEST_CASE("refined at fixed diameter and filter length, the solids fraction converges", "[convergence][kernel]") {
  // A particle of diameter 0.2 filtered with l = 0.1 in open space: a Gaussian of variance 0.02 per direction that
  // carries its volume.
  const double length = 0.1, variance = 2 * length * length;
  const Vec3 centre(0.93, 1.04, 0.99);
  for (const std::string cell : {"quadrilateral", "triangle", "hexahedron", "tetrahedron"}) {
    const bool plane = cell == "quadrilateral" || cell == "triangle";
    const int dimension = plane ? 2 : 3;
    const double peak = 1 / std::pow(2 * std::numbers::pi * variance, 0.5 * dimension);
    double before = 0;
    for (const int n : plane ? std::vector<int>{20, 40, 80} : std::vector<int>{10, 20}) {
      Mesh mesh(box(cell, plane ? std::vector<int>{n, n} : std::vector<int>{n, n, n}, Vec3::Constant(2)));
      const auto mass = lumped_mass(mesh);
      const Locator locator(mesh);
      Kernel kernel(mesh);
      kernel.resize(1);
      const Place place = locator.find(centre);
      REQUIRE(place.inside());
      kernel.place(0, place.cell, place.xi.data());
      const Filter filter(mesh, mass, uniform_diffusivity(length));
      std::vector<double> field(mesh.nodes);
      kernel.deposit(std::vector<double>{1.0}, field, 1);
      for (int i = 0; i < mesh.nodes; ++i) field[i] /= mass[i];
      filter.apply(field.data(), 1);
      double error = 0;
      for (int i = 0; i < mesh.nodes; ++i) {
        const double r2 = (vec3(&mesh.node_coordinates[3 * i]) - centre).head(dimension).squaredNorm();
        error = std::max(error, std::abs(field[i] / peak - std::exp(-0.5 * r2 / variance)));
      }
      INFO(cell << " n " << n << " error relative to the peak " << error);
      if (n == 80) CHECK(std::log2(before / error) > 1.7);
      if (before > 0) CHECK(error < 0.75 * before);
      before = error;
    }
  }
}
