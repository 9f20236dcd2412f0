// The states outside the ordinary step: settling, particles held fixed, snapshots.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/petsc.hpp"
#include "particles/engine.hpp"

namespace silt {

void Engine::settle(const SettleOptions& options) {
  if (options.time > 0 && total > 0) come_to_rest(options);
  if (!options_.fixed) return;
  for (int p = 0; p < store.owned; ++p)  // what is held has no velocity of a file or of settling to give up later
    for (int d = 0; d < 3; ++d) store.motion[p].velocity[d] = store.rotation[p].spin[d] = 0;
}

void Engine::come_to_rest(const SettleOptions& options) {
  settling_ = true;
  laws_.scale_friction(options.friction_factor);
  started_ = false;
  constexpr int chunks = 100;
  for (int c = 0; c < chunks; ++c) {
    advance(-options.time * (chunks - c) / chunks, options.time / chunks);
    double square = 0;
    for (int p = 0; p < store.owned; ++p) square += vec3(store.motion[p].velocity).squaredNorm();
    if (total == 0 || mpi_sum(square) < total * options.speed * options.speed) break;
  }
  laws_.scale_friction(1);
  settling_ = false;
  impulses = {};
  if (energy_) energy_->restart(store);
}

void Engine::heat_held(double time, double dt) {
  double longest = dt;
  for (int m = 0; m < materials.count(); ++m)
    longest = std::min(longest, options_.step_fraction * heat_->conduction_time(smallest_.radius[m], m));
  const int steps = static_cast<int>(std::ceil(dt / longest * (1 - 1e-12)));
  for (int s = 0; s < steps; ++s) {
    halo_.begin(store, 0);
    halo_.finish(store);
    heat_->advance(store, contacts, wall_contacts, walls_, periods_, time + (s + 1) * dt / steps, dt / steps);
  }
}

ParticleStep Engine::hold(double time, double dt) {
  if (!started_) start(0);  // they may not overlap more than others
  if (detached_) rebuild(store.present, false, 0);
  store.want_actions();
  Vec3 support = Vec3::Zero();
  for (int p = 0; p < store.owned; ++p) {
    FluidAction& action = store.action[p];
    Motion& motion = store.motion[p];
    const double mass = 1 / motion.inverse_mass;
    impulses.kicks -= mass * vec3(motion.velocity);  // a kick on a held particle moves nothing
    action.held = 1;
    for (int d = 0; d < 3; ++d) {
      motion.velocity[d] = store.rotation[p].spin[d] = 0;
      const double drag = action.exchange * action.velocity[d] * dt, force = action.force[d] * dt;
      const double weight = mass * gravity_[d] * dt;
      action.impulse[d] += drag;
      impulses.drag[d] += drag;
      impulses.fluid_force[d] += force;
      impulses.gravity[d] += weight;
      support[d] += drag + force + weight;
    }
  }
  impulses.walls -= support;
  if (heat_) heat_held(time, dt);
  ParticleStep result;
  result.substeps = 1;
  result.removed = removed;
  count_contacts(result);
  return result;
}

void Engine::detach() {
  contacts.gather(store, memory_);
  wall_contacts.gather(store.owned, wall_memory_);
  contacts.clear();
  detached_ = true;
}

std::shared_ptr<const Particles::Snapshot> Engine::snapshot(bool to_repeat) const {
  ContactMemory memory(laws_.history_components());
  ParticleRows wall_memory(wall_memory_.width);
  if (!detached_) {
    contacts.gather_once(store, {}, memory);
    wall_contacts.gather(store.owned, wall_memory);
  }
  const ContactMemory& remembered = detached_ ? memory_ : memory;
  const int n = store.owned;
  return std::make_shared<const Particles::Snapshot>(
      Particles::Snapshot{n,
                          PackedMotions(store.motion.data(), store.rotation.data(), n),
                          PackedLoads(store.present.data(), to_repeat ? n : 0),
                          PackedIds(n, [this](std::size_t p) { return store.id[p]; }),
                          store.cell,
                          store.action,
                          store.columns.save(n),
                          PackedRows(remembered.rows, true),
                          PackedRows(detached_ ? wall_memory_ : wall_memory, false),
                          remembered.once,
                          impulses,
                          total,
                          removed,
                          next_id_,
                          wall_total_,
                          field_total_,
                          wall_force,
                          wall_torque,
                          walls_.states(),
                          energy_ ? energy_->state() : EnergyLedger::State{},
                          streams_.states(),
                          started_ && to_repeat});
}

void Engine::restore(const Particles::Snapshot& saved) {
  store.owned = saved.owned;
  store.ghosts = 0;
  store.reserve(saved.owned);
  saved.motion.unpack(store.motion.data(), store.rotation.data());
  saved.present.unpack(store.present.data());
  if (saved.present.empty()) std::fill_n(store.present.data(), saved.owned, Load{});  // start() evaluates them anew
  store.id.resize(saved.owned);
  for (int p = 0; p < saved.owned; ++p) store.id[p] = saved.id[p];
  store.cell = saved.cell;
  store.acted_on = store.acted_on || !saved.action.empty();
  store.action = saved.action;
  if (store.acted_on) store.action.resize(saved.owned);
  store.columns.restore(saved.columns, saved.owned);
  contacts.clear();
  memory_.rows = saved.contacts.unpack();
  memory_.once = saved.contacts_once;
  wall_memory_ = saved.walls.unpack();
  detached_ = true;
  impulses = saved.impulses;
  total = saved.total;
  removed = saved.removed;
  next_id_ = saved.next_id;
  wall_total_ = saved.wall_total;
  wall_force = saved.wall_force;
  wall_torque = saved.wall_torque;
  walls_.set_states(saved.wall_states);
  if (energy_) energy_->set_state(saved.energy);
  streams_.set_states(saved.streams);
  taken_out_.clear();
  field_total_ = saved.field_total;
  started_ = saved.started;
  departed.clear();
  fluid_ = turning_ = false;
}

std::size_t Particles::Snapshot::bytes() const {
  return motion.bytes() + present.bytes() + id.bytes() + cell.capacity() * sizeof(int) +
         action.capacity() * sizeof(FluidAction) + columns.capacity() * sizeof(double) + contacts.bytes() +
         walls.bytes();
}

std::vector<std::pair<std::string, std::size_t>> Engine::bytes() const {
  auto all = store.bytes();
  all.push_back({"contacts", contacts.contact_bytes()});
  all.push_back({"candidates", contacts.candidate_bytes()});
  all.push_back({"marks", loaded_.capacity() + loaded_before_.capacity()});
  return all;
}

}  // namespace silt
