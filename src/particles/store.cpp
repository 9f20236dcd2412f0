#include "particles/store.hpp"

#include <algorithm>
#include <limits>

#include "particles/rearrange.hpp"

namespace silt {

void Store::reserve(int count) {
  const auto n = static_cast<std::size_t>(count) + 2;
  motion.reserve(n);
  rotation.reserve(n);
  present.reserve(n);
  previous.reserve(n);
  columns.reserve(count);
}

void Store::place_padding() {
  columns.clear(padding(), padding() + 2);
  // Two points without size, a metre apart: they never touch and stay finite.
  for (int k = 0; k < 2; ++k) {
    Motion& motion_k = motion[padding() + k];
    motion_k = Motion{};
    motion_k.position[0] = owned > 0 ? motion[0].position[0] : 0;
    motion_k.position[k] += 1;
    motion_k.radius = 1e-3;
    motion_k.inverse_mass = 1;
    rotation[padding() + k] = Rotation{};
    present[padding() + k] = previous[padding() + k] = Load{};
  }
}

void Store::note_origins(const Vec3& lower, const Vec3& upper) {
  for (int d = 0; d < 3; ++d) corner_[d] = lower[d];
  const double extent = (upper - lower).maxCoeff();
  rounding_ = 2 * extent * std::numeric_limits<float>::epsilon();
  origin_.resize(3 * static_cast<std::size_t>(owned));
  for (int p = 0; p < owned; ++p)
    for (int d = 0; d < 3; ++d)
      origin_[3 * static_cast<std::size_t>(p) + d] = static_cast<float>(motion[p].position[d] - corner_[d]);
}

std::vector<std::pair<std::string, std::size_t>> Store::bytes() const {
  return {{"motion", motion.capacity() * sizeof(Motion) + rotation.capacity() * sizeof(Rotation)},
          {"loads", (present.capacity() + previous.capacity()) * sizeof(Load)},
          {"fluid", action.capacity() * sizeof(FluidAction) + drag.capacity() * sizeof(DragStep) +
                        turning.capacity() * sizeof(TurnStep) + turned.capacity() * sizeof(double)},
          {"ids, cells, origins",
           id.capacity() * sizeof(id[0]) + cell.capacity() * sizeof(int) + origin_.capacity() * sizeof(float)},
          {"columns", columns.bytes()}};
}

void Store::reorder(const std::vector<int>& order, Aligned<Load>& carried) {
  const Rearrangement rearrange(order, owned);
  owned = static_cast<int>(order.size());
  if (rearrange.nothing_moves()) return;
  rearrange.apply(motion.data());
  rearrange.apply(rotation.data());
  rearrange.apply(carried.data());
  rearrange.apply(id.data());
  rearrange.apply(cell.data());
  if (acted_on) rearrange.apply(action.data());
  id.resize(owned);
  cell.resize(owned);
  if (acted_on) action.resize(owned);
  columns.reorder(rearrange);
}

}  // namespace silt
