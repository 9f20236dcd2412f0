#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/vector.hpp"

namespace silt {

/// Numbers points in the order they first come, taking those within a tolerance for the same one.
class PointIndex {
 public:
  explicit PointIndex(double tolerance) : tolerance_(tolerance), width_(64 * tolerance) {}

  int operator()(const Vec3& point) {
    // Bins are much wider than the tolerance: nearly always all 8 probes fall into one bin.
    for (int corner = 0; corner < 8; ++corner) {
      const auto found = bins_.find(bin(point, corner));
      if (found == bins_.end()) continue;
      for (int id : found->second)
        if ((points_[id] - point).norm() <= tolerance_) return id;
    }
    const int id = static_cast<int>(points_.size());
    points_.push_back(point);
    bins_[bin(point, -1)].push_back(id);
    return id;
  }
  int size() const { return static_cast<int>(points_.size()); }
  const Vec3& operator[](int id) const { return points_[id]; }

 private:
  using Bin = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Bin& b) const {
      std::uint64_t h = 0;
      for (auto v : b) h = (h ^ static_cast<std::uint64_t>(v)) * 0x9E3779B97F4A7C15ull, h ^= h >> 29;
      return h;
    }
  };
  Bin bin(const Vec3& point, int corner) const {
    Bin b;
    for (int d = 0; d < 3; ++d) {
      const double side = corner < 0 ? 0 : corner >> d & 1 ? tolerance_ : -tolerance_;
      b[d] = static_cast<std::int64_t>(std::floor((point[d] + side) / width_));
    }
    return b;
  }

  double tolerance_, width_;
  std::vector<Vec3> points_;
  std::unordered_map<Bin, std::vector<int>, Hash> bins_;
};

}  // namespace silt
