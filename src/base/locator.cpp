#include "base/locator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/facet_table.hpp"

namespace silt {
namespace {

constexpr int longest_walk = 100;

}  // namespace

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
void Locator::search_bin(const double* x, Place& place) const {
  int index[3] = {0, 0, 0};
  for (int d = 0; d < mesh_.dimension; ++d) {
    const double along = (x[d] - bin_lower_[d]) * bin_inverse_[d];
    if (!(along >= 0 && along <= bins_[d])) return;
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
      return;
    }
  }
}

template <Cell kind>
Place Locator::search(const double* point) const {
  Place place;
  if (mesh_.cells == 0) return place;
  double x[3] = {point[0], point[1], point[2]};
  if (periodic_) to_box(x, place.wrap);
  search_bin<kind>(x, place);
  if (!periodic_ || place.inside()) return place;
  // A point on a periodic side ties with its image on the other one, which may be all that this rank has of it.
  int sides[3] = {0, 0, 0};
  for (int d = 0; d < mesh_.dimension; ++d) {
    const double near = inside_tolerance * period_[d];
    if (x[d] <= mesh_.lower[d] + near) sides[d] = 1;
    if (x[d] >= mesh_.upper[d] - near) sides[d] = -1;
    if (period_[d] == 0) sides[d] = 0;
  }
  const std::array<int, 3> wrap = place.wrap;
  for (int image = 1; image < 8 && !place.inside(); ++image) {
    bool there = true;
    double moved[3];
    for (int d = 0; d < 3; ++d) {
      const bool shifted = image >> d & 1;
      there = there && (!shifted || sides[d] != 0);
      place.wrap[d] = wrap[d] + (shifted ? sides[d] : 0);
      moved[d] = x[d] + (shifted ? sides[d] * period_[d] : 0.0);
    }
    if (there) search_bin<kind>(moved, place);
  }
  if (!place.inside()) place.wrap = wrap;
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
  if (hint >= 0) {
    // Most points that move are still well inside their cell.
    Place place;
    if ((FacetTable<kind>::simplex || affine_[hint]) && invert<kind>(hint, x, place.xi.data()) &&
        least_depth<kind>(place.xi.data()) > tie_tolerance) {
      place.state = Place::State::inside;
      place.cell = hint;
      return place;
    }
    return walk<kind>(x, hint);
  }
  Place found = search<kind>(x);
  if (!found.inside() || least_depth<kind>(found.xi.data()) > tie_tolerance) return found;
  double moved[3];
  for (int d = 0; d < 3; ++d) moved[d] = x[d] + found.wrap[d] * period_[d];
  return lowest_around<kind>(moved, found);
}

template <Cell kind>
void Locator::well_inside_kind(const double* x, std::size_t stride, const int* cells, int count,
                               unsigned char* inside) const {
  for (int k = 0; k < count; ++k) {
    const int cell = cells[k];
    if (cell < 0 || !(FacetTable<kind>::simplex || affine_[cell])) {
      inside[k] = 0;
      continue;
    }
    constexpr int dimension = cell_dimension(kind);
    const InverseMap& map = maps_[cell];
    const double* at = x + k * stride;
    const double r[3] = {at[0] - map.origin[0], at[1] - map.origin[1], dimension == 3 ? at[2] - map.origin[2] : 0.0};
    double least = 1, sum = 0;
    for (int i = 0; i < dimension; ++i) {
      const double xi = map.inverse[i][0] * r[0] + map.inverse[i][1] * r[1] + map.inverse[i][2] * r[2];
      least = std::min(least, FacetTable<kind>::simplex ? xi : std::min(xi, 1 - xi));
      sum += xi;
    }
    inside[k] = (FacetTable<kind>::simplex ? std::min(least, 1 - sum) : least) > 2 * tie_tolerance;
  }
}

void Locator::well_inside(const double* x, std::size_t stride, const int* cells, int count,
                          unsigned char* inside) const {
  switch (mesh_.cell) {
    case Cell::triangle:
      return well_inside_kind<Cell::triangle>(x, stride, cells, count, inside);
    case Cell::quadrilateral:
      return well_inside_kind<Cell::quadrilateral>(x, stride, cells, count, inside);
    case Cell::tetrahedron:
      return well_inside_kind<Cell::tetrahedron>(x, stride, cells, count, inside);
    case Cell::hexahedron:
      return well_inside_kind<Cell::hexahedron>(x, stride, cells, count, inside);
  }
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

Place Locator::held(const Vec3& x) const {
  switch (mesh_.cell) {
    case Cell::triangle:
      return search<Cell::triangle>(x.data());
    case Cell::quadrilateral:
      return search<Cell::quadrilateral>(x.data());
    case Cell::tetrahedron:
      return search<Cell::tetrahedron>(x.data());
    case Cell::hexahedron:
      return search<Cell::hexahedron>(x.data());
  }
  return {};
}

std::vector<Place> Locator::claim(std::span<const Vec3> points) const {
  const int own = mpi_rank(), nobody = std::numeric_limits<int>::max();
  std::vector<Place> places(points.size());
  std::vector<int> rank(points.size(), nobody);
  for (std::size_t k = 0; k < points.size(); ++k) {
    places[k] = held(points[k]);
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

}  // namespace silt
