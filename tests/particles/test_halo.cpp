#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "base/petsc.hpp"
#include "particles/halo.hpp"
#include "particles/occupied_cells.hpp"

using namespace silt;

namespace {

struct Sphere {
  double x[3], radius;
};

double gap_of(const Sphere& a, const Sphere& b, const Periods& periods) {
  double square = 0;
  for (int d = 0; d < 3; ++d) {
    double distance = a.x[d] - b.x[d];
    if (periods.length[d] > 0) distance -= periods.length[d] * std::nearbyint(distance / periods.length[d]);
    square += distance * distance;
  }
  return std::sqrt(square) - a.radius - b.radius;
}

/// 4000 spheres in a box of 20 x 16 x 12, half of them a fifth as large.
std::vector<Sphere> spheres() {
  std::mt19937 draw(7);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<Sphere> all;
  for (int k = 0; k < 4000; ++k) all.push_back({{20 * any(draw), 16 * any(draw), 12 * any(draw)}, k % 2 ? 0.1 : 0.5});
  return all;
}

Periods periods_of(bool x, bool y, bool z) {
  Periods periods;
  const double length[3] = {x ? 20.0 : 0.0, y ? 16.0 : 0.0, z ? 12.0 : 0.0};
  for (int d = 0; d < 3; ++d)
    if (length[d] > 0) periods.length[d] = length[d], periods.inverse[d] = 1 / length[d], periods.any = true;
  return periods;
}

/// Who owns a sphere, and on how many ranks.
using Share = int (*)(const Sphere&, int ranks);

void compare(const Periods& periods, double gap, Share share) {
  const std::vector<Sphere> all = spheres();
  const int me = mpi_rank(), ranks = mpi_size();
  Store store;
  store.reserve(static_cast<int>(all.size()));
  double lower[3] = {1e9, 1e9, 1e9}, upper[3] = {-1e9, -1e9, -1e9};
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (share(all[k], ranks) != me) continue;
    Motion& motion = store.motion[store.owned++] = Motion{};
    for (int d = 0; d < 3; ++d) {
      motion.position[d] = all[k].x[d];
      lower[d] = std::min(lower[d], all[k].x[d]), upper[d] = std::max(upper[d], all[k].x[d]);
    }
    motion.radius = all[k].radius;
    store.id.push_back(static_cast<std::int64_t>(k));
    store.cell.push_back(0);
  }
  std::set<std::int64_t> wanted;
  for (std::size_t k = 0; k < all.size(); ++k)
    for (int p = 0; p < store.owned && share(all[k], ranks) != me; ++p)
      if (gap_of(all[k], all[store.id[p]], periods) < gap) {
        wanted.insert(static_cast<std::int64_t>(k));
        break;
      }

  const double reach = 1 + gap;
  const CellGrid grid(vec3(lower), vec3(upper), Vec3::Zero(), periods, reach, store.owned);
  const Bins own(order_along(grid, store), store);
  Halo halo(PETSC_COMM_WORLD);
  halo.build(store, periods, grid, own, reach, gap);
  const std::set<std::int64_t> got(store.id.begin() + store.owned, store.id.end());
  CHECK(got == wanted);
  CHECK(static_cast<int>(got.size()) == store.ghosts);
  for (int p = store.owned; p < store.all(); ++p) CHECK(store.motion[p].position[0] == all[store.id[p]].x[0]);
  CHECK(mpi_sum(static_cast<double>(halo.bytes(store))) == 72 * mpi_sum(static_cast<double>(store.ghosts)));
}

}  // namespace

TEST_CASE("A rank gets the spheres that may touch its own, each once, and no others", "[mpi]") {
  for (const Periods& periods : {periods_of(false, false, false), periods_of(true, true, false), periods_of(1, 1, 1)})
    for (const double gap : {0.1, 0.7}) {
      // Slabs; a core and what is around it; scattered; all on the last rank.
      compare(periods, gap, [](const Sphere& s, int ranks) { return static_cast<int>(s.x[0] / 20 * ranks); });
      compare(periods, gap, [](const Sphere& s, int ranks) {
        return std::min(ranks - 1, static_cast<int>(std::hypot(s.x[0] - 10, s.x[1] - 8, s.x[2] - 6) / 4));
      });
      compare(periods, gap, [](const Sphere& s, int ranks) { return static_cast<int>(1e4 * s.x[0]) % ranks; });
      compare(periods, gap, [](const Sphere&, int ranks) { return ranks - 1; });
    }
}

TEST_CASE("Cells that hold a point are found from every point nearer than the reach, across periodic sides") {
  const std::vector<Sphere> all = spheres();
  for (const Periods& periods : {periods_of(false, false, false), periods_of(true, false, true), periods_of(1, 1, 1)})
    for (const double reach : {0.3, 1.1, 30.0}) {
      OccupiedCells::Extent extent{{1e9, 1e9, 1e9}, {-1e9, -1e9, -1e9}, 20};
      for (int k = 0; k < 20; ++k)
        for (int d = 0; d < 3; ++d) {
          extent.lower[d] = std::min(extent.lower[d], all[k].x[d]);
          extent.upper[d] = std::max(extent.upper[d], all[k].x[d]);
        }
      OccupiedCells cells(extent, reach);
      for (int k = 0; k < 20; ++k) cells.mark(all[k].x);
      cells.spread();
      int missed = 0;
      for (const Sphere& one : all)
        for (int k = 0; k < 20; ++k)
          missed += gap_of(one, all[k], periods) + one.radius + all[k].radius < reach && !cells.near(one.x, periods);
      CHECK(missed == 0);
    }
}

TEST_CASE("A rank's spheres may lie in a row of more than a million cells") {
  const double end[3] = {2e6, 0, 0}, beside[3] = {2e6 - 5, 0, 0};
  OccupiedCells cells({{0, 0, 0}, {2e6, 0, 0}, 1e6}, 1);
  REQUIRE(64 * cells.bits().size() > 2'000'000);
  cells.mark(end);
  cells.spread();
  CHECK(cells.near(end, periods_of(false, false, false)));
  CHECK_FALSE(cells.near(beside, periods_of(false, false, false)));
}
