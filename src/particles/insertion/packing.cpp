#include "particles/insertion/packing.hpp"

#include <algorithm>
#include <cmath>

namespace silt {

Packing::Bin Packing::bin(const Vec3& centre) const {
  Bin result;
  for (int d = 0; d < 3; ++d) result[d] = static_cast<std::int64_t>(std::floor(centre[d] / width_[d]));
  return result;
}

std::size_t Packing::slot(Bin bin) const {
  std::uint64_t h = 0x243F6A8885A308D3ull;
  for (int d = 0; d < 3; ++d) {
    if (bins_[d]) bin[d] = ((bin[d] % bins_[d]) + bins_[d]) % bins_[d];
    h = (h ^ static_cast<std::uint64_t>(bin[d])) * 0x9E3779B97F4A7C15ull;
    h ^= h >> 31;
  }
  return h & (first_.size() - 1);
}

void Packing::link(int sphere) {
  int& head = first_[slot(bin(centres_[sphere]))];
  next_[sphere] = head;
  head = sphere;
}

void Packing::refile() {
  for (int d = 0; d < 3; ++d) {
    bins_[d] = period_[d] > 0 ? std::max<std::int64_t>(1, static_cast<std::int64_t>(period_[d] / (2 * largest_))) : 0;
    width_[d] = bins_[d] ? period_[d] / static_cast<double>(bins_[d]) : 2 * largest_;
  }
  std::size_t slots = 64;
  while (slots < 4 * centres_.size()) slots *= 2;
  first_.assign(slots, -1);
  for (int sphere = 0; sphere < count(); ++sphere) link(sphere);
}

void Packing::add(const Vec3& centre, double radius) {
  centres_.push_back(centre);
  radii_.push_back(radius);
  next_.push_back(-1);
  if (radius > largest_ || first_.size() < 2 * centres_.size()) {
    largest_ = std::max(largest_, radius);
    refile();
  } else {
    link(count() - 1);
  }
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
      for (std::int64_t i = low[0]; i <= high[0]; ++i)
        for (int s = first_[slot({i, j, k})]; s >= 0; s = next_[s]) {
          Vec3 apart = centre - centres_[s];
          for (int d = 0; d < 3; ++d)
            if (period_[d] > 0) apart[d] -= period_[d] * std::round(apart[d] / period_[d]);
          if (visit(s, apart.norm())) return true;
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
