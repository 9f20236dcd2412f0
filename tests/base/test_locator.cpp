#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "base/locator.hpp"

using namespace silt;

namespace {

MeshOptions box(const std::string& cell, std::vector<int> cells, std::vector<int> periodic = {0, 0, 0}) {
  MeshOptions options;
  options.cell = cell;
  options.cells = std::move(cells);
  options.periodic = std::move(periodic);
  options.lower = Vec3(-0.5, 0.25, 1);
  options.upper = Vec3(1.5, 1.25, 2);
  if (options.cells.size() == 2) options.lower[2] = options.upper[2] = 0;
  return options;
}

/// Bends the cells of a box smoothly, keeping its sides (and its periods): quadrilaterals and hexahedra are no longer
/// affine.
void bend(Mesh& mesh) {
  const auto move = [&](double* x) {
    Vec3 s = Vec3::Zero();
    for (int d = 0; d < mesh.dimension; ++d) s[d] = (x[d] - mesh.lower[d]) / (mesh.upper[d] - mesh.lower[d]);
    double wave = 0.1;
    for (int d = 0; d < mesh.dimension; ++d) wave *= std::sin(2 * std::numbers::pi * s[d]);
    for (int d = 0; d < mesh.dimension; ++d) x[d] += (d + 1) * wave * (mesh.upper[d] - mesh.lower[d]) / 3;
  };
  for (std::size_t k = 0; k < mesh.cell_coordinates.size(); k += 3) move(&mesh.cell_coordinates[k]);
  for (std::size_t k = 0; k < mesh.node_coordinates.size(); k += 3) move(&mesh.node_coordinates[k]);
}

struct Sampler {
  std::mt19937 random{7};
  std::uniform_real_distribution<double> unit{0, 1};
  std::array<double, 3> reference(Cell cell) {
    while (true) {
      std::array<double, 3> xi{unit(random), unit(random), cell_dimension(cell) == 3 ? unit(random) : 0.0};
      const bool simplex = cell == Cell::triangle || cell == Cell::tetrahedron;
      if (!simplex || xi[0] + xi[1] + xi[2] < 1) return xi;
    }
  }
  int cell(const Mesh& mesh) { return static_cast<int>(random() % static_cast<unsigned>(mesh.cells)); }
};

Vec3 place_of(const Mesh& mesh, int cell, const std::array<double, 3>& xi) {
  double N[8], dN[8][3];
  shape(mesh.cell, xi.data(), N, dN);
  Vec3 x = Vec3::Zero();
  for (int a = 0; a < mesh.nodes_per_cell; ++a) {
    x += N[a] * vec3(&mesh.cell_coordinates[3 * (cell * mesh.nodes_per_cell + a)]);
  }
  return x;
}

const std::vector<std::pair<std::string, std::vector<int>>> kinds = {
    {"triangle", {9, 7}}, {"quadrilateral", {9, 7}}, {"tetrahedron", {6, 5, 4}}, {"hexahedron", {6, 5, 4}}};

}  // namespace

TEST_CASE("a point is found in the cell it was placed in, whatever the cell kind, its shape and the starting cell",
          "[mpi][locator]") {
  for (const auto& [cell, cells] : kinds) {
    for (const bool bent : {false, true}) {
      Mesh mesh(box(cell, cells));
      if (bent) bend(mesh);
      const Locator locator(mesh);
      Sampler sample;
      int wrong = 0;
      double error = 0;
      for (int k = 0; k < (mesh.cells ? 2000 : 0); ++k) {
        const int home = sample.cell(mesh);
        const auto xi = sample.reference(mesh.cell);
        const Vec3 x = place_of(mesh, home, xi);
        for (const int hint : {-1, home, sample.cell(mesh)}) {
          const Place place = locator.find(x, hint);
          if (!place.inside() || place.cell != home) {
            ++wrong;
            continue;
          }
          for (int d = 0; d < 3; ++d) error = std::max(error, std::abs(place.xi[d] - xi[d]));
        }
      }
      INFO(cell << (bent ? " bent" : ""));
      CHECK(wrong == 0);
      CHECK(error < 1e-11);
    }
  }
}

TEST_CASE("points at nodes and facets belong to the lowest cell around them, from wherever one comes", "[locator]") {
  for (const auto& [cell, cells] : kinds) {
    Mesh mesh(box(cell, cells));
    bend(mesh);
    const Locator locator(mesh);
    std::vector<int> lowest(mesh.nodes, mesh.cells);
    for (int c = mesh.cells - 1; c >= 0; --c) {
      for (int a = 0; a < mesh.nodes_per_cell; ++a) lowest[mesh.cell_nodes[c * mesh.nodes_per_cell + a]] = c;
    }
    int wrong = 0;
    for (int c = 0; c < mesh.cells; ++c) {
      for (int a = 0; a < mesh.nodes_per_cell; ++a) {
        const int k = c * mesh.nodes_per_cell + a;
        const Vec3 x = vec3(&mesh.cell_coordinates[3 * k]);
        for (const int hint : {-1, c, (7 * c + 3) % mesh.cells}) {
          const Place place = locator.find(x, hint);
          wrong += !place.inside() || place.cell != lowest[mesh.cell_nodes[k]];
        }
      }
      for (int f = 0; f < mesh.facets_per_cell; ++f) {
        const int neighbour = mesh.cell_neighbours[c * mesh.facets_per_cell + f];
        if (neighbour < 0) continue;
        Vec3 x = Vec3::Zero();
        for (int k = 0; k < facet_nodes(mesh.cell); ++k) {
          x += vec3(&mesh.cell_coordinates[3 * (c * mesh.nodes_per_cell + facet_node_list(mesh.cell, f)[k])]) /
               facet_nodes(mesh.cell);
        }
        for (const int hint : {-1, c, neighbour}) wrong += locator.find(x, hint).cell != std::min(c, neighbour);
      }
    }
    INFO(cell);
    CHECK(wrong == 0);
  }
}

TEST_CASE("every point of the domain is claimed by exactly one rank, ties included", "[mpi][locator]") {
  for (const auto& [cell, cells] : kinds) {
    Mesh mesh(box(cell, cells));
    const Locator locator(mesh);
    std::vector<Vec3> points;
    std::mt19937 random(3);
    std::uniform_int_distribution<int> lattice(0, 60);
    for (int k = 0; k < 3000; ++k) {
      Vec3 x = mesh.lower;
      for (int d = 0; d < mesh.dimension; ++d) x[d] += (mesh.upper[d] - mesh.lower[d]) * lattice(random) / 60.0;
      points.push_back(x);
    }
    const auto places = locator.claim(points);
    std::vector<double> holders(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) holders[k] = places[k].inside();
    MPI_Allreduce(MPI_IN_PLACE, holders.data(), static_cast<int>(holders.size()), MPI_DOUBLE, MPI_SUM,
                  PETSC_COMM_WORLD);
    int wrong = 0;
    for (const double h : holders) wrong += h != 1;
    INFO(cell);
    CHECK(wrong == 0);
    // What settle() says to the rank that asks is the same holder.
    const auto settled = locator.settle(points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      wrong += settled[k].inside() != places[k].inside();
      wrong += !settled[k].inside() && settled[k].state != Place::State::remote;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("the middle of a cell is well inside it, its corners and other cells are not", "[locator]") {
  for (const auto& [cell, cells] : kinds) {
    Mesh mesh(box(cell, cells));
    const Locator locator(mesh);
    const int corners = cell_nodes(mesh.cell);
    std::vector<Vec3> middle(mesh.cells, Vec3::Zero()), corner(mesh.cells);
    std::vector<int> own(mesh.cells), other(mesh.cells);
    for (int c = 0; c < mesh.cells; ++c) {
      const double* x = &mesh.cell_coordinates[3 * static_cast<std::size_t>(corners) * c];
      for (int a = 0; a < corners; ++a) middle[c] += vec3(x + 3 * a) / corners;
      corner[c] = vec3(x);
      own[c] = c;
      other[c] = (c + 1) % mesh.cells;
    }
    const auto inside = [&](const std::vector<Vec3>& points, const std::vector<int>& in) {
      std::vector<unsigned char> is(mesh.cells);
      locator.well_inside(points[0].data(), 3, in.data(), mesh.cells, is.data());
      return std::count(is.begin(), is.end(), 1);
    };
    CHECK(inside(middle, own) == mesh.cells);
    CHECK(inside(middle, other) == 0);
    CHECK(inside(corner, own) == 0);
    CHECK(inside(corner, other) == 0);
  }
}

TEST_CASE("a point that leaves is reported with the boundary it left through", "[mpi][locator]") {
  for (const auto& [cell, cells] : kinds) {
    Mesh mesh(box(cell, cells));
    const Locator locator(mesh);
    std::vector<Vec3> points;
    std::vector<std::string> expected;
    const std::vector<std::string> names = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
    const Vec3 centre = 0.5 * (mesh.lower + mesh.upper);
    for (int side = 0; side < 2 * mesh.dimension; ++side) {
      const int d = side / 2;
      Vec3 x = centre;
      x[d] = side % 2 ? mesh.upper[d] + 0.01 : mesh.lower[d] - 0.01;
      points.push_back(x);
      expected.push_back(names[side]);
    }
    const auto places = locator.settle(points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      REQUIRE(places[k].state == Place::State::boundary);
      CHECK(mesh.boundaries[places[k].boundary] == expected[k]);
    }
    // Seen from the cell it left.
    for (const auto& facet : mesh.facets) {
      Vec3 x = Vec3::Zero(), inner = Vec3::Zero();
      for (int k = 0; k < facet_nodes(mesh.cell); ++k) x += mesh.facet_corners(facet)[k] / facet_nodes(mesh.cell);
      for (int a = 0; a < mesh.nodes_per_cell; ++a) {
        inner += vec3(&mesh.cell_coordinates[3 * (facet.cell * mesh.nodes_per_cell + a)]) / mesh.nodes_per_cell;
      }
      const Place place = locator.find(Vec3(x + 0.05 * (x - inner)), facet.cell);
      REQUIRE(place.state == Place::State::boundary);
      REQUIRE(place.boundary == facet.boundary);
    }
  }
}

TEST_CASE("on a periodic mesh a point that crosses the edge is wrapped into the cell on the other side",
          "[mpi][locator]") {
  for (const auto& [cell, cells] : kinds) {
    if (cell == "triangle" || cell == "tetrahedron") continue;  // periodic boxes are tensor cells
    const bool plane = cells.size() == 2;
    Mesh mesh(box(cell, cells, plane ? std::vector<int>{1, 1} : std::vector<int>{1, 0, 1}));
    bend(mesh);
    const Locator locator(mesh);
    Sampler sample;
    int wrong = 0;
    for (int k = 0; k < (mesh.cells ? 1000 : 0); ++k) {
      const int home = sample.cell(mesh);
      const auto xi = sample.reference(mesh.cell);
      const Vec3 x = place_of(mesh, home, xi);
      for (int p = -1; p <= 1; ++p) {
        const int last = plane ? 1 : 2;
        Vec3 image = x;
        image[0] += p * locator.period()[0];
        image[last] -= p * locator.period()[last];
        for (const int hint : {-1, home, sample.cell(mesh)}) {
          const Place place = locator.find(image, hint);
          wrong += !place.inside() || place.cell != home || place.wrap[0] != -p || place.wrap[last] != p;
          wrong += (locator.wrapped(image, place) - x).norm() > 1e-12;
        }
      }
    }
    // A step over the periodic edge, taken from the cell before it.
    const Vec3 step(0.4 * (mesh.upper[0] - mesh.lower[0]) / cells[0], 0, 0);
    for (int c = 0; c < mesh.cells; ++c) {
      const Vec3 x = place_of(mesh, c, {0.9, 0.5, plane ? 0 : 0.5}) + step;
      const Place place = locator.find(x, c);
      wrong += place.state == Place::State::missing || place.state == Place::State::boundary;
      wrong += place.wrap[0] != (x[0] > mesh.upper[0] ? -1 : 0);
    }
    INFO(cell);
    CHECK(wrong == 0);
  }
}

TEST_CASE("points that wander over the ranks are never lost nor held twice", "[mpi][locator]") {
  for (const auto& [cell, cells] : kinds) {
    Mesh mesh(box(cell, cells));
    const Locator locator(mesh);
    std::mt19937 random(11);  // the same on every rank: everyone knows where everyone's points are
    std::uniform_real_distribution<double> unit(0, 1);
    constexpr int count = 200;
    std::vector<Vec3> x(count);
    for (auto& point : x) {
      for (int d = 0; d < 3; ++d) point[d] = mesh.lower[d] + unit(random) * (mesh.upper[d] - mesh.lower[d]);
    }
    std::vector<int> home(count, -1);
    auto claimed = locator.claim(x);
    for (int k = 0; k < count; ++k) {
      if (claimed[k].inside()) home[k] = claimed[k].cell;
    }
    int wrong = 0;
    for (int step = 0; step < 30; ++step) {
      std::vector<int> send(count, -1);
      std::vector<Vec3> unsettled;
      std::vector<int> unsettled_index;
      for (int k = 0; k < count; ++k) {
        for (int d = 0; d < mesh.dimension; ++d) {
          x[k][d] = std::clamp(x[k][d] + 0.1 * (unit(random) - 0.5), mesh.lower[d], mesh.upper[d]);
        }
        if (home[k] < 0) continue;
        const Place place = locator.find(x[k], home[k]);
        home[k] = place.inside() ? place.cell : -1;
        if (place.state == Place::State::remote) send[k] = place.rank;
        if (place.state == Place::State::missing || place.state == Place::State::boundary) {
          unsettled.push_back(x[k]);
          unsettled_index.push_back(k);
        }
      }
      MPI_Allreduce(MPI_IN_PLACE, send.data(), count, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
      for (int k = 0; k < count; ++k) {
        if (send[k] != mpi_rank()) continue;
        const Place place = locator.find(x[k]);
        if (place.inside()) {
          home[k] = place.cell;
        } else {
          unsettled.push_back(x[k]);
          unsettled_index.push_back(k);
        }
      }
      std::fill(send.begin(), send.end(), -1);
      const auto settled = locator.settle(unsettled);
      for (std::size_t k = 0; k < settled.size(); ++k) {
        wrong += settled[k].state == Place::State::boundary;
        if (settled[k].inside()) home[unsettled_index[k]] = settled[k].cell;
        if (settled[k].state == Place::State::remote) send[unsettled_index[k]] = settled[k].rank;
      }
      MPI_Allreduce(MPI_IN_PLACE, send.data(), count, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
      for (int k = 0; k < count; ++k) {
        if (send[k] == mpi_rank()) home[k] = locator.find(x[k]).cell;
      }
      std::vector<int> holders(count);
      for (int k = 0; k < count; ++k) holders[k] = home[k] >= 0;
      MPI_Allreduce(MPI_IN_PLACE, holders.data(), count, MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
      for (const int h : holders) wrong += h != 1;
    }
    INFO(cell);
    CHECK(wrong == 0);
  }
}

TEST_CASE("points on the sides of a periodic box have one holder, from wherever they come", "[mpi][locator]") {
  for (const auto& cells : std::vector<std::vector<int>>{{3, 3}, {5, 4}, {3, 3, 3}, {5, 4, 3}}) {
    const int dimension = static_cast<int>(cells.size());
    Mesh mesh(box(dimension == 2 ? "quadrilateral" : "hexahedron", cells, std::vector<int>(dimension, 1)));
    const Locator locator(mesh);
    std::vector<Vec3> points;  // a lattice over the box and its images, every side, edge and corner among them
    const int last = dimension == 2 ? 1 : 9;
    for (int k = 0; k < last; ++k)
      for (int j = 0; j < 9; ++j)
        for (int i = 0; i < 9; ++i) {
          Vec3 x(i, j, k);
          for (int d = 0; d < dimension; ++d)
            x[d] = mesh.lower[d] + (mesh.upper[d] - mesh.lower[d]) * (x[d] - 2) / 4 * (1 + 1e-16 * (i - 4));
          x[2] = dimension == 2 ? 0 : x[2];
          points.push_back(x);
        }
    const int count = static_cast<int>(points.size());
    const auto claimed = locator.claim(points);
    std::vector<int> holders(count);
    int wrong = 0;
    for (int k = 0; k < count; ++k) holders[k] = claimed[k].inside();
    MPI_Allreduce(MPI_IN_PLACE, holders.data(), count, MPI_INT, MPI_SUM, PETSC_COMM_WORLD);
    for (const int h : holders) wrong += h != 1;

    // Whoever has the point in a cell of its own, or looks for it anew, names a rank that holds it.
    for (int k = 0; k < count; ++k) {
      const Place here = locator.held(points[k]);
      const int held = here.inside() ? mpi_rank() : 1 << 20;
      for (const int hint : {-1, here.cell}) {
        const Place place = locator.find(points[k], hint);
        unsigned char well = 0;
        locator.well_inside(points[k].data(), 3, &hint, 1, &well);
        wrong += well && !(place.inside() && place.cell == hint && place.wrap == std::array<int, 3>{0, 0, 0});
        const int named = place.inside() ? mpi_rank() : place.state == Place::State::remote ? place.rank : -1;
        wrong += place.state == Place::State::boundary;
        std::vector<int> all(2 * static_cast<std::size_t>(mpi_size()));
        const int mine[2] = {named, held};
        MPI_Allgather(mine, 2, MPI_INT, all.data(), 2, MPI_INT, PETSC_COMM_WORLD);
        for (int r = 0; r < mpi_size(); ++r)
          if (all[2 * r] >= 0) wrong += all[2 * all[2 * r] + 1] != all[2 * r];
        if (place.inside()) {
          const Vec3 x = locator.wrapped(points[k], place);
          double xi[3];
          REQUIRE(locator.reference(place.cell, x.data(), xi));
          for (int d = 0; d < dimension; ++d) wrong += xi[d] < -1e-9 || xi[d] > 1 + 1e-9;
        }
      }
    }
    INFO(cells[0] << " x " << cells[1] << " cells");
    CHECK(wrong == 0);
  }
}

TEST_CASE("a rank without cells finds nothing and takes part in every collective search", "[mpi][locator]") {
  Mesh mesh(box("quadrilateral", {1, 1}));
  const Locator locator(mesh);
  const Vec3 x(0.5, 0.75, 0);
  const Place place = locator.find(x);
  CHECK(place.inside() == (mesh.cells > 0));
  const auto settled = locator.settle(std::vector<Vec3>{x, Vec3(3, 0.75, 0)});
  CHECK(settled[0].state == (mesh.cells > 0 ? Place::State::inside : Place::State::remote));
  CHECK(settled[1].state == Place::State::boundary);
  CHECK(mesh.boundaries[settled[1].boundary] == "x_max");
}
