#include "coupling/heat/heat_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.hpp"
#include "coupling/exchange.hpp"

namespace silt {

HeatExchange::HeatExchange(const Mesh& mesh, const std::vector<double>& mass, Particles& particles, Fluid& fluid,
                           Options& options)
    : mesh_(mesh),
      mass_(mass),
      particles_(particles),
      fluid_(fluid),
      nusselt_(NusseltModels::read(options, "nusselt", "ranz_marshall", "heat transfer between fluid and particles")) {
  const Columns& columns = particles.columns();
  temperature_ = columns.find("temperature");
  outside_ = columns.find("fluid_temperature");
  exchange_ = columns.find("heat_exchange");
  received_ = columns.find("heat_received");
}

std::string HeatExchange::name() const {
  return std::visit([](const auto& law) { return std::string(law.name); }, nusselt_);
}

void HeatExchange::before_particles(const FluidProperties& properties, const Filter& filter, const Kernel& kernel,
                                    std::span<const double> alpha) {
  const auto T = fluid_.temperature();
  // Only differences of temperature matter; counted from the fluid's mean, little is lost to rounding.
  double mean[2] = {std::accumulate(T.begin(), T.begin() + mesh_.owned_nodes, 0.0), double(mesh_.owned_nodes)};
  MPI_Allreduce(MPI_IN_PLACE, mean, 2, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  mean_ = mean[0] / mean[1];
  filtered_.assign(T.begin(), T.end());
  for (double& value : filtered_) value -= mean_;
  filter.apply(filtered_.data(), 1);
  const int count = particles_.owned();
  at_particles_.resize(count);
  kernel.sample(filtered_, at_particles_, 1);
  Columns& columns = particles_.columns();
  // The same everywhere, also in a gas whose viscosity changes with temperature.
  const double prandtl = fluid_.viscosity() * fluid_.heat_capacity() / fluid_.conductivity();
  std::visit(
      [&](const auto& law) {
        for (int p = 0; p < count; ++p) {
          const double diameter = 2 * particles_.radius(p);
          const double speed = (vec3(particles_.fluid_action(p).velocity) - particles_.velocity(p)).norm();
          const double reynolds = properties.density(p) * diameter * speed / properties.viscosity(p);
          *columns.row(outside_, p) = mean_ + at_particles_[p];
          // h A = Nu lambda/d pi d^2
          *columns.row(exchange_, p) =
              law.nusselt({reynolds, prandtl, alpha[p]}) * properties.conductivity(p) * std::numbers::pi * diameter;
          *columns.row(received_, p) = 0;
        }
      },
      nusselt_);
}

void HeatExchange::before_fluid(double dt, double depth, const Filter& filter, const Kernel& kernel) {
  const int count = particles_.owned(), all = kernel.count();
  const Columns& columns = particles_.columns();
  share_.resize(count);
  seen_.resize(all);
  kernel.sample(filtered_, seen_, 1);
  at_particles_.assign(2 * static_cast<std::size_t>(all), 0.0);
  ledger_ = HeatLedger{};
  exchanged_ = 0;
  for (int p = 0; p < all; ++p) {
    double received = 0, spread = 0;
    if (p < count) {
      const double capacity = particles_.heat_capacity(p);
      share_[p] = -std::expm1(-*columns.row(exchange_, p) * dt / capacity);
      received = *columns.row(received_, p);
      at_particles_[2 * p + 1] = share_[p] * capacity;
      spread = at_particles_[2 * p + 1] * seen_[p];
    } else if (const auto& row = particles_.departed()[p - count].columns; !row.empty()) {
      received = row[columns.offset(received_)];  // those that were taken out between steps took nothing
    }
    at_particles_[2 * p] = received - spread;
    ledger_.received += received;
    exchanged_ += std::abs(received) + std::abs(spread);
  }
  nodal_.resize(2 * static_cast<std::size_t>(mesh_.nodes));
  kernel.deposit(at_particles_, nodal_, 2);
  for (int i = 0; i < mesh_.nodes; ++i)
    for (int c = 0; c < 2; ++c) nodal_[2 * i + c] /= mass_[i] * depth;
  filter.apply(nodal_.data(), 2);
  ParticleLoad& load = fluid_.load();
  const auto T = fluid_.temperature();
  for (int i = 0; i < mesh_.nodes; ++i) {
    load.heat_response[i] = mass_[i] * nodal_[2 * i + 1] / dt;
    load.heat[i] = -mass_[i] * nodal_[2 * i] / dt - load.heat_response[i] * (T[i] - mean_);
  }
  for (int i = 0; i < mesh_.owned_nodes; ++i) ledger_.given += depth * dt * load.heat[i];
}

void HeatExchange::after_fluid(double dt, double depth, const Filter& filter, const Kernel& kernel) {
  const auto change = fluid_.temperature_change();
  const ParticleLoad& load = fluid_.load();
  for (int i = 0; i < mesh_.owned_nodes; ++i)
    ledger_.response_on_fluid -= depth * dt * load.heat_response[i] * change[i];
  nodal_.assign(change.begin(), change.end());
  filter.apply(nodal_.data(), 1);
  const int count = particles_.owned();
  at_particles_.resize(count);
  kernel.sample(nodal_, at_particles_, 1);
  for (int p = 0; p < count; ++p) {
    const double rise = share_[p] * at_particles_[p], heat = particles_.heat_capacity(p) * rise;
    *particles_.columns().row(temperature_, p) += rise;
    ledger_.response_on_particles += heat;
    exchanged_ += std::abs(heat);
  }
  double sums[5] = {ledger_.received, ledger_.given, ledger_.response_on_particles, ledger_.response_on_fluid,
                    exchanged_};
  MPI_Allreduce(MPI_IN_PLACE, sums, 5, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  ledger_ = {sums[0], sums[1], sums[2], sums[3], 0};
  exchanged_ = sums[4];
  const double imbalance = std::max(std::abs(ledger_.received + ledger_.given),
                                    std::abs(ledger_.response_on_particles + ledger_.response_on_fluid));
  ledger_.residual = balanced("the heat exchanged between fluid and particles", imbalance, exchanged_);
}

}  // namespace silt
