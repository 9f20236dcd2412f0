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

int CellGrid::later_neighbours(int cell, Run* run) const {
  const int row = count_[0], layer = count_[0] * count_[1];
  run[0] = {cell, cell + 1};
  run[1] = {cell + row - 1, cell + row + 1};
  for (int y = -1; y <= 1; ++y) run[3 + y] = {cell + layer + y * row - 1, cell + layer + y * row + 1};
  return 5;
}

std::vector<int> order_along(const CellGrid& grid, const Store& store) {
  std::vector<int> cell(store.owned), start(grid.cells() + 1, 0), order(store.owned);
  for (int p = 0; p < store.owned; ++p) {
    cell[p] = grid.cell_of(store.motion[p].position);
    ++start[cell[p] + 1];
  }
  for (int c = 0; c < grid.cells(); ++c) start[c + 1] += start[c];
  for (int p = 0; p < store.owned; ++p) order[start[cell[p]]++] = p;
  return order;
}

Bins::Bins(const CellGrid& grid, const Store& store, int first, int last) {
  const int n = last - first;
  start.assign(grid.cells() + 1, 0);
  std::vector<int> cell(n);
  for (int k = 0; k < n; ++k) {
    cell[k] = grid.cell_of(store.motion[first + k].position);
    ++start[cell[k] + 1];
  }
  for (int c = 0; c < grid.cells(); ++c) start[c + 1] += start[c];
  index.resize(n), x.resize(n), y.resize(n), z.resize(n), r.resize(n);
  std::vector<int> at(start.begin(), start.end() - 1);
  for (int k = 0; k < n; ++k) {
    const int s = at[cell[k]]++;  // == k where they are sorted along the cells
    const Motion& motion = store.motion[first + k];
    index[s] = first + k;
    x[s] = motion.position[0], y[s] = motion.position[1], z[s] = motion.position[2], r[s] = motion.radius;
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
                const PairReach& pair_reach, const ContactMemory& memory, ContactLists& lists) {
  const double memory_gap = pair_reach.memory_gap, enter_gap = pair_reach.enter_gap, skin = pair_reach.skin;
  const double reach = pair_reach.leave_gap + skin;
  const Bins ghosts(grid, store, store.owned, store.all());
  std::vector<int> found(64);
  std::vector<double> squares(64);
  const auto remember = [&](int a, int b, double square) {
    const std::int64_t id_a = store.id[a], id_b = store.id[b];
    const int i = id_a < id_b ? a : b, j = id_a < id_b ? b : a;
    const double touch = store.motion[a].radius + store.motion[b].radius + memory_gap;
    const double* history = nullptr;
    if (square < touch * touch) {
      const int p = i < store.owned ? i : j;
      history = memory.find(p, p == i ? store.id[j] : store.id[i]);
      if (history) {
        lists.add_contact(i, j, history, 1);
        return;
      }
    }
    lists.add_candidate(i, j, (std::sqrt(square) - store.motion[a].radius - store.motion[b].radius - enter_gap) / skin);
  };
  bool across = periods.any;  // whether a nearest image may be another than the particle itself
  const auto search = [&](const Bins& bins, int begin, int end, const Motion& motion, int& n) {
    if (static_cast<int>(found.size()) < n + end - begin)
      found.resize(2 * (n + end - begin)), squares.resize(found.size());
    const double px = motion.position[0], py = motion.position[1], pz = motion.position[2], pr = motion.radius + reach;
    int* const number = found.data();
    double* const square_of = squares.data();
    int m = n;
    if (across)
      for (int k = begin; k < end; ++k) {
        const double dx = image(px - bins.x[k], periods.length[0], periods.inverse[0]);
        const double dy = image(py - bins.y[k], periods.length[1], periods.inverse[1]);
        const double dz = image(pz - bins.z[k], periods.length[2], periods.inverse[2]);
        const double square = dx * dx + dy * dy + dz * dz, cut = pr + bins.r[k];
        number[m] = k, square_of[m] = square;
        m += square < cut * cut;
      }
    else
      for (int k = begin; k < end; ++k) {
        const double dx = px - bins.x[k], dy = py - bins.y[k], dz = pz - bins.z[k];
        const double square = dx * dx + dy * dy + dz * dz, cut = pr + bins.r[k];
        number[m] = k, square_of[m] = square;
        m += square < cut * cut;
      }
    n = m;
  };
  // Owned particles are sorted along the cells, so a pair is found from the one that stands first.
  CellGrid::Run run[27];
  struct Stretch {
    int begin, end;
  } range[27];
  for (int c = 0; c < grid.cells(); ++c) {
    if (own.start[c] == own.start[c + 1]) continue;
    const bool inner = store.ghosts == 0 && grid.inner(c);
    const int runs = inner ? grid.later_neighbours(c, run) : grid.neighbours(c, run);
    across = periods.any && !inner;  // positions are wrapped into the domain
    int ranges = 0, ghost_ranges = 0;
    for (int r = 0; r < runs; ++r)
      if (const Stretch one{own.start[run[r].first], own.start[run[r].last + 1]}; one.begin < one.end)
        range[ranges++] = one;
    for (int s = own.start[c]; s < own.start[c + 1]; ++s) {
      int n = 0;
      for (int r = 0; r < ranges; ++r)
        if (const int begin = std::max(range[r].begin, s + 1); begin < range[r].end)
          search(own, begin, range[r].end, store.motion[s], n);
      for (int k = 0; k < n; ++k) remember(s, found[k], squares[k]);
    }
    if (store.ghosts == 0) continue;
    for (int r = 0; r < runs; ++r)
      if (const Stretch one{ghosts.start[run[r].first], ghosts.start[run[r].last + 1]}; one.begin < one.end)
        range[ghost_ranges++] = one;
    for (int s = own.start[c]; ghost_ranges > 0 && s < own.start[c + 1]; ++s) {
      int n = 0;
      for (int r = 0; r < ghost_ranges; ++r) search(ghosts, range[r].begin, range[r].end, store.motion[s], n);
      for (int k = 0; k < n; ++k) remember(s, ghosts.index[found[k]], squares[k]);
    }
  }
}

}  // namespace silt
