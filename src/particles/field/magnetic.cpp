#include "particles/field/magnetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/physical_constants.hpp"
#include "particles/field/turned.hpp"
#include "particles/insertion/random.hpp"
#include "particles/particles.hpp"

namespace silt {
namespace {

constexpr double pi = std::numbers::pi;

double volume_of(double radius) { return 4.0 / 3.0 * pi * radius * radius * radius; }

std::string formulas(const MagneticOptions& options) {
  if (!options.field.empty()) return options.field;
  return options.flux_density.empty() ? "0, 0, 0" : options.flux_density;
}

}  // namespace

std::unique_ptr<Magnetic> Magnetic::create(Options& options, const Mesh& mesh, Columns& columns,
                                           const std::string& instructions) {
  const auto model = MagneticModels::read(options, "magnetic", "none", "magnetic moment of the particles");
  MagneticOptions chosen;
  options.read("magnetic", chosen);
  if (model.index() == 0) return nullptr;
  if (!chosen.field.empty() && !chosen.flux_density.empty())
    throw UserError("-magnetic_field and -magnetic_flux_density are both given: give one");
  return std::make_unique<Magnetic>(model, chosen, mesh, columns, instructions);
}

Magnetic::Magnetic(MagneticModels::Any model, const MagneticOptions& options, const Mesh& mesh, Columns& columns,
                   const std::string& instructions)
    : model_(std::move(model)),
      options_(options),
      follows_(std::visit([](const auto& m) { return m.follows(); }, model_)),
      field_(options.field.empty() ? "magnetic_flux_density" : "magnetic_field", formulas(options),
             (mesh.upper - mesh.lower).norm()),
      scale_(options.flux_density.empty() ? 1 : 1 / vacuum_permeability),
      range_(field_.range(mesh.lower, mesh.upper)),
      kernels_(choose_pair_kernels(instructions.c_str())) {
  const bool starts = follows_ == MomentFollows::body || follows_ == MomentFollows::nothing;
  ColumnRequest request{"magnetic_moment", 3, GhostValues::none, true, {}};
  if (starts)
    request.start = [this](const Seed& seed, double* row) {
      const double volume = volume_of(seed.radius);
      const double size = std::visit([&](const auto& m) { return m.largest(volume); }, model_);
      Vec3 direction = options_.direction;
      if (direction.norm() == 0) {
        // Uniform on the sphere, by the place of birth: the same on every rank.
        RandomStream random(options_.seed, std::bit_cast<std::uint64_t>(seed.position[0]) ^
                                               std::rotl(std::bit_cast<std::uint64_t>(seed.position[1]), 21) ^
                                               std::rotl(std::bit_cast<std::uint64_t>(seed.position[2]), 42));
        direction = {random.normal(), random.normal(), random.normal()};
      }
      vec3(row) = size * direction.normalized();
    };
  column_ = columns.add(request);
}

void Magnetic::apply(FieldStep& step, double* moment) const {
  std::visit(
      [&](const auto& model) {
        const bool uniform = field_.uniform();
        const Vec3 everywhere = uniform ? applied(Vec3::Zero(), step.time) : Vec3::Zero();
        for (int p = 0; p < step.store.owned; ++p) {
          const Motion& motion = step.store.motion[p];
          vec3(&moment[3 * p]) =
              model.moment(uniform ? everywhere : applied(vec3(motion.position), step.time), volume_of(motion.radius));
        }
      },
      model_);
}

void Magnetic::find_moments(FieldStep& step, double* moment) {
  const Store& store = step.store;
  const PairLoop loop{&sources_, nullptr, &neighbours_, step.periods, options_.cutoff};
  std::vector<Vec3> outside(store.owned);
  for (int p = 0; p < store.owned; ++p) outside[p] = applied(vec3(store.motion[p].position), step.time);
  for (int n = 0; n < options_.iterations; ++n) {
    neighbours_.clear(sources_.count);
    kernels_.dipoles(loop);
    double change = 0, largest = 0;
    std::visit(
        [&](const auto& model) {
          for (int p = 0; p < store.owned; ++p) {
            const int at = sources_.place[p];
            const Vec3 near = Vec3(neighbours_.x[at], neighbours_.y[at], neighbours_.z[at]) * (3 / (4 * pi));
            const Vec3 found = model.moment(outside[p] + near, volume_of(store.motion[p].radius));
            change = std::max(change, (found - vec3(&moment[3 * p])).norm());
            largest = std::max(largest, found.norm());
            vec3(&moment[3 * p]) = found;
          }
        },
        model_);
    double both[2] = {change, largest};
    MPI_Allreduce(MPI_IN_PLACE, both, 2, MPI_DOUBLE, MPI_MAX, step.communicator);
    sources_.gather_values(store, moment, 3, step.communicator);
    if (both[0] <= options_.tolerance * both[1]) return;
  }
  throw RunError(
      fmt::format("the magnetic moments did not agree with each other to {:g} in {} iterations (-magnetic_iterations, "
                  "-magnetic_tolerance): the particles magnetise each other too strongly",
                  options_.tolerance, options_.iterations));
}

void Magnetic::turn(Store& store, const double (*turned)[4]) {
  if (turns()) turn_vectors(store.columns.values(column_), turned, store.owned);
}

void Magnetic::act(FieldStep& step) {
  Store& store = step.store;
  double* moment = store.columns.values(column_);
  if (follows_ == MomentFollows::applied) apply(step, moment);
  sources_.gather(store, moment, 3, step.communicator);
  if (options_.cutoff > 0) sources_.sort(step.periods, options_.cutoff);
  if (follows_ == MomentFollows::local) find_moments(step, moment);
  const bool turns = follows_ == MomentFollows::body;
  force_.clear(sources_.count);
  if (turns) neighbours_.clear(sources_.count);
  kernels_.dipoles({&sources_, &force_, turns ? &neighbours_ : nullptr, step.periods, options_.cutoff});

  const double constant = 3 * vacuum_permeability / (4 * pi);
  const bool uniform = field_.uniform();
  const Vec3 everywhere = uniform && turns ? applied(Vec3::Zero(), step.time) : Vec3::Zero();
  for (int p = 0; p < store.owned; ++p) {
    const int at = sources_.place[p];
    const Vec3 mutual = constant * Vec3(force_.x[at], force_.y[at], force_.z[at]);
    const Vec3 m = vec3(&moment[3 * p]), x = vec3(store.motion[p].position);
    Load& load = store.present[p];
    vec3(load.force) += mutual;
    step.size += mutual.norm();
    if (!uniform) {
      const Vec3 drawn = vacuum_permeability * scale_ * field_.gradient(x, step.time).transpose() * m;
      vec3(load.force) += drawn;
      step.external += drawn;
    }
    if (turns) {
      const Vec3 near = Vec3(neighbours_.x[at], neighbours_.y[at], neighbours_.z[at]) * (3 / (4 * pi));
      vec3(load.torque) += vacuum_permeability * m.cross(near + (uniform ? everywhere : applied(x, step.time)));
    }
  }
}

std::vector<StepBound> Magnetic::bounds(const Materials& materials, const SmallestRadii& smallest) const {
  std::vector<StepBound> bounds;
  const double strongest = scale_ * range_.largest;
  if (range_.rate > 0) bounds.push_back({pi / range_.rate, fmt::format("change of the {} field", "magnetic")});
  for (int a = 0; a < materials.count(); ++a) {
    const double radius = smallest.radius[a];
    if (radius >= infinity) continue;
    const double volume = volume_of(radius), mass = *materials[a].density * volume;
    const double moment = std::visit(
        [&](const auto& m) { return std::max(m.largest(volume), m.moment(Vec3(strongest, 0, 0), volume).norm()); },
        model_);
    if (!(moment > 0)) continue;
    // Head to tail in contact: F = 3 mu0 m^2/(2 pi r^4), |dF/dr| = 4 F/r at r = d; half a period of the pair's mass.
    const double distance = 2 * radius;
    const double stiffness = 6 * vacuum_permeability * moment * moment / (pi * std::pow(distance, 5));
    bounds.push_back({pi * std::sqrt(0.5 * mass / stiffness),
                      fmt::format("magnetic attraction of {} in contact", materials[a].name)});
    if (follows_ != MomentFollows::body) continue;
    const double field = strongest + 2 * moment / (4 * pi * std::pow(distance, 3));
    const double inertia = 0.4 * mass * radius * radius;
    bounds.push_back({pi * std::sqrt(inertia / (vacuum_permeability * moment * field)),
                      fmt::format("magnetic swing of {}", materials[a].name)});
  }
  return bounds;
}

std::string Magnetic::description() const {
  const auto name = std::visit([](const auto& m) { return std::string(m.name); }, model_);
  return fmt::format("magnetic {}, {}", name,
                     options_.cutoff > 0 ? fmt::format("cut-off {:g} m", options_.cutoff) : "all pairs");
}

}  // namespace silt
