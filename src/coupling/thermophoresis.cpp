#include "coupling/thermophoresis.hpp"

#include "base/error.hpp"

namespace silt {

std::unique_ptr<Thermophoresis> Thermophoresis::create(const Mesh& mesh, const std::vector<double>& mass,
                                                       const Fluid& fluid, Options& options) {
  auto law =
      ThermophoresisModels::read(options, "thermophoresis", "none", "force by a temperature gradient of the gas");
  ThermophoresisOptions chosen;
  options.read("thermophoresis", chosen);
  if (law.index() == 0) return nullptr;
  if (fluid.temperature().empty())
    throw UserError(
        "-thermophoresis_type needs a fluid with a temperature: -fluid_energy yes, or -fluid_temperature of "
        "a prescribed fluid");
  return std::make_unique<Thermophoresis>(mesh, mass, std::move(law), chosen);
}

Thermophoresis::Thermophoresis(const Mesh& mesh, const std::vector<double>& mass, ThermophoresisModels::Any law,
                               const ThermophoresisOptions& options)
    : mesh_(mesh), law_(std::move(law)), options_(options), gradient_(mesh, mass) {}

std::string Thermophoresis::name() const {
  return std::visit([](const auto& law) { return std::string(law.name); }, law_);
}

void Thermophoresis::act(const Fluid& fluid, const FluidProperties& properties, const Filter& filter,
                         const Kernel& kernel, Particles& particles) {
  const auto temperature = fluid.temperature();
  gradient_.apply(temperature, 1, slope_);
  nodal_.resize(4 * static_cast<std::size_t>(mesh_.nodes));
  for (std::size_t i = 0; i < temperature.size(); ++i) {
    nodal_[4 * i] = temperature[i];
    for (int d = 0; d < 3; ++d) nodal_[4 * i + 1 + d] = slope_[3 * i + d];
  }
  filter.apply(nodal_.data(), 4);
  const int count = particles.owned();
  at_particles_.resize(4 * static_cast<std::size_t>(count));
  kernel.sample(nodal_, at_particles_, 4);
  bool cold = false;
  std::visit(
      [&](const auto& law) {
        for (int p = 0; p < count; ++p) {
          const double* f = &at_particles_[4 * static_cast<std::size_t>(p)];
          cold |= !(f[0] > 0);
          const GasAround gas{2 * particles.radius(p),
                              properties.density(p),
                              properties.viscosity(p),
                              f[0],
                              options_.mean_free_path,
                              options_.conductivity_ratio,
                              options_.molar_mass / avogadro_constant};
          const Vec3 force = -law.factor(gas) * vec3(f + 1);
          FluidAction& action = particles.fluid_action(p);
          vec3(action.force) += force;
          vec3(action.reaction) += force;
        }
      },
      law_);
  if (mpi_any(cold)) throw RunError("thermophoresis needs absolute temperatures above 0 K in the fluid");
}

}  // namespace silt
