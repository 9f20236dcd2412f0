#include "particles/occupied_cells.hpp"

#include <algorithm>
#include <cmath>

namespace silt {

OccupiedCells::OccupiedCells(const Extent& extent, double reach) {
  // Rounding must not bring two points nearer than the reach into cells that are not neighbours.
  const double least = reach * (1 + 1e-6), most = 4 * extent.particles + 64;
  for (double width = least;; width *= 1.25) {
    double cells = 1;
    for (int d = 0; d < 3; ++d) {
      count_[d] = static_cast<long>(std::min(std::floor((extent.upper[d] - extent.lower[d]) / width), 1e15)) + 3;
      lower_[d] = extent.lower[d];
      inverse_[d] = 1 / width;
      cells *= static_cast<double>(count_[d] - 2);
    }
    if (cells <= most) break;
  }
  bits_.assign((count_[0] * count_[1] * count_[2] + 63) / 64, 0);
}

void OccupiedCells::mark(const double* x) {
  long c[3];
  for (int d = 0; d < 3; ++d) c[d] = static_cast<long>((x[d] - lower_[d]) * inverse_[d]) + 1;
  set((c[2] * count_[1] + c[1]) * count_[0] + c[0]);
}

void OccupiedCells::spread() {
  // One direction after the other; along each the words that are read are those before it.
  const long step[3] = {1, count_[0], count_[0] * count_[1]}, cells = step[2] * count_[2];
  for (const long by : step) {
    const auto before = bits_;
    for (long w = 0; w < static_cast<long>(before.size()); ++w)
      for (std::uint64_t word = before[w]; word; word &= word - 1) {
        const long cell = 64 * w + __builtin_ctzll(word);
        if (cell - by >= 0) set(cell - by);
        if (cell + by < cells) set(cell + by);
      }
  }
}

bool OccupiedCells::near(const double* x, const Periods& periods) const {
  long place[3][3];
  int images[3];
  for (int d = 0; d < 3; ++d) {
    images[d] = 0;
    const double length = periods.length[d], at = x[d] - lower_[d];
    const int most = length > 0 ? 1 : 0;
    for (int s = -most; s <= most; ++s) {
      const double c = std::floor((at + s * length) * inverse_[d]) + 1;
      if (c >= 0 && c < static_cast<double>(count_[d])) place[d][images[d]++] = static_cast<long>(c);
    }
    if (images[d] == 0) return false;
  }
  for (int k = 0; k < images[2]; ++k)
    for (int j = 0; j < images[1]; ++j)
      for (int i = 0; i < images[0]; ++i)
        if (get((place[2][k] * count_[1] + place[1][j]) * count_[0] + place[0][i])) return true;
  return false;
}

double distance_square(const OccupiedCells::Extent& a, const OccupiedCells::Extent& b, const Periods& periods) {
  double square = 0;
  for (int d = 0; d < 3; ++d) {
    const double before = a.lower[d] - b.upper[d], behind = b.lower[d] - a.upper[d], length = periods.length[d];
    double gap = std::max({before, behind, 0.0});
    if (length > 0)
      gap = std::min(
          {gap, std::max({before + length, behind - length, 0.0}), std::max({before - length, behind + length, 0.0})});
    square += gap * gap;
  }
  return square;
}

}  // namespace silt
