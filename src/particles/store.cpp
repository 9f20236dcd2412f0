#include "particles/store.hpp"

namespace silt {

void Store::reserve(int count) {
  const auto n = static_cast<std::size_t>(count) + 2;
  motion.reserve(n);
  present.reserve(n);
  previous.reserve(n);
  origin.reserve(n);
  columns.reserve(count);
}

void Store::place_dummies() {
  columns.clear(dummy(), dummy() + 2);
  // Two points without size, a metre apart: they never touch and stay finite.
  for (int k = 0; k < 2; ++k) {
    Motion& motion_k = motion[dummy() + k];
    motion_k = Motion{};
    motion_k.position[0] = owned > 0 ? motion[0].position[0] : 0;
    motion_k.position[k] += 1;
    motion_k.radius = 1e-3;
    motion_k.inverse_mass = 1;
    motion_k.material = 0;
    present[dummy() + k] = previous[dummy() + k] = Load{};
  }
}

void Store::reorder(const std::vector<int>& order, Aligned<Load>& carried) {
  motion_scratch_.reserve(owned + 2);
  load_scratch_.reserve(owned + 2);
  owned = static_cast<int>(order.size());
  std::vector<std::int64_t> new_id(owned);
  std::vector<int> new_cell(owned);
  std::vector<FluidAction> new_action(owned);
  for (int k = 0; k < owned; ++k) {
    const int p = order[k];
    motion_scratch_[k] = motion[p];
    load_scratch_[k] = carried[p];
    new_id[k] = id[p];
    new_cell[k] = cell[p];
    new_action[k] = action[p];
  }
  motion.swap(motion_scratch_);
  carried.swap(load_scratch_);
  id.swap(new_id);
  cell.swap(new_cell);
  action.swap(new_action);
  columns.reorder(order);
}

}  // namespace silt
