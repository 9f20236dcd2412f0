#include "coupling/fluid_forces.hpp"

#include <fmt/format.h>

namespace silt {
namespace {

template <class Any>
bool chosen(const Any& any) {
  return any.index() != 0;  // the first of each list is none
}

}  // namespace

FluidForces::FluidForces(const Mesh& mesh, const std::vector<double>& mass, Options& options, bool viscous_stress)
    : mesh_(mesh),
      saffman_(SaffmanModels::read(options, "saffman", "none", "lift by shear")),
      magnus_(MagnusModels::read(options, "magnus", "none", "lift by spin")),
      torque_(ViscousTorqueModels::read(options, "viscous_torque", "none", "viscous torque on the spin")),
      viscous_stress_(viscous_stress),
      gradient_(mesh, mass) {
  options.read("virtual_mass", virtual_mass_);
  turns_ = chosen(torque_);
  spins_ = turns_ || chosen(magnus_);
  if (chosen(saffman_) || spins_) curl_ = width_, width_ += 3;
  if (virtual_mass_.coefficient > 0) rate_ = width_, width_ += 3;
  if (viscous_stress_) stress_ = width_, width_ += 3;
}

std::string FluidForces::description() const {
  std::string text;
  const auto add = [&](const char* what, const auto& any) {
    if (chosen(any))
      text += fmt::format(", {} {}", what, std::visit([](const auto& m) { return std::string(m.name); }, any));
  };
  add("shear lift", saffman_);
  add("spin lift", magnus_);
  add("viscous torque", torque_);
  if (virtual_mass_.coefficient > 0) text += fmt::format(", virtual mass {:g}", virtual_mass_.coefficient);
  if (viscous_stress_) text += ", viscous stress";
  return text;
}

void FluidForces::make_fields(const Fluid& fluid, double last_step) {
  const auto u = fluid.velocity();
  const auto nodes = static_cast<std::size_t>(mesh_.nodes);
  gradient_.apply(u, 3, slope_);  // slope[i][component][direction]
  nodal_.resize(width_ * nodes);
  if (viscous_stress_) {
    const auto viscosity = fluid.properties().viscosity;
    std::vector<double> tau(9 * nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
      const double mu = viscosity.empty() ? fluid.viscosity() : viscosity[i];
      const double* g = &slope_[9 * i];
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) tau[9 * i + 3 * a + b] = mu * (g[3 * a + b] + g[3 * b + a]);
        if (fluid.total_energy()) tau[9 * i + 4 * a] -= mu * 2.0 / 3 * (g[0] + g[4] + g[8]);  // of a gas
      }
    }
    gradient_.apply(tau, 9, second_);
  }
  const auto change = fluid.velocity_change();
  for (std::size_t i = 0; i < nodes; ++i) {
    const double* g = &slope_[9 * i];
    double* f = &nodal_[width_ * i];
    if (curl_ >= 0) {
      f[curl_] = g[7] - g[5];
      f[curl_ + 1] = g[2] - g[6];
      f[curl_ + 2] = g[3] - g[1];
    }
    for (int d = 0; d < 3; ++d) {
      if (rate_ >= 0)
        f[rate_ + d] = (last_step > 0 ? change[3 * i + d] / last_step : 0) + u[3 * i] * g[3 * d] +
                       u[3 * i + 1] * g[3 * d + 1] + u[3 * i + 2] * g[3 * d + 2];
      if (stress_ >= 0)
        f[stress_ + d] = second_[27 * i + 9 * d] + second_[27 * i + 9 * d + 4] + second_[27 * i + 9 * d + 8];
    }
  }
}

void FluidForces::act(const Fluid& fluid, const FluidProperties& properties, const Filter& filter, const Kernel& kernel,
                      Particles& particles, double last_step) {
  make_fields(fluid, last_step);
  filter.apply(nodal_.data(), width_);
  const int count = particles.owned();
  at_particles_.resize(static_cast<std::size_t>(width_) * count);
  kernel.sample(nodal_, at_particles_, width_);
  std::visit(
      [&](const auto& saffman, const auto& magnus, const auto& torque) {
        for (int p = 0; p < count; ++p) {
          FluidAction& action = particles.fluid_action(p);
          const double* f = &at_particles_[static_cast<std::size_t>(width_) * p];
          const double density = properties.density(p);
          const ShearFlow flow{2 * particles.radius(p),
                               density,
                               properties.viscosity(p),
                               vec3(action.velocity) - particles.velocity(p),
                               curl_ >= 0 ? Vec3(vec3(f + curl_)) : Vec3::Zero(),
                               particles.spin(p)};
          Vec3 force = saffman.force(flow) + magnus.force(flow);
          const double volume = particles.volume(p);
          if (stress_ >= 0) force += volume * vec3(f + stress_);
          action.added_mass = virtual_mass_.coefficient * density * volume;
          if (rate_ >= 0) force += action.added_mass * vec3(f + rate_);
          vec3(action.reaction) += force;
          vec3(action.force) += force;
          if (turns_) {
            action.spin_exchange = torque.exchange(flow);
            vec3(action.spin) = 0.5 * flow.vorticity;
          }
        }
      },
      saffman_, magnus_, torque_);
}

}  // namespace silt
