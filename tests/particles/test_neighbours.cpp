#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <set>

#include "particles/neighbours.hpp"

using namespace silt;

namespace {

struct Box {
  double length[3];
  bool periodic[3];
};

/// `count` spheres at random in the box, a quarter of them three times as large, in no order; the last `ghosts` of them
/// are ghosts. Ids count downwards, so that the order of ids is not that of places.
Store spheres_in(const Box& box, int count, int ghosts) {
  Store store;
  store.reserve(count);
  store.owned = count - ghosts;
  store.ghosts = ghosts;
  std::mt19937 draw(11);
  std::uniform_real_distribution<double> any(0, 1);
  for (int p = 0; p < count; ++p) {
    Motion& motion = store.motion[p] = Motion{};
    for (int d = 0; d < 3; ++d) motion.position[d] = box.length[d] * any(draw);
    motion.radius = p % 4 ? 0.15 : 0.45;
    store.id.push_back(count - p);
    if (p < store.owned) store.cell.push_back(0);
  }
  store.place_padding();
  return store;
}

std::set<std::pair<int, int>> pairs_by_looking_at_all(const Store& store, const Periods& periods, double gap) {
  std::set<std::pair<int, int>> near;
  for (int a = 0; a < store.owned; ++a)
    for (int b = a + 1; b < store.all(); ++b) {
      double square = 0;
      for (int d = 0; d < 3; ++d) {
        double distance = store.motion[a].position[d] - store.motion[b].position[d];
        distance -= periods.length[d] * std::nearbyint(distance * periods.inverse[d]);
        square += distance * distance;
      }
      if (std::sqrt(square) < store.motion[a].radius + store.motion[b].radius + gap)
        near.insert({std::max(a, b), std::min(a, b)});  // the one of the lower id comes first
    }
  return near;
}

}  // namespace

TEST_CASE("The lists hold every pair nearer than the reach, once, and no other, in any order of the spheres") {
  // Rows of cells without a wrap, rows of nothing but wraps, single cells.
  const Box boxes[] = {
      {{12, 9, 8}, {false, false, false}},   {{12, 9, 8}, {true, true, true}},    {{12, 9, 8}, {true, false, false}},
      {{12, 9, 8}, {false, true, false}},    {{12, 9, 8}, {false, false, true}},  {{40, 3.5, 3.5}, {true, true, true}},
      {{3.5, 3.5, 40}, {true, true, false}}, {{60, 1, 1}, {false, false, false}}, {{12, 2.4, 8}, {true, true, true}}};
  for (const char* instructions : {"plain", "auto"})
    for (const Box& box : boxes) {
      Periods periods;
      for (int d = 0; d < 3; ++d)
        if (box.periodic[d])
          periods.length[d] = box.length[d], periods.inverse[d] = 1 / box.length[d], periods.any = true;
      const Store store = spheres_in(box, 1000, 100);
      const double gap = 0.05, skin = 0.2, reach = 0.9 + gap + skin;
      const CellGrid grid(Vec3::Zero(), vec3(box.length), Vec3::Zero(), periods, reach, store.owned);
      Bins own(order_along(grid, store), store, false);
      ContactMemory memory(0);
      memory.rows.start.assign(store.owned + 1, 0);
      ContactLists lists(0);
      // All that is listed counts as a contact at once.
      const double all = gap + skin;
      const Kernels& kernels = choose_kernels(instructions);
      lists.clear();
      find_pairs(grid, own, store, periods, {all, gap, skin, 0}, memory, kernels, lists);
      lists.pad(store.padding(), store.owned);
      CandidateSweep sweep;
      sweep.motion = store.motion.data();
      sweep.periods = periods;
      sweep.enter_gap = all;
      lists.look(sweep, 0, skin, kernels.candidates);
      std::set<std::pair<int, int>> found;
      for (int k = 0; k < lists.contacts(); ++k) found.insert({lists.contact_i()[k], lists.contact_j()[k]});
      CHECK(lists.contacts() == static_cast<int>(found.size()));
      CHECK(lists.candidates() == 0);
      CHECK(found == pairs_by_looking_at_all(store, periods, all));
    }
}
