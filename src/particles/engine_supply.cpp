// Particles that come and go during the run.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/petsc.hpp"
#include "particles/engine.hpp"

namespace silt {
namespace {

/// The spheres of all ranks that may touch one in the box, in the order of their numbers.
std::vector<PlacedSphere> gather_near(const Store& store, const Box& box, double largest, const Vec3& period,
                                      MPI_Comm communicator) {
  using Record = std::array<double, 5>;
  std::vector<Record> mine;
  for (int p = 0; p < store.owned; ++p) {
    const Motion& motion = store.motion[p];
    bool near = true;
    for (int d = 0; d < 3 && near; ++d) {
      const double middle = 0.5 * (box.lower[d] + box.upper[d]), half = 0.5 * (box.upper[d] - box.lower[d]) + largest;
      double off = motion.position[d] - middle;
      if (period[d] > 0) off -= period[d] * std::nearbyint(off / period[d]);
      near = std::abs(off) <= half;
    }
    if (near)
      mine.push_back({static_cast<double>(store.id[p]), motion.position[0], motion.position[1], motion.position[2],
                      motion.radius});
  }
  const int size = mpi_size(), count = static_cast<int>(mine.size()) * 5;
  std::vector<int> counts(size), starts(size, 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
  for (int r = 1; r < size; ++r) starts[r] = starts[r - 1] + counts[r - 1];
  std::vector<Record> all((starts.back() + counts.back()) / 5);
  MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, communicator);
  std::sort(all.begin(), all.end());
  std::vector<PlacedSphere> spheres;
  spheres.reserve(all.size());
  for (const auto& one : all) spheres.push_back({Vec3(one[1], one[2], one[3]), one[4]});
  return spheres;
}

}  // namespace

void Engine::supply(double time, double dt) {
  if (streams_.removes()) take_out(time);
  for (int s = 0; s < streams_.count(); ++s) {
    if (!streams_.due(s, time, dt)) continue;
    walls_.pose(time);
    const Vec3 period(periods_.length[0], periods_.length[1], periods_.length[2]);
    const auto seeds =
        streams_.add(s, time, dt, gather_near(store, streams_.region(s), largest_radius_, period, communicator_));
    try {
      if (!seeds.empty()) add(seeds);
    } catch (const UserError& error) {  // the run goes on from the last good state once the case is mended
      throw RunError(std::string("a stream adds particles: ") + error.what());
    }
  }
}

void Engine::depart(const std::vector<Gone>& gone, bool within_step, double h) {
  long long lost = 0;
  std::string text;
  for (const Gone& one : gone) {
    Departed leaving;
    leaving.id = one.id;
    leaving.position = vec3(one.body.position);
    leaving.velocity = vec3(one.body.velocity);
    leaving.mass = 1 / one.body.inverse_mass;
    leaving.cell = one.cell;
    leaving.boundary = one.boundary;
    leaving.action = one.action;
    leaving.columns = one.columns;
    leaving.acted = acted_;
    if (within_step && options_.late_share() > 0) {
      // It ends the step without contacts at its new place: the corrector for a force that has gone to zero.
      const double share = 1 / (1 + one.action.added_mass * one.body.inverse_mass);
      const double z = one.action.exchange * one.body.inverse_mass * share * h;
      const bool overdamped = brownian_.overdamped() && z > 0;
      const double first = overdamped ? h / z : z > 0 ? -std::expm1(-z) * h / z : h;
      const double corrector = overdamped ? h / z
                               : z > 1e-2 ? (1 - first / h) * h / z
                                          : h * (0.5 - z * (1.0 / 6 - z * (1.0 / 24 - z / 120)));
      const double held = options_.leapfrog() ? 0.5 : 0, taken = corrector - held * first, booked = (0.5 - held) * h;
      for (int d = 0; d < (plane_ ? 2 : 3); ++d) {
        const double slower = taken * share * one.body.inverse_mass * one.carried.force[d];
        leaving.velocity[d] -= slower;
        const double drag = -(taken * share - booked) * one.carried.force[d];
        leaving.action.impulse[d] += drag;
        leaving.action.work += drag * (leaving.velocity[d] + 0.5 * slower);
        impulses.drag[d] += drag;
      }
    }
    impulses.removed -= leaving.mass * leaving.velocity;
    impulses.removed_mass += leaving.mass;
    if (energy_ && within_step) energy_->went_from(one.body, one.columns, store.columns);
    if (energy_ && !within_step) energy_->went(one.body);
    departed.push_back(leaving);
    const bool open = one.boundary >= 0 && walls_.role(one.boundary) == BoundaryRole::open;
    if (one.boundary < 0 || open || walls_.role(one.boundary) == BoundaryRole::wall) {
      ++lost;
      if (text.empty())
        text = fmt::format("lost {}; it has passed {}{}", describe(one),
                           one.boundary < 0 ? "no boundary"
                           : open           ? "the open boundary "
                                            : "the wall ",
                           one.boundary < 0 ? "" : walls_.name(one.boundary));
    }
  }
  if (options_.lost == "stop")
    stop_if_any(text);
  else if (lost > 0)
    report("warn", fmt::format("{} ({} lost on this rank)", text, lost));
}

void Engine::take_out(double time) {
  std::vector<int> staying;
  std::vector<Departed> leaving;
  for (int p = 0; p < store.owned; ++p) {
    const Motion& motion = store.motion[p];
    if (!streams_.removed(vec3(motion.position), time)) {
      staying.push_back(p);
      continue;
    }
    Departed gone;
    gone.id = store.id[p];
    gone.position = vec3(motion.position);
    gone.velocity = vec3(motion.velocity);
    gone.mass = 1 / motion.inverse_mass;
    gone.cell = store.cell[p];
    if (store.acted_on)
      gone.action.work = store.action[p].work;  // of the step before; the fluid is still to be charged
    impulses.removed -= gone.mass * gone.velocity;
    impulses.removed_mass += gone.mass;
    if (energy_) energy_->went(store.body(p));
    leaving.push_back(gone);
  }
  const long long count = mpi_sum(static_cast<long long>(leaving.size()));
  if (count == 0) return;
  if (!detached_) detach();
  store.ghosts = 0;
  store.id.resize(store.owned);
  store.reorder(staying, store.present);
  memory_.rows.reorder(staying);
  wall_memory_.reorder(staying);
  started_ = false;  // the forces that those gone exerted must not act on
  total -= count;
  removed += count;
  taken_out_.insert(taken_out_.end(), leaving.begin(), leaving.end());
}

}  // namespace silt
