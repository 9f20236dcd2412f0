#include "particles/insertion/streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "particles/materials.hpp"

namespace silt {
namespace {

constexpr int most_attempts = 500;  // for a place; then the particle waits

std::vector<bool> which_are_walls(const Walls& walls) {
  std::vector<bool> result;
  for (const auto& boundary : walls.boundaries()) result.push_back(boundary.role == BoundaryRole::wall);
  return result;
}

}  // namespace

void RemovalOptions::options(OptionGroup& option) {
  option("lower", lower, "m", "lowest corner of the box in which particles are taken out of the run");
  option("upper", upper, "m", "highest corner of the box");
  option("start", start, "s", "time from which particles are taken out", non_negative);
  option("end", end, "s", "time until which particles are taken out", non_negative);
}

struct Streams::Source {
  InsertionOptions options;
  SizeDistribution sizes;
  MaterialChoice materials;
  Box box;
  bool disc = false;
  Vec3 normal = Vec3::UnitZ();

  /// A place at random for a sphere; in directions in which the region is thinner than it, its centre lies within.
  Vec3 place(double radius, int dimension, RandomStream& random) const {
    Vec3 x = Vec3::Zero();
    if (disc) {
      const Vec3 a = normal.unitOrthogonal(), b = normal.cross(a);
      const double out = (options.radius - radius) * std::sqrt(random.uniform());
      const double angle = 2 * std::numbers::pi * random.uniform();
      return *options.centre + out * (std::cos(angle) * a + std::sin(angle) * b);
    }
    for (int d = 0; d < dimension; ++d) {
      const double off = box.upper[d] - box.lower[d] > 2 * radius ? radius : 0;
      x[d] = random.uniform(box.lower[d] + off, box.upper[d] - off);
    }
    return x;
  }

  /// Until when the batch that belongs to a step reaches; before start: nothing.
  double until(double time, double dt) const {
    double last = time + dt;
    if (options.interval > 0)
      last = options.start +
             options.interval * std::floor((time + dt - options.start) / options.interval * (1 + 1e-12) + 1e-9);
    return std::min(last, options.end);
  }
};

Streams::Streams(const Walls& walls, Options& options, const Materials& materials,
                 const std::vector<std::string>& names)
    : materials_(materials) {
  const Surface& surface = walls.surface();
  for (int d = 0; d < 3; ++d)
    if (surface.periodic[d]) period_[d] = surface.upper[d] - surface.lower[d];
  for (const auto& name : options.names("insertion", Options::declared<InsertionOptions>())) {
    const std::string prefix = "insertion_" + name;
    InsertionOptions chosen;
    options.read(prefix, chosen);
    const bool rates = chosen.mass_rate > 0 || chosen.number_rate > 0;
    if (chosen.type != "stream") {
      if (rates) throw UserError(fmt::format("-{0}: a rate goes with -{0}_type stream", prefix));
      continue;
    }
    if ((chosen.mass_rate > 0) == (chosen.number_rate > 0))
      throw UserError(fmt::format("-{0}: a stream needs either -{0}_mass_rate or -{0}_number_rate", prefix));
    if (chosen.solids_fraction || !chosen.file.empty() || chosen.cylinder != "none")
      throw UserError(fmt::format("-{}: a stream has no solids_fraction, file or cylinder", prefix));
    Source source{chosen, SizeDistribution(chosen, prefix), MaterialChoice(chosen, prefix, names), {}};
    const int disc = chosen.centre.has_value() + chosen.normal.has_value() + (chosen.radius > 0);
    if (disc != 0 && disc != 3)
      throw UserError(fmt::format("-{0}: a disc needs all of -{0}_centre, -{0}_normal and -{0}_radius", prefix));
    source.disc = disc == 3;
    if (source.disc) {
      if (surface.dimension == 2) throw UserError(fmt::format("-{}: a 2D mesh has no discs", prefix));
      if (chosen.normal->norm() == 0) throw UserError(fmt::format("option -{}_normal: it has no direction", prefix));
      source.normal = chosen.normal->normalized();
      if (chosen.radius < source.sizes.largest_radius())
        throw UserError(fmt::format("option -{}_radius: {:g} m is less than that of a particle, {:g} m", prefix,
                                    chosen.radius, source.sizes.largest_radius()));
      source.box.add(*chosen.centre);
      source.box.grow(chosen.radius);
    } else {
      source.box.lower = chosen.lower.value_or(surface.lower);
      source.box.upper = chosen.upper.value_or(surface.upper);
      if (surface.dimension == 2) source.box.lower[2] = source.box.upper[2] = 0;
    }
    for (int d = 0; d < surface.dimension; ++d)
      if (source.box.upper[d] < source.box.lower[d] || source.box.lower[d] > surface.upper[d] ||
          source.box.upper[d] < surface.lower[d])
        throw UserError(
            fmt::format("-{}: the region from {:g} to {:g} m in direction {} lies outside the mesh or is empty", prefix,
                        source.box.lower[d], source.box.upper[d], "xyz"[d]));
    sources_.push_back(std::move(source));
  }
  states_.resize(sources_.size());
  for (const auto& name : options.names("removal", Options::declared<RemovalOptions>())) {
    RemovalOptions& removal = removals_.emplace_back();
    options.read("removal_" + name, removal);
    if (!removal.lower || !removal.upper || (removal.upper->array() < removal.lower->array()).any())
      throw UserError(fmt::format("-removal_{0}: give -removal_{0}_lower and -removal_{0}_upper above it", name));
  }
  if (sources_.empty()) return;
  room_ = std::make_unique<Room>(surface, which_are_walls(walls));
  if (!walls.rigid().empty()) room_->add_walls([&walls](const Vec3& x) { return walls.clearance(x); });
}

Streams::~Streams() = default;

std::vector<int> Streams::materials() const {
  std::vector<int> result;
  for (const Source& source : sources_)
    result.insert(result.end(), source.materials.all().begin(), source.materials.all().end());
  return result;
}

bool Streams::due(int s, double time, double dt) const {
  const Source& source = sources_[s];
  const StreamState& state = states_[s];
  if (source.options.count > 0 && state.added >= source.options.count) return false;
  if (source.options.mass > 0 && state.mass >= source.options.mass) return false;
  const double elapsed = source.until(time, dt) - source.options.start;
  if (elapsed <= 0) return false;
  return source.options.number_rate > 0 ? state.added + 1 <= source.options.number_rate * elapsed * (1 + 1e-12)
                                        : state.mass < source.options.mass_rate * elapsed;
}

Box Streams::region(int s) const {
  Box box = sources_[s].box;
  box.grow(sources_[s].sizes.largest_radius());
  return box;
}

std::vector<Seed> Streams::add(int s, double time, double dt, const std::vector<PlacedSphere>& near) {
  const Source& source = sources_[s];
  const InsertionOptions& options = source.options;
  StreamState& state = states_[s];
  const double elapsed = source.until(time, dt) - options.start;
  Packing placed(period_);
  for (const auto& sphere : near) placed.add(sphere.centre, sphere.radius);
  RandomStream random[4] = {{static_cast<std::uint64_t>(options.seed), 10},
                            {static_cast<std::uint64_t>(options.seed), 11},
                            {static_cast<std::uint64_t>(options.seed), 12},
                            {static_cast<std::uint64_t>(options.seed), 13}};
  for (int k = 0; k < 4; ++k) random[k].go_on_after(static_cast<std::uint64_t>(state.drawn[k]));
  std::vector<Seed> seeds;
  const int dimension = room_->surface().dimension;
  while (options.count == 0 || state.added < options.count) {
    if (state.radius == 0) {
      state.radius = source.sizes.radius(random[0]);
      state.material = source.materials.draw(random[1]);
    }
    const double mass = *materials_[static_cast<int>(state.material)].density * space_of(state.radius, 3);
    const bool wanted = options.number_rate > 0 ? state.added + 1 <= options.number_rate * elapsed * (1 + 1e-12)
                                                : state.mass + 0.5 * mass <= options.mass_rate * elapsed;
    if (!wanted || (options.mass > 0 && state.mass + 0.5 * mass > options.mass)) break;
    bool found = false;
    Vec3 x;
    for (int attempt = 0; attempt < most_attempts && !found; ++attempt) {
      x = source.place(state.radius, dimension, random[2]);
      found = !placed.blocked(x, state.radius) && room_->holds(x, state.radius);
    }
    if (!found) break;
    Seed seed;
    seed.position = x;
    seed.velocity = options.velocity;
    for (int d = 0; d < dimension; ++d) seed.velocity[d] += options.velocity_scatter * random[3].normal();
    seed.spin = options.spin;
    seed.radius = state.radius;
    seed.material = static_cast<int>(state.material);
    placed.add(x, state.radius);
    seeds.push_back(seed);
    state.added += 1;
    state.mass += mass;
    state.radius = 0;
  }
  for (int k = 0; k < 4; ++k) state.drawn[k] = static_cast<double>(random[k].drawn());
  return seeds;
}

bool Streams::removed(const Vec3& x, double time) const {
  for (const auto& removal : removals_)
    if (time >= removal.start && time < removal.end && (x.array() >= removal.lower->array()).all() &&
        (x.array() <= removal.upper->array()).all())
      return true;
  return false;
}

}  // namespace silt
