#include "particles/insertion/insertion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.hpp"
#include "particles/insertion/dense_packing.hpp"
#include "particles/insertion/particle_file.hpp"
#include "particles/insertion/size_distribution.hpp"

namespace silt {
namespace {

constexpr int material_stream = 4;

/// Everything that one insertion needs of the others and of the mesh.
struct Site {
  const Room& room;
  const std::vector<std::string>& materials;
  Packing placed;
  std::vector<Seed> seeds;
  struct Origin {
    int insertion, line;  ///< line of a file, 0 for a fill or lattice
  };
  std::vector<Origin> origins;         ///< of every seed, for messages
  std::vector<std::string> sources{};  ///< of every insertion: file or option prefix

  std::string origin(int seed) const {
    const auto& [insertion, line] = origins[seed];
    return line ? fmt::format("{}:{}", sources[insertion], line)
                : fmt::format("-{} (particle {})", sources[insertion], seed);
  }
};

Region region_of(const InsertionOptions& options, const std::string& prefix, const Room& room) {
  const Surface& surface = room.surface();
  Box box;
  box.lower = options.lower.value_or(surface.lower);
  box.upper = options.upper.value_or(surface.upper);
  if (surface.dimension == 2 && options.cylinder != "none")
    throw UserError(fmt::format("option -{}_cylinder: a 2D mesh has no cylinders", prefix));
  for (int d = 0; d < surface.dimension; ++d)
    if (!(std::min(box.upper[d], surface.upper[d]) > std::max(box.lower[d], surface.lower[d])))
      throw UserError(
          fmt::format("-{}: the region from {:g} to {:g} in direction {} lies outside the mesh ({:g} to "
                      "{:g}) or is empty",
                      prefix, box.lower[d], box.upper[d], "xyz"[d], surface.lower[d], surface.upper[d]));
  return Region(room, box, options.cylinder == "none" ? "" : options.cylinder);
}

void add_spheres(const std::vector<PlacedSphere>& spheres, const InsertionOptions& options, const std::string& prefix,
                 Site& site) {
  const MaterialChoice choice(options, prefix, site.materials);
  RandomStream random(options.seed, material_stream);
  for (const auto& sphere : spheres) {
    site.origins.push_back({static_cast<int>(site.sources.size()) - 1, 0});
    site.seeds.push_back({sphere.centre, options.velocity, options.spin, sphere.radius, choice.draw(random)});
  }
}

void add_file(const InsertionOptions& options, const std::string& prefix, Site& site) {
  const auto particles = read_particle_file(prefix + "_file", options.file, site.materials);
  const MaterialChoice choice(options, prefix, site.materials);
  RandomStream random(options.seed, material_stream);
  for (const auto& particle : particles) {
    const std::string place = fmt::format("{}:{}", options.file, particle.line);
    const Vec3 centre = site.room.wrapped(particle.position);
    if (site.room.surface().dimension == 2 && centre[2] != 0)
      throw UserError(fmt::format("{}: z is {:g}; on a 2D mesh it must be 0", place, centre[2]));
    if (!site.room.inside(centre))
      throw UserError(fmt::format("{}: the particle at ({:g}, {:g}, {:g}) lies outside the mesh", place, centre[0],
                                  centre[1], centre[2]));
    const double into_wall =
        1 - std::min(site.room.wall_distance(centre, particle.radius), site.room.clearance(centre)) / particle.radius;
    if (into_wall > options.largest_overlap)
      throw UserError(
          fmt::format("{}: the particle overlaps a wall by {:.3g} of its radius; allowed is {:g} "
                      "(-{}_largest_overlap)",
                      place, into_wall, options.largest_overlap, prefix));
    const auto worst = site.placed.deepest(centre, particle.radius);
    if (worst.index >= 0 && worst.share > options.largest_overlap)
      throw UserError(
          fmt::format("{}: the particle overlaps that of {} by {:.3g} of the smaller radius; allowed is "
                      "{:g} (-{}_largest_overlap)",
                      place, site.origin(worst.index), worst.share, options.largest_overlap, prefix));
    site.placed.add(centre, particle.radius);
    site.origins.push_back({static_cast<int>(site.sources.size()) - 1, particle.line});
    site.seeds.push_back({centre, particle.velocity.value_or(options.velocity), particle.spin.value_or(options.spin),
                          particle.radius, particle.material < 0 ? choice.draw(random) : particle.material});
  }
}

}  // namespace

std::vector<Seed> make_insertions(const Walls& walls, Options& options, const std::vector<std::string>& materials,
                                  bool only_check) {
  const Surface& surface = walls.surface();
  std::vector<bool> is_wall;
  for (const auto& boundary : walls.boundaries()) is_wall.push_back(boundary.role == BoundaryRole::wall);
  Room room(surface, is_wall);
  if (!walls.rigid().empty()) room.add_walls([&walls](const Vec3& x) { return walls.clearance(x); });
  Vec3 period = Vec3::Zero();
  for (int d = 0; d < 3; ++d)
    if (surface.periodic[d]) period[d] = surface.upper[d] - surface.lower[d];
  Site site{room, materials, Packing(period), {}, {}};
  for (const auto& name : options.names("insertion", Options::declared<InsertionOptions>())) {
    const std::string prefix = "insertion_" + name;
    InsertionOptions chosen;
    options.read(prefix, chosen);
    const MaterialChoice known(chosen, prefix, materials);
    if (only_check || chosen.type == "stream") continue;
    site.sources.push_back(chosen.type == "file" ? chosen.file : prefix);
    if (chosen.type == "file") {
      add_file(chosen, prefix, site);
    } else {
      const Region region = region_of(chosen, prefix, room);
      add_spheres(chosen.type == "fill"   ? fill_region(chosen, prefix, region, site.placed)
                  : chosen.type == "pack" ? pack_region(chosen, prefix, region, site.placed)
                                          : lattice_region(chosen, prefix, region, site.placed),
                  chosen, prefix, site);
    }
  }
  return std::move(site.seeds);
}

}  // namespace silt
