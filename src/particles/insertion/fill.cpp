#include "particles/insertion/fill.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "particles/insertion/dense_packing.hpp"
#include "particles/insertion/lattice.hpp"
#include "particles/insertion/random.hpp"
#include "particles/insertion/size_distribution.hpp"

namespace silt {
namespace {

enum Stream { sizes = 0, choice = 1, displacement = 2, position = 3 };

double total_space(const std::vector<double>& radii, int dimension) {
  double sum = 0;
  for (double radius : radii) sum += space_of(radius, dimension);
  return sum;
}

/// Random sequential addition; nothing when a sphere finds no place in reasonable time.
std::vector<PlacedSphere> add_at_random(const std::vector<double>& radii, const InsertionOptions& options,
                                        const Region& region, const Packing& before) {
  constexpr int most_attempts = 20000;
  Packing placed = before;
  std::vector<PlacedSphere> result;
  RandomStream random(options.seed, position);
  for (double radius : radii) {
    const Box box = region.centres(radius);
    if ((box.upper.array() < box.lower.array()).any()) return {};
    bool found = false;
    for (int attempt = 0; attempt < most_attempts && !found; ++attempt) {
      Vec3 centre = Vec3::Zero();
      for (int d = 0; d < region.dimension(); ++d) centre[d] = random.uniform(box.lower[d], box.upper[d]);
      found = !placed.blocked(centre, radius) && region.holds(centre, radius);
      if (found) {
        placed.add(centre, radius);
        result.push_back({centre, radius});
      }
    }
    if (!found) return {};
  }
  return result;
}

/// Moves a site at random within a ball of radius `amplitude`, unless that leads out of the region.
Vec3 displaced(const Vec3& site, double amplitude, double radius, const Region& region, const Packing& before,
               RandomStream& random) {
  Vec3 off;
  do {
    for (int d = 0; d < 3; ++d) off[d] = d < region.dimension() ? random.uniform(-1, 1) : 0;
  } while (off.squaredNorm() > 1);
  const Vec3 moved = site + amplitude * off;
  return region.holds(moved, radius) && !before.blocked(moved, radius) ? moved : site;
}

/// A random choice among lattice sites; says in `fit` how many there are at most when they are too few.
std::vector<PlacedSphere> choose_sites(const std::vector<double>& radii, const InsertionOptions& options,
                                       const Region& region, const Packing& before, size_t& fit) {
  const double radius = radii[0], closest = 2 * radius;
  const int dimension = region.dimension();
  const double per_particle = region.volume() / static_cast<double>(radii.size());
  fit = 0;
  for (LatticeKind kind : {LatticeKind::cubic, LatticeKind::hexagonal}) {
    const double dense = kind == LatticeKind::cubic ? 1 : dimension == 2 ? 2 / std::sqrt(3.0) : std::sqrt(2.0);
    double spacing = std::max(closest, 1.1 * std::pow(dense * per_particle, 1.0 / dimension));
    std::vector<Vec3> sites = lattice_sites(kind, closest, true, region, radius, before);
    fit = std::max(fit, sites.size());
    if (sites.size() < radii.size()) continue;
    for (; spacing > closest; spacing *= 0.98) {
      auto wider = lattice_sites(kind, spacing, true, region, radius, before);
      if (wider.size() < radii.size()) continue;
      sites = std::move(wider);
      break;
    }
    const double gap = std::max(spacing, closest) - 2 * radius;
    RandomStream random(options.seed, choice), shake(options.seed, displacement);
    std::vector<PlacedSphere> result;
    for (size_t k = 0; k < radii.size(); ++k) {  // the first steps of a random permutation
      std::swap(sites[k], sites[k + random.below(sites.size() - k)]);
      result.push_back(
          {displaced(sites[k], 0.5 * options.jitter.value_or(0.9) * gap, radii[k], region, before, shake), radii[k]});
    }
    return result;
  }
  return {};
}

void add_all(const std::vector<PlacedSphere>& spheres, Packing& placed) {
  for (const auto& sphere : spheres) placed.add(sphere.centre, sphere.radius);
}

}  // namespace

std::vector<double> drawn_radii(const InsertionOptions& options, const std::string& prefix, const Region& region) {
  const SizeDistribution distribution(options, prefix);
  if ((options.count > 0) == options.solids_fraction.has_value())
    throw UserError(fmt::format("-{0}: give either -{0}_count or -{0}_solids_fraction", prefix));
  RandomStream random(options.seed, sizes);
  std::vector<double> radii;
  if (options.count > 0) {
    for (int k = 0; k < options.count; ++k) radii.push_back(distribution.radius(random));
  } else {
    const double wanted = *options.solids_fraction * region.volume();
    double volume = 0;
    if (wanted > 2e9 * space_of(distribution.largest_radius(), region.dimension()))
      throw UserError(fmt::format("option -{}_solids_fraction: {:g} of the region are more than 2e9 particles", prefix,
                                  *options.solids_fraction));
    for (;;) {
      const double radius = distribution.radius(random), space = space_of(radius, region.dimension());
      // The last particle counts when that is nearer to the wanted volume.
      if (volume + 0.5 * space > wanted) break;
      volume += space;
      radii.push_back(radius);
    }
  }
  std::sort(radii.begin(), radii.end(), std::greater<>());
  return radii;
}

std::vector<PlacedSphere> fill_region(const InsertionOptions& options, const std::string& prefix, const Region& region,
                                      Packing& placed) {
  // Random sequential addition jams at 38 % (3D) and 55 % (2D) and gets slow well before.
  const double slow = region.dimension() == 2 ? 0.4 : 0.25;
  const auto radii = drawn_radii(options, prefix, region);
  if (radii.empty()) return {};
  std::vector<PlacedSphere> result;
  if (total_space(radii, region.dimension()) < slow * region.volume())
    result = add_at_random(radii, options, region, placed);
  if (result.empty()) {
    size_t fit = 0;
    result = choose_sites(radii, options, region, placed, fit);
    if (result.empty())
      throw UserError(fmt::format(
          "-{}: {} particles of diameter {:g} m do not fit into the region of {:g} {}; about "
          "{} do (without overlaps; enlarge -{}_upper, they settle afterwards)",
          prefix, radii.size(), 2 * radii[0], region.volume(), region.dimension() == 2 ? "m2" : "m3", fit, prefix));
  }
  add_all(result, placed);
  return result;
}

std::vector<PlacedSphere> lattice_region(const InsertionOptions& options, const std::string& prefix,
                                         const Region& region, Packing& placed) {
  if (!options.diameter) throw UserError(fmt::format("option -{}_diameter is missing", prefix));
  if (options.solids_fraction || options.diameter_distribution != "mono")
    throw UserError(
        fmt::format("-{0}: a lattice takes one -{0}_diameter, a -{0}_spacing and possibly a -{0}_count", prefix));
  const double radius = 0.5 * *options.diameter, spacing = options.spacing.value_or(*options.diameter);
  if (spacing < 2 * radius)
    throw UserError(
        fmt::format("option -{}_spacing: {:g} m is less than the diameter {:g} m", prefix, spacing, 2 * radius));
  auto sites = lattice_sites(LatticeKind::cubic, spacing, false, region, radius, placed);
  if (options.count > 0) {
    if (sites.size() < static_cast<size_t>(options.count))
      throw UserError(fmt::format("option -{}_count: the lattice has {} sites in the region, {} are wanted", prefix,
                                  sites.size(), options.count));
    sites.resize(options.count);
  }
  RandomStream shake(options.seed, displacement);
  std::vector<PlacedSphere> result;
  for (const Vec3& site : sites)
    result.push_back(
        {displaced(site, 0.5 * options.jitter.value_or(0) * (spacing - 2 * radius), radius, region, placed, shake),
         radius});
  add_all(result, placed);
  return result;
}

}  // namespace silt
