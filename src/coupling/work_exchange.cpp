#include "coupling/work_exchange.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "coupling/exchange.hpp"

namespace silt {

void WorkExchange::before_fluid(double dt, double depth, const Filter& filter, const Kernel& kernel) {
  const int count = particles_.owned(), all = kernel.count();
  ledger_ = WorkLedger{};
  exchanged_ = 0;
  at_particles_.resize(all);
  for (int p = 0; p < all; ++p) {
    at_particles_[p] =
        p < count ? particles_.fluid_action(p).work : particles_.departed()[static_cast<size_t>(p - count)].action.work;
    ledger_.owed += at_particles_[p];
    exchanged_ += std::abs(at_particles_[p]);
  }
  nodal_.resize(mesh_.nodes);
  kernel.deposit(at_particles_, nodal_, 1);
  for (int i = 0; i < mesh_.nodes; ++i) nodal_[i] /= mass_[i] * depth;
  filter.apply(nodal_.data(), 1);
  ParticleLoad& load = fluid_.load();
  for (int i = 0; i < mesh_.nodes; ++i) load.energy[i] = -mass_[i] * nodal_[i] / dt;
  for (int i = 0; i < mesh_.owned_nodes; ++i) ledger_.given += depth * dt * load.energy[i];
}

void WorkExchange::after_fluid(double dt, double depth, const Filter& filter, const Kernel& kernel) {
  const auto change = fluid_.velocity_change(), velocity = fluid_.velocity();
  const ParticleLoad& load = fluid_.load();
  for (int i = 0; i < mesh_.nodes; ++i) {
    const size_t k = 3 * static_cast<size_t>(i);
    nodal_[i] = vec3(&change[k]).dot(vec3(&velocity[k]));
    if (i < mesh_.owned_nodes) ledger_.response += depth * dt * load.response[i] * nodal_[i];
  }
  filter.apply(nodal_.data(), 1);
  at_particles_.resize(kernel.count());
  kernel.sample(nodal_, at_particles_, 1);
  volume_ = moved_ = 0;
}

void WorkExchange::settle(int p, double response, const Vec3& at_once, const Vec3& pressure) {
  const Vec3 velocity = particles_.velocity(p);
  const double paid = response * at_particles_[p], moved = -pressure.dot(velocity);
  particles_.fluid_action(p).work = at_once.dot(velocity + at_once / (2 * particles_.mass(p))) - paid + moved;
  ledger_.settled += paid;
  exchanged_ += std::abs(paid) + std::abs(moved);
  moved_ += moved;
  volume_ += particles_.volume(p);
}

void WorkExchange::close(double dt, double depth) {
  const auto pressure = fluid_.pressure();
  double sums[4] = {moved_, volume_, 0, 0};
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    sums[2] += mass_[i] * pressure[i];
    sums[3] += mass_[i] * fluid_.load().void_fraction_rate[i];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 4, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  const double mean = sums[2] / mesh_.volume;
  ledger_.displaced = -depth * dt * fluid_.displacement_power(mean);
  ledger_.inserted = -depth * dt * mean * sums[3];
  // The particles' paths and the void fraction's rate of change give the same work but for their discretisation: the
  // difference is shared among the particles by volume.
  const double share = sums[1] > 0 ? (ledger_.displaced - sums[0]) / sums[1] : 0;
  for (int p = 0; p < particles_.owned(); ++p) {
    particles_.fluid_action(p).work += share * particles_.volume(p);
    ledger_.in_transit += particles_.fluid_action(p).work;
  }
  double all[6] = {ledger_.given, ledger_.owed, ledger_.response, ledger_.settled, ledger_.in_transit, exchanged_};
  MPI_Allreduce(MPI_IN_PLACE, all, 6, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  ledger_.given = all[0], ledger_.owed = all[1], ledger_.response = all[2], ledger_.settled = all[3];
  ledger_.in_transit = all[4], exchanged_ = all[5];
  const double imbalance =
      std::max(std::abs(ledger_.given + ledger_.owed), std::abs(ledger_.response - ledger_.settled));
  ledger_.residual = balanced("the work exchanged between fluid and particles", imbalance, exchanged_);
}

}  // namespace silt
