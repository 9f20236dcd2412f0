#include "particles/insertion/packing.hpp"

#include <algorithm>
#include <cmath>

namespace silt {

Packing::Bin Packing::bin(const Vec3& centre) const {
  Bin result;
  for (int d = 0; d < 3; ++d) {
    result[d] = static_cast<std::int64_t>(std::floor(centre[d] / width_[d]));
    if (bins_[d]) result[d] = ((result[d] % bins_[d]) + bins_[d]) % bins_[d];
  }
  return result;
}

void Packing::rebin(double largest) {
  largest_ = largest;
  for (int d = 0; d < 3; ++d) {
    bins_[d] = period_[d] > 0 ? std::max<std::int64_t>(1, static_cast<std::int64_t>(period_[d] / (2 * largest))) : 0;
    width_[d] = bins_[d] ? period_[d] / static_cast<double>(bins_[d]) : 2 * largest;
  }
  first_.clear();
  for (size_t i = 0; i < centres_.size(); ++i) {
    auto& head = first_.emplace(bin(centres_[i]), -1).first->second;
    next_[i] = head;
    head = static_cast<int>(i);
  }
}

void Packing::add(const Vec3& centre, double radius) {
  centres_.push_back(centre);
  radii_.push_back(radius);
  next_.push_back(-1);
  if (radius > largest_) return rebin(radius);
  auto& head = first_.emplace(bin(centre), -1).first->second;
  next_.back() = head;
  head = static_cast<int>(centres_.size()) - 1;
}

template <class Visit>
bool Packing::around(const Vec3& centre, double radius, Visit&& visit) const {
  if (centres_.empty()) return false;
  Bin low, high;
  for (int d = 0; d < 3; ++d) {
    const double reach = radius + largest_;
    low[d] = static_cast<std::int64_t>(std::floor((centre[d] - reach) / width_[d]));
    high[d] = static_cast<std::int64_t>(std::floor((centre[d] + reach) / width_[d]));
    if (bins_[d]) high[d] = std::min(high[d], low[d] + bins_[d] - 1);  // every bin once
  }
  for (std::int64_t k = low[2]; k <= high[2]; ++k)
    for (std::int64_t j = low[1]; j <= high[1]; ++j)
      for (std::int64_t i = low[0]; i <= high[0]; ++i) {
        Bin key{i, j, k};
        for (int d = 0; d < 3; ++d)
          if (bins_[d]) key[d] = ((key[d] % bins_[d]) + bins_[d]) % bins_[d];
        const auto found = first_.find(key);
        if (found == first_.end()) continue;
        for (int s = found->second; s >= 0; s = next_[s]) {
          Vec3 apart = centre - centres_[s];
          for (int d = 0; d < 3; ++d)
            if (period_[d] > 0) apart[d] -= period_[d] * std::round(apart[d] / period_[d]);
          if (visit(s, apart.norm())) return true;
        }
      }
  return false;
}

bool Packing::blocked(const Vec3& centre, double radius) const {
  return around(centre, radius, [&](int s, double distance) { return distance < radius + radii_[s]; });
}

Packing::Overlap Packing::deepest(const Vec3& centre, double radius) const {
  Overlap worst;
  around(centre, radius, [&](int s, double distance) {
    const double share = (radius + radii_[s] - distance) / std::min(radius, radii_[s]);
    if (share > worst.share) worst = {s, share};
    return false;
  });
  return worst;
}

}  // namespace silt
