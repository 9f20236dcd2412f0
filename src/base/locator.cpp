#include "base/locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace silt {
namespace {

constexpr double inside_tolerance = 1e-10;  ///< in reference coordinates
constexpr double tie_tolerance =
    1e-11;  ///< smaller, so that the cell across a touched facet surely holds the point too
constexpr int longest_walk = 100;

/// What each facet means in reference coordinates: the barycentric coordinate that vanishes there, or a side of the
/// unit square or cube.
template <Cell kind>
struct FacetTable {
  static constexpr bool simplex = kind == Cell::triangle || kind == Cell::tetrahedron;
  static constexpr int dimension = cell_dimension(kind), facets = cell_facets(kind), corners = silt::cell_nodes(kind);
  std::array<int, facets> axis{};  ///< simplices: the opposite node
  std::array<bool, facets> high{};

  FacetTable() {
    for (int f = 0; f < facets; ++f) {
      const auto& nodes = facet_node_list(kind, f);
      int all = ~0, none = ~0, sum = 0;
      for (int k = 0; k < facet_nodes(kind); ++k) {
        all &= nodes[k];
        none &= ~nodes[k];
        sum += nodes[k];
      }
      if constexpr (simplex) {
        axis[f] = dimension * (dimension + 1) / 2 - sum;
      } else {
        for (int d = 0; d < dimension; ++d) {
          if (all >> d & 1) axis[f] = d, high[f] = true;
          if (none >> d & 1) axis[f] = d, high[f] = false;
        }
      }
    }
  }
  /// Distance from facet f into the cell, in reference coordinates; negative outside.
  double depth(int f, const double* xi) const {
    if constexpr (simplex) {
      if (axis[f] > 0) return xi[axis[f] - 1];
      double rest = 1;
      for (int d = 0; d < dimension; ++d) rest -= xi[d];
      return rest;
    } else {
      return high[f] ? 1 - xi[axis[f]] : xi[axis[f]];
    }
  }
};

template <Cell kind>
const FacetTable<kind>& facet_table() {
  static const FacetTable<kind> table;
  return table;
}

template <Cell kind>
double least_depth(const double* xi) {
  const auto& table = facet_table<kind>();
  double least = table.depth(0, xi);
  for (int f = 1; f < cell_facets(kind); ++f) least = std::min(least, table.depth(f, xi));
  return least;
}

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double along = std::clamp((x - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (x - a - along * edge).norm();
}

double distance_to_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a);
  const bool above = (b - a).cross(x - a).dot(normal) >= 0 && (c - b).cross(x - b).dot(normal) >= 0 &&
                     (a - c).cross(x - c).dot(normal) >= 0;
  if (above) return std::abs((x - a).dot(normal)) / normal.norm();
  return std::min({distance_to_segment(x, a, b), distance_to_segment(x, b, c), distance_to_segment(x, c, a)});
}

double distance_to_facet(const Mesh& mesh, const BoundaryFacet& facet, const Vec3& x) {
  const auto corner = mesh.facet_corners(facet);
  if (mesh.dimension == 2) return distance_to_segment(Vec3(x[0], x[1], 0), corner[0], corner[1]);
  double distance = distance_to_triangle(x, corner[0], corner[1], corner[2]);
  if (facet_nodes(mesh.cell) == 4)
    distance = std::min(distance, distance_to_triangle(x, corner[0], corner[2], corner[3]));
  return distance;
}

}  // namespace

Locator::Locator(const Mesh& mesh) : mesh_(mesh) {
  for (int d = 0; d < mesh.dimension; ++d) {
    if (!mesh.periodic[d]) continue;
    period_[d] = mesh.upper[d] - mesh.lower[d];
    periodic_ = true;
  }
  switch (mesh.cell) {
    case Cell::triangle:
      build_maps<Cell::triangle>();
      break;
    case Cell::quadrilateral:
      build_maps<Cell::quadrilateral>();
      break;
    case Cell::tetrahedron:
      build_maps<Cell::tetrahedron>();
      break;
    case Cell::hexahedron:
      build_maps<Cell::hexahedron>();
      break;
  }
  build_bins();
  if (periodic_) build_wraps();
}

template <Cell kind>
void Locator::build_maps() {
  constexpr int corners = silt::cell_nodes(kind), dimension = cell_dimension(kind);
  constexpr bool simplex = FacetTable<kind>::simplex;
  maps_.resize(mesh_.cells);
  affine_.resize(mesh_.cells);
  boxes_.resize(6 * static_cast<std::size_t>(mesh_.cells));
  const double middle[3] = {0.5, 0.5, dimension == 3 ? 0.5 : 0.0}, corner[3] = {0, 0, 0};
  double N[corners], dN[corners][3];
  shape(kind, simplex ? corner : middle, N, dN);
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* X = &mesh_.cell_coordinates[3 * static_cast<std::size_t>(corners) * c];
    Mat3 jacobian = Mat3::Zero();
    Vec3 at = Vec3::Zero();
    double* box = &boxes_[6 * static_cast<std::size_t>(c)];
    std::copy(X, X + 3, box);
    std::copy(X, X + 3, box + 3);
    for (int a = 0; a < corners; ++a) {
      at += N[a] * vec3(X + 3 * a);
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < dimension; ++j) jacobian(i, j) += X[3 * a + i] * dN[a][j];
        box[i] = std::min(box[i], X[3 * a + i]);
        box[3 + i] = std::max(box[3 + i], X[3 * a + i]);
      }
    }
    if (dimension == 2) jacobian(2, 2) = 1;
    const Vec3 origin = at - jacobian * (simplex ? vec3(corner) : vec3(middle));
    Mat3 inverse = jacobian.inverse();
    if (dimension == 2) inverse.row(2).setZero();
    InverseMap& map = maps_[c];
    double size = 0;
    for (int i = 0; i < 3; ++i) {
      map.origin[i] = origin[i];
      size = std::max(size, box[3 + i] - box[i]);
      for (int j = 0; j < 3; ++j) map.inverse[i][j] = inverse(i, j);
    }
    bool affine = true;
    if constexpr (!simplex) {
      for (int a = 0; a < corners; ++a) {
        const Vec3 xi(a & 1, a >> 1 & 1, a >> 2);
        affine = affine && (inverse * (vec3(X + 3 * a) - origin) - xi).cwiseAbs().maxCoeff() < tie_tolerance;
      }
    }
    affine_[c] = affine;
    for (int i = 0; i < 3; ++i) {
      box[i] -= 1e-9 * size;
      box[3 + i] += 1e-9 * size;
    }
  }
}

void Locator::build_bins() {
  if (mesh_.cells == 0) return;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
  for (int c = 0; c < mesh_.cells; ++c) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], boxes_[6 * c + i]);
      high[i] = std::max(high[i], boxes_[6 * c + 3 + i]);
    }
  }
  double space = 1;
  for (int i = 0; i < mesh_.dimension; ++i) space *= high[i] - low[i];
  const double size = std::pow(space / mesh_.cells, 1.0 / mesh_.dimension);
  for (int i = 0; i < 3; ++i) {
    const double width = high[i] - low[i];
    bins_[i] = i < mesh_.dimension ? std::max(1, static_cast<int>(width / size)) : 1;
    bin_lower_[i] = low[i];
    bin_inverse_[i] = i < mesh_.dimension ? bins_[i] / width : 0;
  }
  const auto each_bin = [&](int c, auto&& visit) {
    int first[3], last[3];
    for (int i = 0; i < 3; ++i) {
      first[i] = std::clamp(static_cast<int>((boxes_[6 * c + i] - bin_lower_[i]) * bin_inverse_[i]), 0, bins_[i] - 1);
      last[i] =
          std::clamp(static_cast<int>((boxes_[6 * c + 3 + i] - bin_lower_[i]) * bin_inverse_[i]), 0, bins_[i] - 1);
    }
    for (int k = first[2]; k <= last[2]; ++k) {
      for (int j = first[1]; j <= last[1]; ++j) {
        for (int i = first[0]; i <= last[0]; ++i) visit((k * bins_[1] + j) * bins_[0] + i);
      }
    }
  };
  bin_start_.assign(static_cast<std::size_t>(bins_[0]) * bins_[1] * bins_[2] + 1, 0);
  for (int c = 0; c < mesh_.cells; ++c) each_bin(c, [&](int bin) { ++bin_start_[bin + 1]; });
  for (std::size_t b = 1; b < bin_start_.size(); ++b) bin_start_[b] += bin_start_[b - 1];
  bin_cells_.resize(bin_start_.back());
  std::vector<int> next(bin_start_.begin(), bin_start_.end() - 1);
  for (int c = 0; c < mesh_.cells; ++c) each_bin(c, [&](int bin) { bin_cells_[next[bin]++] = c; });
}

void Locator::build_wraps() {
  facet_wraps_.assign(static_cast<std::size_t>(mesh_.cells) * mesh_.facets_per_cell, 0);
  const int corners = facet_nodes(mesh_.cell);
  for (int c = 0; c < mesh_.cells; ++c) {
    for (int f = 0; f < mesh_.facets_per_cell; ++f) {
      const auto& nodes = facet_node_list(mesh_.cell, f);
      for (int d = 0; d < mesh_.dimension; ++d) {
        if (!mesh_.periodic[d]) continue;
        bool low = true, high = true;
        for (int k = 0; k < corners; ++k) {
          const double x =
              mesh_.cell_coordinates[3 * (static_cast<std::size_t>(c) * mesh_.nodes_per_cell + nodes[k]) + d];
          low = low && std::abs(x - mesh_.lower[d]) < 1e-6 * mesh_.smallest_edge;
          high = high && std::abs(x - mesh_.upper[d]) < 1e-6 * mesh_.smallest_edge;
        }
        signed char& wrap = facet_wraps_[static_cast<std::size_t>(c) * mesh_.facets_per_cell + f];
        if (low) wrap = static_cast<signed char>(d + 1);
        if (high) wrap = static_cast<signed char>(-(d + 1));
      }
    }
  }
}

void Locator::to_box(double* x, std::array<int, 3>& wrap) const {
  // The tolerance keeps a point that ties with the periodic image of a cell where its finder put it.
  const double slack = 0.5 * inside_tolerance * mesh_.smallest_edge;
  for (int d = 0; d < 3; ++d) {
    if (period_[d] == 0) continue;
    if (x[d] >= mesh_.lower[d] - slack && x[d] <= mesh_.upper[d] + slack) continue;
    const int periods = -static_cast<int>(std::floor((x[d] - mesh_.lower[d]) / period_[d]));
    x[d] += periods * period_[d];
    wrap[d] += periods;
  }
}

template <Cell kind>
bool Locator::invert(int cell, const double* x, double* xi) const {
  constexpr int corners = silt::cell_nodes(kind), dimension = cell_dimension(kind);
  const InverseMap& map = maps_[cell];
  const double r[3] = {x[0] - map.origin[0], x[1] - map.origin[1], dimension == 3 ? x[2] - map.origin[2] : 0.0};
  xi[2] = 0;
  for (int i = 0; i < dimension; ++i) {
    xi[i] = map.inverse[i][0] * r[0] + map.inverse[i][1] * r[1] + map.inverse[i][2] * r[2];
  }
  if constexpr (FacetTable<kind>::simplex) {
    return true;
  } else {
    if (affine_[cell]) return true;
    for (int i = 0; i < dimension; ++i) {
      if (std::abs(xi[i] - 0.5) > 2.5) return false;  // far outside the tangent map only tells the direction
    }
    double at[3] = {xi[0], xi[1], xi[2]};
    const double* X = &mesh_.cell_coordinates[3 * static_cast<std::size_t>(corners) * cell];
    double N[corners], dN[corners][3];
    bool last = false;
    for (int iteration = 0; iteration < 30; ++iteration) {
      shape(kind, at, N, dN);
      Mat3 jacobian = Mat3::Zero();
      Vec3 residual(x[0], x[1], dimension == 3 ? x[2] : 0.0);
      for (int a = 0; a < corners; ++a) {
        for (int i = 0; i < dimension; ++i) {
          residual[i] -= N[a] * X[3 * a + i];
          for (int j = 0; j < dimension; ++j) jacobian(i, j) += X[3 * a + i] * dN[a][j];
        }
      }
      if (dimension == 2) jacobian(2, 2) = 1, residual[2] = 0;
      const Vec3 step = jacobian.inverse() * residual;
      if (!step.allFinite()) return false;
      for (int i = 0; i < dimension; ++i) at[i] = std::clamp(at[i] + step[i], -2.0, 3.0);
      if (last) {
        std::copy(at, at + 3, xi);
        return true;
      }
      last = step.cwiseAbs().maxCoeff() < 1e-7;  // quadratic: the next iterate is exact to round-off
    }
    return false;
  }
}

template <Cell kind>
Place Locator::lowest_around(const double* x, const Place& place) const {
  const auto& table = facet_table<kind>();
  constexpr int most = 64;
  Place found[most];
  int count = 1;
  found[0] = place;
  int rank = mpi_rank(), lowest = 0;
  const int own = rank;
  Place remote;
  for (int k = 0; k < count; ++k) {
    Place& at = found[k];
    double moved[3];
    for (int d = 0; d < 3; ++d) moved[d] = x[d] + (at.wrap[d] - place.wrap[d]) * period_[d];
    if (!invert<kind>(at.cell, moved, at.xi.data()) || least_depth<kind>(at.xi.data()) < -inside_tolerance) continue;
    at.state = Place::State::inside;
    if (at.cell < found[lowest].cell) lowest = k;
    for (int f = 0; f < cell_facets(kind); ++f) {
      if (std::abs(table.depth(f, at.xi.data())) > tie_tolerance) continue;
      const std::size_t place_of_facet = static_cast<std::size_t>(at.cell) * cell_facets(kind) + f;
      const int neighbour = mesh_.cell_neighbours[place_of_facet];
      Place next;
      next.wrap = at.wrap;
      if (periodic_ && facet_wraps_[place_of_facet] != 0) {
        const int code = facet_wraps_[place_of_facet];
        next.wrap[std::abs(code) - 1] += code > 0 ? 1 : -1;
      }
      if (neighbour == Mesh::remote_cell) {
        if (mesh_.facet_ranks[place_of_facet] < rank) {
          rank = mesh_.facet_ranks[place_of_facet];
          next.state = Place::State::remote;
          next.rank = rank;
          remote = next;
        }
      } else if (neighbour >= 0 && count < most) {
        bool seen = false;
        for (int i = 0; i < count; ++i) seen = seen || found[i].cell == neighbour;
        if (seen) continue;
        next.cell = neighbour;
        found[count++] = next;
      }
    }
  }
  return rank < own ? remote : found[lowest];
}

template <Cell kind>
Place Locator::search(const double* point) const {
  Place place;
  if (mesh_.cells == 0) return place;
  double x[3] = {point[0], point[1], point[2]};
  if (periodic_) to_box(x, place.wrap);
  int index[3] = {0, 0, 0};
  for (int d = 0; d < mesh_.dimension; ++d) {
    const double along = (x[d] - bin_lower_[d]) * bin_inverse_[d];
    if (!(along >= 0 && along <= bins_[d])) return place;
    index[d] = std::min(static_cast<int>(along), bins_[d] - 1);
  }
  const int bin = (index[2] * bins_[1] + index[1]) * bins_[0] + index[0];
  for (int k = bin_start_[bin]; k < bin_start_[bin + 1]; ++k) {
    const int c = bin_cells_[k];
    const double* box = &boxes_[6 * static_cast<std::size_t>(c)];
    bool near = true;
    for (int d = 0; d < cell_dimension(kind); ++d) near = near && x[d] >= box[d] && x[d] <= box[3 + d];
    if (near && invert<kind>(c, x, place.xi.data()) && least_depth<kind>(place.xi.data()) >= -inside_tolerance) {
      place.state = Place::State::inside;
      place.cell = c;
      return place;
    }
  }
  return place;
}

template <Cell kind>
Place Locator::walk(const double* point, int hint) const {
  const auto& table = facet_table<kind>();
  constexpr int facets = cell_facets(kind);
  Place place;
  double x[3] = {point[0], point[1], point[2]};
  if (periodic_) {
    for (int d = 0; d < 3; ++d) {
      if (period_[d] == 0) continue;
      const double ahead = x[d] - maps_[hint].origin[d];
      const int periods = std::abs(ahead) > 0.5 * period_[d] ? -static_cast<int>(std::lround(ahead / period_[d])) : 0;
      x[d] += periods * period_[d];
      place.wrap[d] += periods;
    }
  }
  Place out;  // the way out of this rank at the dead end
  int cell = hint, previous = -1;
  for (int steps = 0; steps < longest_walk; ++steps) {
    const bool inverted = invert<kind>(cell, x, place.xi.data());
    double depth[facets], least = 1;
    for (int f = 0; f < facets; ++f) {
      depth[f] = table.depth(f, place.xi.data());
      least = std::min(least, depth[f]);
    }
    if (inverted && least >= -inside_tolerance) {
      place.state = Place::State::inside;
      place.cell = cell;
      if (least <= tie_tolerance) return lowest_around<kind>(x, place);
      return place;
    }
    int best = -1, best_remote = -1, best_boundary = -1;
    const std::size_t first = static_cast<std::size_t>(cell) * facets;
    for (int f = 0; f < facets; ++f) {
      if (depth[f] >= 0) continue;
      const int neighbour = mesh_.cell_neighbours[first + f];
      int& candidate = neighbour >= 0 ? best : neighbour == Mesh::remote_cell ? best_remote : best_boundary;
      if (neighbour >= 0 && neighbour == previous) continue;
      if (candidate < 0 || depth[f] < depth[candidate]) candidate = f;
    }
    const int facet = best >= 0 ? best : best_remote >= 0 ? best_remote : best_boundary;
    if (facet < 0) break;
    const int neighbour = mesh_.cell_neighbours[first + facet];
    if (periodic_ && facet_wraps_[first + facet] != 0) {
      const int code = facet_wraps_[first + facet], d = std::abs(code) - 1;
      x[d] += (code > 0 ? 1 : -1) * period_[d];
      place.wrap[d] += code > 0 ? 1 : -1;
    }
    if (neighbour < 0) {
      out = place;
      out.cell = -1;
      if (neighbour == Mesh::remote_cell) {
        out.state = Place::State::remote;
        out.rank = mesh_.facet_ranks[first + facet];
      } else {
        out.state = Place::State::boundary;
        out.boundary = -1 - neighbour;
      }
      break;
    }
    previous = cell;
    cell = neighbour;
  }
  Place found = search<kind>(point);
  if (!found.inside()) return out;
  double moved[3];
  for (int d = 0; d < 3; ++d) moved[d] = point[d] + found.wrap[d] * period_[d];
  return least_depth<kind>(found.xi.data()) <= tie_tolerance ? lowest_around<kind>(moved, found) : found;
}

template <Cell kind>
Place Locator::find_kind(const double* x, int hint) const {
  if (mesh_.cells == 0) return {};
  if (hint >= 0) return walk<kind>(x, hint);
  Place found = search<kind>(x);
  if (!found.inside() || least_depth<kind>(found.xi.data()) > tie_tolerance) return found;
  double moved[3];
  for (int d = 0; d < 3; ++d) moved[d] = x[d] + found.wrap[d] * period_[d];
  return lowest_around<kind>(moved, found);
}

Place Locator::find(const double* x, int hint) const {
  switch (mesh_.cell) {
    case Cell::triangle:
      return find_kind<Cell::triangle>(x, hint);
    case Cell::quadrilateral:
      return find_kind<Cell::quadrilateral>(x, hint);
    case Cell::tetrahedron:
      return find_kind<Cell::tetrahedron>(x, hint);
    case Cell::hexahedron:
      return find_kind<Cell::hexahedron>(x, hint);
  }
  return {};
}

std::vector<Place> Locator::find(std::span<const Vec3> points, std::span<const int> hints) const {
  std::vector<Place> places(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) places[k] = find(points[k], hints.empty() ? -1 : hints[k]);
  return places;
}

bool Locator::reference(int cell, const double* x, double* xi) const {
  switch (mesh_.cell) {
    case Cell::triangle:
      return invert<Cell::triangle>(cell, x, xi);
    case Cell::quadrilateral:
      return invert<Cell::quadrilateral>(cell, x, xi);
    case Cell::tetrahedron:
      return invert<Cell::tetrahedron>(cell, x, xi);
    case Cell::hexahedron:
      return invert<Cell::hexahedron>(cell, x, xi);
  }
  return false;
}

std::vector<Place> Locator::claim(std::span<const Vec3> points) const {
  const int own = mpi_rank(), nobody = std::numeric_limits<int>::max();
  std::vector<Place> places(points.size());
  std::vector<int> rank(points.size(), nobody);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double* x = points[k].data();
    switch (mesh_.cell) {
      case Cell::triangle:
        places[k] = search<Cell::triangle>(x);
        break;
      case Cell::quadrilateral:
        places[k] = search<Cell::quadrilateral>(x);
        break;
      case Cell::tetrahedron:
        places[k] = search<Cell::tetrahedron>(x);
        break;
      case Cell::hexahedron:
        places[k] = search<Cell::hexahedron>(x);
        break;
    }
    if (places[k].inside()) rank[k] = own;
  }
  MPI_Allreduce(MPI_IN_PLACE, rank.data(), static_cast<int>(rank.size()), MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (rank[k] == own) continue;
    const std::array<int, 3> wrap = places[k].wrap;
    places[k] = Place{};
    places[k].wrap = wrap;
    if (rank[k] != nobody) places[k].rank = rank[k];
  }
  return places;
}

std::vector<Place> Locator::settle(std::span<const Vec3> points) const {
  const int size = mpi_size(), own = mpi_rank();
  std::vector<int> counts(size), starts(size + 1, 0);
  const int mine = 3 * static_cast<int>(points.size());
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (int r = 0; r < size; ++r) starts[r + 1] = starts[r] + counts[r];
  if (starts[size] == 0) return {};
  std::vector<Vec3> everyone(starts[size] / 3);
  std::vector<double> own_points(mine);
  for (std::size_t k = 0; k < points.size(); ++k) vec3(&own_points[3 * k]) = points[k];
  MPI_Allgatherv(own_points.data(), mine, MPI_DOUBLE, everyone.data()->data(), counts.data(), starts.data(), MPI_DOUBLE,
                 PETSC_COMM_WORLD);
  std::vector<Place> places = claim(everyone);

  // Points that nobody holds have left the domain: through the boundary nearest to them.
  struct Nearest {
    double distance;
    int boundary;
  };
  std::vector<Nearest> nearest(everyone.size(), {std::numeric_limits<double>::max(), -1});
  for (std::size_t k = 0; k < everyone.size(); ++k) {
    if (places[k].inside() || places[k].rank >= 0) continue;
    Vec3 x = everyone[k];
    std::array<int, 3> wrap{0, 0, 0};
    to_box(x.data(), wrap);
    for (const auto& facet : mesh_.facets) {
      const double distance = distance_to_facet(mesh_, facet, x);
      if (distance < nearest[k].distance) nearest[k] = {distance, facet.boundary};
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, nearest.data(), static_cast<int>(nearest.size()), MPI_DOUBLE_INT, MPI_MINLOC,
                PETSC_COMM_WORLD);
  std::vector<Place> result(points.size());
  for (std::size_t k = 0; k < everyone.size(); ++k) {
    Place& place = places[k];
    // A rank that holds the point says so itself; the others learn it from claim().
    if (!place.inside() && place.rank >= 0) place.state = Place::State::remote;
    if (place.state == Place::State::missing) {
      if (nearest[k].boundary < 0)
        throw RunError("a point lies in no cell and the mesh has no boundary to have left through");
      place.state = Place::State::boundary;
      place.boundary = nearest[k].boundary;
    }
    const std::size_t first = starts[own] / 3;
    if (k >= first && k < first + points.size()) result[k - first] = place;
  }
  return result;
}

}  // namespace silt
