#include "particles/insertion/dense_packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "particles/insertion/random.hpp"

namespace silt {
namespace {

constexpr int positions = 3;     // stream of random numbers, as in fill.cpp
constexpr double margin = 2e-4;  // spheres are pushed this much further apart than they must be, of their radius
constexpr int most_passes = 30000;

/// Spheres in a region that relax until none overlap.
class Relaxation {
 public:
  Relaxation(const Region& region, const std::vector<double>& radii, std::uint64_t seed)
      : region_(region), radii_(radii), dimension_(region.dimension()), x_(radii.size()), move_(radii.size()) {
    RandomStream random(seed, positions);
    whole_ = region.centres(0);
    largest_ = *std::max_element(radii.begin(), radii.end());
    smallest_ = *std::min_element(radii.begin(), radii.end());
    for (std::size_t i = 0; i < x_.size(); ++i) {
      x_[i].setZero();
      for (int d = 0; d < dimension_; ++d) x_[i][d] = random.uniform(whole_.lower[d], whole_.upper[d]);
      x_[i] = region_.clamped(x_[i], radii_[i]);
    }
    momentum_.assign(x_.size(), Vec3::Zero());
    for (int d = 0; d < 3; ++d)
      period_[d] = d < dimension_ && region.spans_period(d) ? whole_.upper[d] - whole_.lower[d] : 0;
  }

  /// Whether it got to where nothing overlaps.
  bool run() {
    double gone = infinity;  // way since the lists were made
    for (int pass = 0; pass < most_passes; ++pass) {
      if (gone > 0.5 * skin()) {
        list();
        gone = 0;
      }
      double furthest = 0;
      if (push() <= 0) return true;
      for (std::size_t i = 0; i < x_.size(); ++i) {
        Vec3 step = 0.25 * move_[i] + 0.7 * momentum_[i];
        if (const double length = step.norm(), most = 0.2 * smallest_; length > most) step *= most / length;
        const Vec3 to = region_.clamped(x_[i] + step, radii_[i]);
        momentum_[i] = nearest_image(to - x_[i]);
        furthest = std::max(furthest, momentum_[i].norm());
        x_[i] = to;
      }
      gone += 2 * furthest;
    }
    return false;
  }
  const std::vector<Vec3>& centres() const { return x_; }

 private:
  double skin() const { return 0.3 * smallest_; }

  Vec3 nearest_image(Vec3 r) const {
    for (int d = 0; d < 3; ++d)
      if (period_[d] > 0) r[d] -= period_[d] * std::nearbyint(r[d] / period_[d]);
    return r;
  }
  Vec3 apart(std::size_t i, std::size_t j) const { return nearest_image(x_[i] - x_[j]); }

  /// Pairs that may touch before anything has moved by half a skin.
  void list() {
    std::array<int, 3> n{1, 1, 1};
    Vec3 width = Vec3::Ones();
    for (int d = 0; d < dimension_; ++d) {
      const double length = whole_.upper[d] - whole_.lower[d];
      n[d] = std::max(1, std::min(1000, static_cast<int>(length / (2 * largest_ * (1 + margin) + skin()))));
      width[d] = length / n[d];
    }
    const auto cell = [&](const Vec3& x) {
      std::array<int, 3> c{0, 0, 0};
      for (int d = 0; d < dimension_; ++d) {
        c[d] = static_cast<int>(std::floor((x[d] - whole_.lower[d]) / width[d]));
        c[d] = period_[d] > 0 ? ((c[d] % n[d]) + n[d]) % n[d] : std::clamp(c[d], 0, n[d] - 1);
      }
      return c;
    };
    std::vector<int> head(static_cast<std::size_t>(n[0]) * n[1] * n[2], -1), next(x_.size(), -1);
    const auto index = [&](int a, int b, int c) { return (static_cast<std::size_t>(c) * n[1] + b) * n[0] + a; };
    first_.assign(1, 0);
    partner_.clear();
    // Each sphere looks at those that came before it.
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const auto at = cell(x_[i]);
      seen_.clear();
      for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
          for (int a = -1; a <= 1; ++a) {
            std::array<int, 3> c{at[0] + a, at[1] + j, at[2] + k};
            bool there = true;
            for (int d = 0; d < 3; ++d) {
              if (period_[d] > 0) c[d] = (c[d] + n[d]) % n[d];
              there = there && c[d] >= 0 && c[d] < n[d];
            }
            if (!there) continue;
            const std::size_t bin = index(c[0], c[1], c[2]);
            if (std::find(seen_.begin(), seen_.end(), bin) != seen_.end()) continue;
            seen_.push_back(bin);
            for (int other = head[bin]; other >= 0; other = next[other]) {
              const double reach = (radii_[i] + radii_[other]) * (1 + margin) + skin();
              if (apart(i, other).squaredNorm() < reach * reach) partner_.push_back(other);
            }
          }
      first_.push_back(partner_.size());
      int& top = head[index(at[0], at[1], at[2])];
      next[i] = top;
      top = static_cast<int>(i);
    }
  }

  /// Sums up by how much each sphere is pushed; returns the deepest true overlap (m), negative when there is none.
  double push() {
    std::fill(move_.begin(), move_.end(), Vec3::Zero());
    double deepest = -infinity;
    for (std::size_t i = 0; i < x_.size(); ++i)
      for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) {
        const int j = partner_[k];
        const double touch = radii_[i] + radii_[j], wanted = touch * (1 + margin);
        const Vec3 r = apart(i, j);
        const double square = r.squaredNorm();
        if (square >= wanted * wanted) continue;
        const double distance = std::sqrt(square);
        deepest = std::max(deepest, touch - distance);
        const Vec3 n = distance > 0 ? Vec3(r / distance) : Vec3::UnitX();
        move_[i] += (wanted - distance) * n;
        move_[j] -= (wanted - distance) * n;
      }
    return deepest;
  }

  const Region& region_;
  const std::vector<double>& radii_;
  int dimension_;
  Box whole_;
  double largest_ = 0, smallest_ = 0;
  std::vector<Vec3> x_, move_, momentum_;
  double period_[3] = {0, 0, 0};
  std::vector<std::size_t> first_, seen_;
  std::vector<int> partner_;
};

}  // namespace

std::vector<PlacedSphere> pack_region(const InsertionOptions& options, const std::string& prefix, const Region& region,
                                      Packing& placed) {
  const auto radii = drawn_radii(options, prefix, region);
  if (radii.empty()) return {};
  double solids = 0;
  for (const double radius : radii) solids += space_of(radius, region.dimension()) / region.volume();
  const Box box = region.centres(radii[0]);
  const bool small = (box.upper.array() < box.lower.array()).any();
  Relaxation relaxation(region, radii, options.seed);
  if (small || solids > 0.9 || !relaxation.run())
    throw UserError(fmt::format(
        "-{}: {} particles, {:.3g} of the region, do not pack at random without overlaps; about 0.62 is the "
        "densest, less between near walls",
        prefix, radii.size(), solids));
  std::vector<PlacedSphere> result;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const Vec3& centre = relaxation.centres()[i];
    if (!region.holds(centre, radii[i]) || placed.blocked(centre, radii[i]))
      throw UserError(
          fmt::format("-{}: a pack needs a region without walls and other particles in it; there is one near "
                      "({:g}, {:g}, {:g}) m",
                      prefix, centre[0], centre[1], centre[2]));
    result.push_back({centre, radii[i]});
  }
  for (const auto& sphere : result) placed.add(sphere.centre, sphere.radius);
  return result;
}

}  // namespace silt
