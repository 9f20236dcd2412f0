#include "particles/insertion/lattice.hpp"

#include <array>
#include <cmath>

namespace silt {

std::vector<Vec3> lattice_sites(LatticeKind kind, double spacing, bool stretch, const Region& region, double radius,
                                const Packing& placed) {
  const Box box = region.centres(radius);
  const bool hexagonal = kind == LatticeKind::hexagonal;
  // Distance of sites along a row, of rows in a layer, and of layers.
  const Vec3 unit = hexagonal ? Vec3(1, std::sqrt(3.0) / 2, std::sqrt(2.0 / 3)) : Vec3(1, 1, 1);
  std::array<long long, 3> count{1, 1, 1};
  Vec3 step = Vec3::Zero();
  for (int d = 0; d < region.dimension(); ++d) {
    const double length = box.upper[d] - box.lower[d], least = spacing * unit[d];
    if (length < 0) return {};
    count[d] = static_cast<long long>(std::floor(length / least + 1e-9));
    if (region.spans_period(d)) {
      if (hexagonal && d > 0) count[d] -= count[d] % 2;  // rows and layers alternate
      if (count[d] == 0) return {};
      step[d] = length / static_cast<double>(count[d]);
    } else {
      step[d] = !stretch ? least : count[d] > 0 ? length / static_cast<double>(count[d]) : 0;
      ++count[d];
    }
  }
  std::vector<Vec3> sites;
  for (long long k = 0; k < count[2]; ++k)
    for (long long j = 0; j < count[1]; ++j)
      for (long long i = 0; i < count[0]; ++i) {
        Vec3 site =
            box.lower + Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)).cwiseProduct(step);
        if (hexagonal) {
          site[0] += 0.5 * step[0] * static_cast<double>((j + k) % 2);
          if (k % 2) site[1] += step[1] / 3;
        }
        if (region.dimension() == 2) site[2] = 0;
        for (int d = 0; d < 3; ++d)
          if (region.spans_period(d) && site[d] >= box.upper[d]) site[d] -= box.upper[d] - box.lower[d];
        if (region.holds(site, radius) && !placed.blocked(site, radius)) sites.push_back(site);
      }
  return sites;
}

}  // namespace silt
