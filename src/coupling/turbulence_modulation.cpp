#include "coupling/turbulence_modulation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "coupling/exchange.hpp"
#include "fluid/turbulence/turbulence.hpp"

namespace silt {

std::unique_ptr<TurbulenceModulation> TurbulenceModulation::create(const Mesh& mesh, const std::vector<double>& mass,
                                                                   const Fluid& fluid, Options& options) {
  auto model = ModulationModels::read(options, "modulation", "none", "what particles do to the fluid's turbulence");
  if (std::holds_alternative<NoModulation>(model)) return nullptr;
  if (!fluid.turbulence() || fluid.turbulence()->energy().empty())
    throw UserError(
        "-modulation_type needs a fluid that solves for its turbulence (-fluid_turbulence realizable_k_epsilon or "
        "sst_k_omega)");
  return std::make_unique<TurbulenceModulation>(std::move(model), mesh, mass);
}

std::string TurbulenceModulation::name() const {
  return std::visit([](const auto& model) { return std::string(model.name); }, model_);
}

void TurbulenceModulation::before_fluid(double depth, const Filter& filter, const Kernel& kernel, Particles& particles,
                                        Fluid& fluid) {
  const auto energy = fluid.turbulent_energy(), dissipation = fluid.turbulent_dissipation();
  const std::size_t nodes = energy.size(), owned = static_cast<std::size_t>(particles.owned()),
                    all = static_cast<std::size_t>(kernel.count());
  nodal_.resize(2 * nodes);
  for (std::size_t i = 0; i < nodes; ++i) nodal_[2 * i] = energy[i], nodal_[2 * i + 1] = dissipation[i];
  filter.apply(nodal_.data(), 2);
  at_particles_.resize(2 * all);
  kernel.sample(nodal_, at_particles_, 2);
  work_.assign(all, 0.0);  // those that left take nothing with them
  double sums[3] = {0, 0, 0};
  std::visit(
      [&](const auto& model) {
        if constexpr (requires { model.dissipation_factor; }) {
          fluid.load().dissipation_factor = model.dissipation_factor;
          for (std::size_t p = 0; p < owned; ++p) {
            const int i = static_cast<int>(p);
            const FluidAction& action = particles.fluid_action(i);
            const double slip = (vec3(action.velocity) - particles.velocity(i)).norm();
            work_[p] = model.work({at_particles_[2 * p], at_particles_[2 * p + 1], action.exchange, particles.mass(i),
                                   slip, action.held});
            sums[0] += work_[p];
            sums[2] += std::abs(work_[p]);
          }
        }
      },
      model_);
  nodal_.resize(nodes);
  kernel.deposit(work_, nodal_, 1);
  for (std::size_t i = 0; i < nodes; ++i) nodal_[i] /= mass_[i] * depth;
  filter.apply(nodal_.data(), 1);
  auto& load = fluid.load().turbulence;
  for (std::size_t i = 0; i < nodes; ++i) load[i] = mass_[i] * nodal_[i];
  for (int i = 0; i < mesh_.owned_nodes; ++i) sums[1] += depth * load[static_cast<std::size_t>(i)];
  MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  given_ = sums[0], received_ = sums[1];
  if (!(std::abs(given_ - received_) <= exchange_tolerance * sums[2]))
    throw RunError(fmt::format("what particles add to the fluid's turbulence, {:.6g} W, is not what it gets, {:.6g} W",
                               given_, received_));
}

}  // namespace silt
