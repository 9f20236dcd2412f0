// What the particle solver finds wrong, and how it says so.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/petsc.hpp"
#include "particles/engine.hpp"

namespace silt {

void Engine::stop_if_any(const std::string& text) const {
  int size = 1, rank = 0;
  MPI_Comm_size(communicator_, &size);
  MPI_Comm_rank(communicator_, &rank);
  int first = text.empty() ? size : rank, lowest = first;
  MPI_Allreduce(&first, &lowest, 1, MPI_INT, MPI_MIN, communicator_);
  if (lowest == size) return;
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, lowest, communicator_);
  std::string told = rank == lowest ? text : std::string(length, ' ');
  MPI_Bcast(told.data(), length, MPI_CHAR, lowest, communicator_);
  throw RunError(told);
}

std::string Engine::describe(const Body& motion, std::int64_t id) const {
  return fmt::format(
      "particle {} at ({:.6g}, {:.6g}, {:.6g}) m, velocity ({:.6g}, {:.6g}, {:.6g}) m/s, spin ({:.6g}, {:.6g}, {:.6g}) "
      "rad/s, radius "
      "{:.6g} m, rank {}",
      id, motion.position[0], motion.position[1], motion.position[2], motion.velocity[0], motion.velocity[1],
      motion.velocity[2], motion.spin[0], motion.spin[1], motion.spin[2], motion.radius, mpi_rank());
}

std::string Engine::last_wall(double number) const {
  const int wall = static_cast<int>(number) - 1;
  return wall < 0 || wall >= walls_.count() ? "" : fmt::format(", last wall {}", walls_.name(wall));
}

std::string Engine::describe(int p) const {
  std::string partners;
  const auto name = [&](const std::string& one) { partners += (partners.empty() ? ", touches " : ", ") + one; };
  if (detached_) {
    for (int k = memory_.rows.start[p]; k < memory_.rows.start[p + 1]; ++k)
      name(fmt::format("{}", std::bit_cast<std::int64_t>(memory_.rows.row(k)[0])));
  } else {
    for (int k = 0; k < contacts.contacts(); ++k) {
      const int i = contacts.contact_i()[k], j = contacts.contact_j()[k];
      if (i == p || j == p) name(fmt::format("{}", store.id[i == p ? j : i]));
    }
  }
  for (const WallPoint& point : wall_contacts.points())
    if (!detached_ && point.particle == p) name("the wall " + walls_.name(point.boundary));
  return describe(store.body(p), store.id[p]) + partners +
         (last_wall_ >= 0 && p < store.owned ? last_wall(*store.columns.row(last_wall_, p)) : "");
}

std::string Engine::describe(const Gone& gone) const {
  std::string partners;  // those on this rank
  for (int p = 0; p < store.owned; ++p)
    for (int k = memory_.rows.start[p]; k < memory_.rows.start[p + 1]; ++k)
      if (std::bit_cast<std::int64_t>(memory_.rows.row(k)[0]) == gone.id)
        partners += fmt::format("{}{}", partners.empty() ? ", touched " : ", ", store.id[p]);
  return describe(gone.body, gone.id) + partners +
         (last_wall_ >= 0 ? last_wall(gone.columns[store.columns.offset(last_wall_)]) : "");
}

void Engine::report(const std::string& option, const std::string& text) {
  if (text.empty()) return;
  if (option == "stop") {
    trouble_ = text;
    return;
  }
  // What goes on is told after 1, 2, 4, 8 ... times.
  ++warnings_;
  if ((warnings_ & (warnings_ - 1)) == 0)
    fmt::print(stderr, "silt: warning {} of rank {}: {}\n", warnings_, mpi_rank(), text);
}

std::string Engine::describe_deepest(int contact) const {
  const int i = contacts.contact_i()[contact], j = contacts.contact_j()[contact];
  return fmt::format(
      "a particle overlaps another by more than {:g} of the smaller radius (-particles_overlap_limit): {}; the other "
      "is {}",
      options_.overlap_limit, describe(i), describe(j));
}

void Engine::take_sizes() {
  ParticleSizes sizes = laws_.sizes();  // of all there ever were, so that the reach does not shrink
  for (int p = 0; p < store.owned; ++p) {
    const int material = static_cast<int>(store.rotation[p].material);
    sizes.smallest[material] = std::min(sizes.smallest[material], store.motion[p].radius);
    sizes.largest[material] = std::max(sizes.largest[material], store.motion[p].radius);
  }
  MPI_Allreduce(MPI_IN_PLACE, sizes.smallest.data(), materials.count(), MPI_DOUBLE, MPI_MIN, communicator_);
  MPI_Allreduce(MPI_IN_PLACE, sizes.largest.data(), materials.count(), MPI_DOUBLE, MPI_MAX, communicator_);
  laws_.set_sizes(sizes);
}

std::vector<std::string> Engine::warnings() const {
  std::vector<std::string> all = laws_.warnings();
  for (const auto& field : fields_)
    for (auto& warning : field->warnings(materials, smallest_)) all.push_back(std::move(warning));
  return all;
}

std::string Engine::find_bad() const {
  for (int p = 0; p < store.owned; ++p) {
    const Motion& motion = store.motion[p];
    double sum = 0;
    for (int d = 0; d < 3; ++d) sum += motion.position[d] + motion.velocity[d] + store.rotation[p].spin[d];
    if (!std::isfinite(sum)) return "not a number: " + describe(p);
    if (heat_ && !std::isfinite(heat_->temperatures(store)[p]))
      return "not a number: the temperature of " + describe(p);
  }
  return "a particle's position is not a number";
}

void Engine::count_contacts(ParticleStep& step) const {
  ContactCensus census;
  census.motion = store.motion.data();
  census.owned = store.owned;
  census.count = contacts.contacts();
  census.i = contacts.contact_i(), census.j = contacts.contact_j();
  census.periods = periods_;
  kernels_.census(census);
  double walls = 0;
  for (const WallPoint& point : wall_contacts.points()) {
    const double share = 1 - point.distance / store.motion[point.particle].radius;
    walls += share > 0;
    census.largest = std::max(census.largest, share);
  }
  double sums[] = {census.touching, walls, census.fabric[0], census.fabric[1], census.fabric[2]};
  MPI_Allreduce(MPI_IN_PLACE, sums, 5, MPI_DOUBLE, MPI_SUM, communicator_);
  for (int d = 0; d < 3; ++d) step.fabric[d] = sums[0] > 0 ? sums[2 + d] / sums[0] : 0;
  step.contacts = static_cast<long long>(sums[0] + sums[1]);
  step.largest_overlap = mpi_max(census.largest);
}

}  // namespace silt
