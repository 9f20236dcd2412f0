#include "particles/neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace silt {

CellGrid::CellGrid(const Vec3& lower, const Vec3& upper, const Vec3& origin, const Periods& periods, double reach,
                   int particles) {
  double extent[3];
  for (int d = 0; d < 3; ++d) {
    wraps_[d] = periods.length[d] > 0;
    lower_[d] = wraps_[d] ? origin[d] : lower[d];
    extent[d] = wraps_[d] ? periods.length[d] : std::max(upper[d] - lower[d], 0.0);
  }
  // Cells may be wider than the reach, never narrower; sparse domains must not cost memory.
  const double most = 4.0 * particles + 64;
  for (double width = reach;; width *= 1.25) {
    double total = 1;
    for (int d = 0; d < 3; ++d) {
      count_[d] = static_cast<int>(std::min(std::max(1.0, std::floor(extent[d] / width)), 1e6));
      total *= count_[d];
    }
    if (total <= most) break;
  }
  for (int d = 0; d < 3; ++d) {
    inverse_[d] = extent[d] > 0 ? count_[d] / extent[d] : 0;
    largest_ = std::max(largest_, extent[d]);
  }
}

int CellGrid::neighbours(int cell, Run* run) const {
  int at[3] = {cell % count_[0], cell / count_[0] % count_[1], cell / (count_[0] * count_[1])};
  int list[3][3], n[3];
  for (int d = 0; d < 3; ++d) {
    n[d] = 0;
    for (int s = -1; s <= 1; ++s) {
      int c = at[d] + s;
      if (wraps_[d])
        c = (c + count_[d]) % count_[d];
      else if (c < 0 || c >= count_[d])
        continue;
      int k = n[d];  // kept sorted, each once
      while (k > 0 && list[d][k - 1] > c) --k;
      if (k > 0 && list[d][k - 1] == c) continue;
      for (int m = n[d]; m > k; --m) list[d][m] = list[d][m - 1];
      list[d][k] = c;
      ++n[d];
    }
  }
  int runs = 0;
  for (int z = 0; z < n[2]; ++z)
    for (int y = 0; y < n[1]; ++y) {
      const int row = (list[2][z] * count_[1] + list[1][y]) * count_[0];
      for (int x = 0; x < n[0]; ++x) {
        const int c = row + list[0][x];
        if (x > 0 && run[runs - 1].last == c - 1)
          run[runs - 1].last = c;
        else
          run[runs++] = {c, c};
      }
    }
  return runs;
}

bool CellGrid::each_once() const {
  for (int d = 0; d < 3; ++d)
    if (wraps_[d] && count_[d] < 3) return false;
  return true;
}

int CellGrid::later_rows(int row, Row* rows) const {
  const int at[2] = {row % count_[1], row / count_[1]};
  int found = 0;
  rows[found++] = {row, {0, 0}};
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y) {
      Row beside{0, {0, 0}};
      int to[2] = {at[0] + y, at[1] + z};
      bool there = true;
      for (int d = 0; d < 2; ++d) {
        if (to[d] >= 0 && to[d] < count_[1 + d]) continue;
        there = there && wraps_[1 + d];
        beside.periods[d] = to[d] < 0 ? -1 : 1;
        to[d] -= beside.periods[d] * count_[1 + d];
      }
      beside.row = to[1] * count_[1] + to[0];
      if (there && beside.row > row) rows[found++] = beside;
    }
  return found;
}

CellOrder order_along(const CellGrid& grid, const Store& store) {
  CellOrder sorted;
  std::vector<int> cell(store.owned);
  std::vector<int>&start = sorted.start, &order = sorted.order;
  start.assign(grid.cells() + 1, 0);
  order.resize(store.owned);
  for (int p = 0; p < store.owned; ++p) {
    cell[p] = grid.cell_of(store.motion[p].position);
    ++start[cell[p] + 1];
    sorted.steps_back += p > 0 && cell[p] < cell[p - 1];
  }
  for (int c = 0; c < grid.cells(); ++c) start[c + 1] += start[c];
  // The starts serve as places to write at and are shifted back.
  for (int p = 0; p < store.owned; ++p) order[start[cell[p]]++] = p;
  for (int c = grid.cells(); c > 0; --c) start[c] = start[c - 1];
  start[0] = 0;
  return sorted;
}

Bins::Bins(CellOrder&& order, const Store& store, bool placed)
    : start(std::move(order.start)), particle(std::move(order.order)) {
  if (placed) place(store);
}

void Bins::place(const Store& store) {
  constexpr int widest = 8;  // pack
  const int n = store.owned;
  for (auto* values : {&x, &y, &z, &r}) {
    *values = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(n) + widest);
    std::fill_n(values->get() + n, widest, 0.0);
  }
  for (int k = 0; k < n; ++k) {
    const Motion& motion = store.motion[particle[k]];
    x[k] = motion.position[0], y[k] = motion.position[1], z[k] = motion.position[2], r[k] = motion.radius;
  }
}

namespace {

inline double image(double distance, double length, double inverse) {
  // Adding and taking away 1.5 * 2^52 rounds to the nearest whole number without a call.
  constexpr double shift = 6755399441055744.0;
  return distance - length * ((distance * inverse + shift) - shift);
}

}  // namespace

bool any_within(const CellGrid& grid, const Bins& bins, const Periods& periods, const double* x, double radius,
                double gap) {
  CellGrid::Run run[27];
  const int runs = grid.neighbours(grid.cell_of(x), run);
  for (int q = 0; q < runs; ++q)
    for (int k = bins.start[run[q].first]; k < bins.start[run[q].last + 1]; ++k) {
      const double dx = image(x[0] - bins.x[k], periods.length[0], periods.inverse[0]);
      const double dy = image(x[1] - bins.y[k], periods.length[1], periods.inverse[1]);
      const double dz = image(x[2] - bins.z[k], periods.length[2], periods.inverse[2]);
      const double cut = bins.r[k] + gap + radius;
      if (dx * dx + dy * dy + dz * dz < cut * cut) return true;
    }
  return false;
}

namespace {

/// What the search along rows reads of the spheres, sorted as the bins: coordinates from the corner of the grid in
/// single precision, and what is asked of those found.
struct RowColumns {
  std::unique_ptr<float[]> values;
  std::unique_ptr<int[]> column;
  std::unique_ptr<std::int64_t[]> id;
  float *x[3], *radius;
  double largest_radius = 0;

  RowColumns(const CellGrid& grid, const Bins& own, const Store& store) {
    constexpr int beyond = 8, ahead = 12;  // that may be read; that are fetched from memory
    const int n = store.owned, room = n + beyond;
    values = std::make_unique_for_overwrite<float[]>(4 * static_cast<std::size_t>(room));
    column = std::make_unique_for_overwrite<int[]>(room);
    id = std::make_unique_for_overwrite<std::int64_t[]>(room);
    for (int d = 0; d < 3; ++d) x[d] = &values[static_cast<std::size_t>(d) * room];
    radius = &values[3 * static_cast<std::size_t>(room)];
    for (float* values_of : {x[0], x[1], x[2], radius}) std::fill_n(values_of + n, beyond, 0.0F);
    const double* lower = grid.lower();
    const int* particle = own.particle.data();
    for (int k = 0; k < n; ++k) {
      __builtin_prefetch(&store.motion[particle[k + ahead < n ? k + ahead : k]]);
      const Motion& motion = store.motion[particle[k]];
      for (int d = 0; d < 3; ++d) x[d][k] = static_cast<float>(motion.position[d] - lower[d]);
      radius[k] = static_cast<float>(motion.radius);
      largest_radius = std::max(largest_radius, motion.radius);
      id[k] = store.id[particle[k]];
    }
    for (int r = 0, c = 0; r < grid.rows(); ++r)
      for (int q = 0; q < grid.cells_a_row(); ++q, ++c)
        for (int k = own.start[c]; k < own.start[c + 1]; ++k) column[k] = q;
  }
  /// What rounding may change of a gap of spheres within `reach`: a few units in the last place of coordinates that may
  /// be a period further away. m
  double uncertainty(const CellGrid& grid, double reach) const {
    return 1e-6 * (grid.largest_extent() + 2 * (2 * largest_radius + reach));
  }
};

}  // namespace

void find_pairs(const CellGrid& grid, Bins& own, const Store& store, const Periods& periods,
                const PairReach& pair_reach, const ContactMemory& memory, const Kernels& kernels, ContactLists& lists) {
  const double per_skin = 1 / pair_reach.skin, reach = pair_reach.leave_gap + pair_reach.skin;
  // A pair is listed by its lower id; one that remembers stays a contact.
  const auto remember = [&](int a, int b, std::int64_t id_a, std::int64_t id_b, double gap) {
    const bool in_order = id_a < id_b;
    const int i = in_order ? a : b, j = a + b - i;
    if (gap < pair_reach.memory_gap) {
      const bool holds = i < store.owned;
      const int p = holds ? i : j;
      if (const double* history = memory.find(p, holds == in_order ? id_b : id_a); history) {
        lists.add_contact(i, j, history, 1);
        return;
      }
    }
    lists.add_candidate(i, j, (gap - pair_reach.enter_gap) * per_skin);
  };

  // One sphere against a cell and all around it.
  NearSearch search;
  search.periods = &periods;
  search.reach = reach;
  std::vector<int> found;
  std::vector<double> squares;
  NearSearch::Stretch stretch[27];
  search.stretch = stretch;
  const auto look_around = [&](int cell) {
    CellGrid::Run run[27];
    const int runs = grid.neighbours(cell, run);
    search.stretches = 0;
    std::size_t room = 8;
    for (int q = 0; q < runs; ++q) {
      const NearSearch::Stretch one{own.start[run[q].first], own.start[run[q].last + 1]};
      if (one.begin == one.end) continue;
      stretch[search.stretches++] = one;
      room += one.end - one.begin;
    }
    if (room > found.size()) found.resize(2 * room), squares.resize(2 * room);
    search.found = found.data(), search.square = squares.data();
    search.across = periods.any;
  };
  const auto around = [&](const Motion& motion) {
    for (int d = 0; d < 3; ++d) search.sphere[d] = motion.position[d];
    search.sphere[3] = motion.radius;
    kernels.near(search);
  };
  const auto exact_gap = [&](int a, int b) {
    const Motion &one = store.motion[a], &other = store.motion[b];
    double square = 0;
    for (int d = 0; d < 3; ++d) {
      const double distance = image(one.position[d] - other.position[d], periods.length[d], periods.inverse[d]);
      square += distance * distance;
    }
    return std::sqrt(square) - (one.radius + other.radius);
  };
  const auto gap_of = [&](int k, double radius) { return std::sqrt(squares[k]) - (radius + own.r[found[k]]); };

  // Particles of a rank stand along the cells, and a pair is found from the one that stands first.
  const RowColumns columns(grid, own, store);
  const double uncertain = columns.uncertainty(grid, reach);
  const bool by_rows = grid.each_once() && uncertain < 0.1 * pair_reach.skin + 1e-3 * columns.largest_radius;
  if (!own.x && !(by_rows && store.ghosts == 0)) own.place(store);
  search.x[0] = own.x.get(), search.x[1] = own.y.get(), search.x[2] = own.z.get(), search.radius = own.r.get();
  if (by_rows) {
    RowSearch row;
    for (int d = 0; d < 3; ++d) row.x[d] = columns.x[d];
    row.radius = columns.radius;
    row.column = columns.column.get();
    row.cells = grid.cells_a_row();
    row.period = static_cast<float>(periods.length[0]);
    row.reach = static_cast<float>(reach + uncertain);
    std::unique_ptr<int[]> seekers, partners;
    std::unique_ptr<float[]> gaps, radii;
    const auto make_room = [&](int room) {
      row.room = room;
      seekers = std::make_unique_for_overwrite<int[]>(room);
      partners = std::make_unique_for_overwrite<int[]>(room);
      gaps = std::make_unique_for_overwrite<float[]>(room);
      radii = std::make_unique_for_overwrite<float[]>(room);
      row.seeker = seekers.get(), row.found = partners.get(), row.gap = gaps.get(), row.radii = radii.get();
    };
    make_room(2048);
    for (int r = 0; r < grid.rows(); ++r) {
      CellGrid::Row rows[9];
      row.rows = grid.later_rows(r, rows);
      for (int q = 0; q < row.rows; ++q) {
        row.row[q].start = &own.start[rows[q].row * row.cells];
        for (int d = 0; d < 2; ++d)
          row.row[q].shift[d] = static_cast<float>(rows[q].periods[d] * periods.length[1 + d]);
      }
      row.next = row.row[0].start[0], row.last = row.row[0].start[row.cells];
      while (row.next < row.last) {
        kernels.near_row(row);
        for (int k = 0; k < row.count; ++k) {
          const int s = row.seeker[k], f = row.found[k], a = own.particle[s], b = own.particle[f];
          double gap = row.gap[k] - uncertain;  // pairs are looked at rather too early than too late
          if (gap + 2 * uncertain > reach || std::abs(row.gap[k] - pair_reach.memory_gap) < uncertain) {
            gap = exact_gap(a, b);
            if (gap >= reach) continue;
          }
          remember(a, b, columns.id[s], columns.id[f], gap);
        }
        if (row.count == 0 && row.next < row.last) make_room(4 * row.needed);
      }
    }
  } else {
    for (int c = 0; c < grid.cells(); ++c) {
      if (own.start[c] == own.start[c + 1]) continue;
      look_around(c);
      for (int s = own.start[c]; s < own.start[c + 1]; ++s) {
        search.after = s;
        around(store.motion[own.particle[s]]);
        for (int k = 0; k < search.count; ++k)
          remember(own.particle[s], own.particle[found[k]], columns.id[s], columns.id[found[k]], gap_of(k, own.r[s]));
      }
    }
  }
  search.after = -1;
  for (int g = store.owned; g < store.all(); ++g) {
    const Motion& ghost = store.motion[g];
    look_around(grid.cell_of(ghost.position));
    around(ghost);
    for (int k = 0; k < search.count; ++k)
      remember(own.particle[found[k]], g, columns.id[found[k]], store.id[g], gap_of(k, ghost.radius));
  }
}

}  // namespace silt
