#include "coupling/dispersion.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/philox.hpp"

namespace silt {
namespace {

enum EddyRow { left = 3, count = 4 };  // after u'

constexpr std::uint32_t stream = 0x45646479;  // apart from the other users of Philox

}  // namespace

std::unique_ptr<Dispersion> Dispersion::create(const Fluid& fluid, Particles& particles, Options& options) {
  const auto model = DispersionModels::read(options, "dispersion", "none", "turbulent dispersion of particles");
  const auto* walk = std::get_if<RandomWalkDispersion>(&model);
  if (!walk) return nullptr;
  if (fluid.turbulent_energy().empty() || fluid.turbulent_dissipation().empty())
    throw UserError(
        "-dispersion_type random_walk needs a fluid with k and epsilon: a two-equation -fluid_turbulence, or "
        "-fluid_turbulent_energy and -fluid_turbulent_dissipation of a prescribed fluid");
  return std::make_unique<Dispersion>(*walk, particles);
}

Dispersion::Dispersion(RandomWalkDispersion model, Particles& particles)
    : model_(model), column_(particles.columns().add({"eddy", 5, GhostValues::none, false, {}}, particles.owned())) {}

std::array<double, 4> Dispersion::deviates(std::int64_t id, double eddy) const {
  const auto who = static_cast<std::uint64_t>(id), which = static_cast<std::uint64_t>(eddy);
  return normal_deviates(philox({static_cast<std::uint32_t>(who), static_cast<std::uint32_t>(who >> 32),
                                 static_cast<std::uint32_t>(which), static_cast<std::uint32_t>(which >> 32)},
                                {static_cast<std::uint32_t>(model_.seed), stream}));
}

Vec3 Dispersion::mean_fluctuation(std::int64_t id, const TurbulenceAround& flow, double response, double slip,
                                  double dt, double* row) const {
  if (!(flow.energy > 0 && flow.dissipation > 0)) {
    std::fill_n(row, 4, 0.0);
    return Vec3::Zero();
  }
  const double size = std::sqrt(2.0 / 3.0 * flow.energy);
  const double life = std::min(model_.eddy_life(flow), model_.eddy_crossing(flow, response, slip));
  const auto meet = [&] {
    const auto xi = deviates(id, row[count]);
    row[count] += 1;
    return Vec3(size * Vec3(xi[0], xi[1], xi[2]));
  };
  if (life < 1e-2 * dt) {  // the mean of many eddies
    row[left] = 0;
    return std::sqrt(life / dt) * meet();
  }
  Vec3 sum = Vec3::Zero();
  for (double rest = dt; rest > 0;) {
    if (!(row[left] > 0)) {
      vec3(row) = meet();
      row[left] = life;
    }
    const double time = std::min(rest, row[left]);
    sum += time * vec3(row);
    row[left] -= time;
    rest -= time;
  }
  return sum / dt;
}

void Dispersion::act(const Fluid& fluid, const Filter& filter, const Kernel& kernel, Particles& particles, double dt,
                     std::span<double> velocity) {
  const auto energy = fluid.turbulent_energy(), dissipation = fluid.turbulent_dissipation();
  nodal_.resize(2 * energy.size());
  for (std::size_t i = 0; i < energy.size(); ++i) nodal_[2 * i] = energy[i], nodal_[2 * i + 1] = dissipation[i];
  filter.apply(nodal_.data(), 2);
  const int owned = particles.owned();
  at_particles_.resize(2 * static_cast<std::size_t>(owned));
  kernel.sample(nodal_, at_particles_, 2);
  for (int p = 0; p < owned; ++p) {
    const TurbulenceAround flow{at_particles_[2 * static_cast<std::size_t>(p)],
                                at_particles_[2 * static_cast<std::size_t>(p) + 1]};
    double* row = particles.columns().row(column_, p);
    auto u = vec3(&velocity[3 * static_cast<std::size_t>(p)]);
    // The drag of the step before; none yet in the first step, when particles count as if they followed.
    const double exchange = particles.fluid_action(p).exchange;
    const double response = exchange > 0 ? particles.mass(p) / exchange : 0;
    const double slip = (u + Vec3(vec3(row)) - particles.velocity(p)).norm();
    u += mean_fluctuation(particles.id(p), flow, response, slip, dt, row);
  }
}

}  // namespace silt
