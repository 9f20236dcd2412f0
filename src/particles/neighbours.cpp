#include "particles/neighbours.hpp"

#include <algorithm>
#include <cmath>

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
  for (int d = 0; d < 3; ++d) inverse_[d] = extent[d] > 0 ? count_[d] / extent[d] : 0;
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

int CellGrid::later_rows(int row, int* rows, int& first, int& last) const {
  const int y = row % count_[1], z = row / count_[1];
  const auto at_a_wrap = [&](int d, int at) { return wraps_[d] && (at == 0 || at == count_[d] - 1); };
  first = last = 0;
  if (at_a_wrap(1, y) || at_a_wrap(2, z)) return 0;
  first = wraps_[0] ? 1 : 0;
  last = std::max(first, wraps_[0] ? count_[0] - 1 : count_[0]);
  int found = 0;
  rows[found++] = row;
  if (y + 1 < count_[1]) rows[found++] = row + 1;
  if (z + 1 < count_[2])
    for (int beside = std::max(y - 1, 0); beside <= std::min(y + 1, count_[1] - 1); ++beside)
      rows[found++] = (z + 1) * count_[1] + beside;
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

Bins::Bins(CellOrder&& order, const Store& store) : start(std::move(order.start)), particle(std::move(order.order)) {
  constexpr int widest = 8;  // pack
  const int n = store.owned;
  for (auto* values : {&x, &y, &z, &r}) values->resize(n + widest);
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

void find_pairs(const CellGrid& grid, const Bins& own, const Store& store, const Periods& periods,
                const PairReach& pair_reach, const ContactMemory& memory, const Kernels& kernels, ContactLists& lists) {
  const double per_skin = 1 / pair_reach.skin;
  const auto remember = [&](int a, int b, double gap) {
    const std::int64_t id_a = store.id[a], id_b = store.id[b];
    const int i = id_a < id_b ? a : b, j = id_a < id_b ? b : a;
    if (gap < pair_reach.memory_gap) {
      const int p = i < store.owned ? i : j;
      if (const double* history = memory.find(p, store.id[p == i ? j : i]); history) {
        lists.add_contact(i, j, history, 1);
        return;
      }
    }
    lists.add_candidate(i, j, (gap - pair_reach.enter_gap) * per_skin);
  };
  std::vector<int> found(1024), seeker(1024);
  std::vector<double> squares(1024);
  const auto make_room = [&](int room) {
    if (room <= static_cast<int>(found.size())) return;
    found.resize(2 * room), seeker.resize(2 * room), squares.resize(2 * room);
  };
  RowSearch row;
  NearSearch& search = row.search;
  search.x[0] = own.x.data(), search.x[1] = own.y.data(), search.x[2] = own.z.data(), search.radius = own.r.data();
  search.periods = &periods;
  search.reach = pair_reach.leave_gap + pair_reach.skin;
  const auto use_room = [&] {
    search.found = found.data(), search.square = squares.data();
    row.seeker = seeker.data(), row.room = static_cast<int>(found.size());
  };

  // One sphere against a cell and all around it.
  NearSearch::Stretch stretch[27];
  search.stretch = stretch;
  const auto look_around = [&](int cell) {
    CellGrid::Run run[27];
    const int runs = grid.neighbours(cell, run);
    search.stretches = 0;
    int room = 8;
    for (int q = 0; q < runs; ++q) {
      const NearSearch::Stretch one{own.start[run[q].first], own.start[run[q].last + 1]};
      if (one.begin == one.end) continue;
      stretch[search.stretches++] = one;
      room += one.end - one.begin;
    }
    make_room(room);
    use_room();
    search.across = periods.any;
  };
  const auto around = [&](const Motion& motion) {
    for (int d = 0; d < 3; ++d) search.sphere[d] = motion.position[d];
    search.sphere[3] = motion.radius;
    kernels.near(search);
  };
  const auto gap_of = [&](int k, double radius) { return std::sqrt(squares[k]) - (radius + own.r[found[k]]); };

  // Particles of a rank stand along the cells, and a pair is found from the one that stands first: from its row where
  // no periodic side is near.
  const auto across_sides = [&](int first_cell, int last_cell) {
    for (int c = first_cell; c < last_cell; ++c) {
      if (own.start[c] == own.start[c + 1]) continue;
      look_around(c);
      for (int s = own.start[c]; s < own.start[c + 1]; ++s) {
        search.after = s;
        around(store.motion[own.particle[s]]);
        for (int k = 0; k < search.count; ++k) remember(own.particle[s], own.particle[found[k]], gap_of(k, own.r[s]));
      }
    }
  };
  row.cells = grid.cells_a_row();
  for (int r = 0; r < grid.rows(); ++r) {
    int rows[5];
    const int here = r * row.cells;
    row.rows = grid.later_rows(r, rows, row.cell, row.last);
    for (int q = 0; q < row.rows; ++q) row.start[q] = &own.start[rows[q] * row.cells];
    across_sides(here, here + row.cell);
    while (row.cell < row.last) {
      use_room();
      kernels.near_row(row);
      for (int k = 0; k < search.count; ++k)
        remember(own.particle[seeker[k]], own.particle[found[k]], gap_of(k, own.r[seeker[k]]));
      if (search.count == 0) make_room(row.needed);
    }
    across_sides(here + row.last, here + row.cells);
  }
  search.after = -1;
  for (int g = store.owned; g < store.all(); ++g) {
    const Motion& ghost = store.motion[g];
    look_around(grid.cell_of(ghost.position));
    around(ghost);
    for (int k = 0; k < search.count; ++k) remember(own.particle[found[k]], g, gap_of(k, ghost.radius));
  }
}

}  // namespace silt
