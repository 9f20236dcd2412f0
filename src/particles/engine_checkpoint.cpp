// The particles in a checkpoint: what a run goes on from, bit by bit where the rank count is the same.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <unordered_map>

#include "base/checkpoint_file.hpp"
#include "base/error.hpp"
#include "base/petsc.hpp"
#include "particles/engine.hpp"

namespace silt {
namespace {

/// FluidAction as numbers; every member but nothing else.
constexpr int action_width = sizeof(FluidAction) / sizeof(double);
static_assert(sizeof(FluidAction) == action_width * sizeof(double) && std::is_trivially_copyable_v<FluidAction>);
constexpr int motion_width = (sizeof(Motion) + sizeof(Rotation)) / sizeof(double);
constexpr int load_width = sizeof(Load) / sizeof(double);

template <class T>
std::vector<double> as_numbers(const T* from, int count) {
  const auto* numbers = reinterpret_cast<const double*>(from);
  return {numbers, numbers + static_cast<std::size_t>(count) * (sizeof(T) / sizeof(double))};
}

std::vector<std::int64_t> rows_each(const ParticleRows& rows, int particles) {
  std::vector<std::int64_t> counts(particles);
  for (int p = 0; p < particles; ++p) counts[p] = rows.rows(p);
  return counts;
}

/// This rank's share of an array with so many rows each particle.
void load_rows(const CheckpointReader& from, const std::string& name, long long first, int particles,
               ParticleRows& rows) {
  if (from.components(name) != rows.width)
    from.refuse(fmt::format("was written with other contact laws: {} numbers in {}, this case needs {}",
                            from.components(name), name, rows.width));
  const auto before = from.wholes(name + "_each", 0, first + particles);
  long long start = 0, count = 0;
  for (long long k = 0; k < first; ++k) start += before[k];
  for (int p = 0; p < particles; ++p) count += before[first + p];
  const auto entries = from.numbers(name, start, count);
  rows.clear();
  std::size_t at = 0;
  for (int p = 0; p < particles; ++p) {
    const auto each = static_cast<int>(before[first + p]);
    rows.append(entries.data() + at, each);
    at += static_cast<std::size_t>(each) * rows.width;
  }
}

}  // namespace

void Engine::save(CheckpointWriter& to) {
  // The lists are made anew after a checkpoint, as after a restart: both then sum in the same order.
  if (!detached_) detach();
  memory_.complete(store.id);  // other ranks may read it
  const int n = store.owned;
  std::vector<double> motion(static_cast<std::size_t>(n) * motion_width);
  for (int p = 0; p < n; ++p) {
    double* row = &motion[static_cast<std::size_t>(p) * motion_width];
    std::memcpy(row, &store.motion[p], sizeof(Motion));
    std::memcpy(row + 8, &store.rotation[p], sizeof(Rotation));
  }
  to.add("particle_motion", motion_width, std::move(motion));
  to.add("particle_load", load_width, as_numbers(store.present.data(), n));
  if (mpi_any(store.acted_on)) {
    store.want_actions();
    to.add("particle_action", action_width, as_numbers(store.action.data(), n));
  }
  to.add("particle_id", 1, std::vector<std::int64_t>(store.id.begin(), store.id.begin() + n));
  to.add("particle_cell", 1, std::vector<std::int64_t>(store.cell.begin(), store.cell.begin() + n));
  for (int c = 0; c < store.columns.count(); ++c) {
    const ColumnRequest& column = store.columns.request(c);
    const double* first = store.columns.values(c);
    to.add("column_" + column.name, column.width,
           std::vector<double>(first, first + static_cast<long>(n) * column.width));
  }
  to.add("contacts_each", 1, rows_each(memory_.rows, n));
  to.add("contacts", memory_.rows.width, memory_.rows.entries);
  to.add("wall_contacts_each", 1, rows_each(wall_memory_, n));
  to.add("wall_contacts", wall_memory_.width, wall_memory_.entries);
  to.add("particles_each_rank", 1, std::vector<std::int64_t>{n});
  // The forces of the walls are each rank's share; one row a rank and wall.
  to.add("wall_force", 3, as_numbers(wall_force.data(), static_cast<int>(wall_force.size())));
  to.add("wall_torque", 3, as_numbers(wall_torque.data(), static_cast<int>(wall_torque.size())));
  to.add("wall_total", 3, as_numbers(&wall_total_, 1));
  to.add("field_total", 3, as_numbers(&field_total_, 1));
  std::vector<double> states;
  if (mpi_rank() == 0)
    for (const auto& state : walls_.states())
      states.insert(states.end(), {state.travel[0], state.travel[1], state.travel[2], state.angle, state.servo_speed});
  to.add("wall_states", 5, states);
  std::vector<double> streams;
  if (mpi_rank() == 0) streams = as_numbers(streams_.states().data(), streams_.count());
  to.add("streams", sizeof(StreamState) / sizeof(double), streams);
  std::vector<double> sizes;
  if (mpi_rank() == 0)
    for (int m = 0; m < materials.count(); ++m)
      sizes.insert(sizes.end(), {laws_.sizes().smallest[m], laws_.sizes().largest[m], smallest_.radius[m]});
  to.add("particle_sizes", 3, sizes);
  to.note("particle_speed", speed_);
  if (energy_) {
    const EnergyLedger::State state = energy_->state();
    to.add("energy_account", sizeof(state) / sizeof(double), as_numbers(&state, 1));
  }
  to.note("particles_total", static_cast<double>(total));
  to.note("particles_removed", static_cast<double>(removed));
  to.note("particles_next_id", static_cast<double>(next_id_));
  to.note("particles_largest_radius", largest_radius_);
  to.note("particles_skin", skin_);
  to.note("particles_started", started_);
  std::string names;
  for (int m = 0; m < materials.count(); ++m) names += materials[m].name + " ";
  to.note("materials", names);
  std::string walls;
  for (int w = 0; w < walls_.count(); ++w) walls += walls_.name(w) + " ";
  to.note("walls", walls);
}

void Engine::load(const CheckpointReader& from, bool elsewhere) {
  std::string names, walls;
  for (int m = 0; m < materials.count(); ++m) names += materials[m].name + " ";
  for (int w = 0; w < walls_.count(); ++w) walls += walls_.name(w) + " ";
  if (from.text("materials") != names)
    from.refuse(fmt::format("has the materials {}this case has {}", from.text("materials"), names));
  if (from.text("walls") != walls)
    from.refuse(fmt::format("has the walls {}this case has {}", from.text("walls"), walls));
  const bool acted_on = from.has("particle_action");
  if (from.components("particle_motion") != motion_width ||
      (acted_on && from.components("particle_action") != action_width))
    from.refuse("was written by another version of Silt: a particle has other properties there");

  const auto each = from.wholes("particles_each_rank");
  const bool same_ranks = static_cast<int>(each.size()) == mpi_size() && !elsewhere;
  const long long all = from.rows("particle_id"), rank = mpi_rank(), ranks = mpi_size();
  long long first = all * rank / ranks, last = all * (rank + 1) / ranks;
  if (same_ranks) {
    first = 0;
    for (int r = 0; r < rank; ++r) first += each[r];
    last = first + each[rank];
  }
  const int n = static_cast<int>(last - first);
  store.owned = n;
  store.ghosts = 0;
  store.reserve(n);
  const auto motion = from.numbers("particle_motion", first, n), load = from.numbers("particle_load", first, n);
  for (int p = 0; p < n; ++p) {
    const double* row = &motion[static_cast<std::size_t>(p) * motion_width];
    std::memcpy(&store.motion[p], row, sizeof(Motion));
    std::memcpy(&store.rotation[p], row + 8, sizeof(Rotation));
  }
  std::copy(load.begin(), load.end(), reinterpret_cast<double*>(store.present.data()));
  store.columns.reserve(n);
  store.action.assign(store.acted_on ? n : 0, {});
  if (acted_on) {
    store.want_actions();
    const auto action = from.numbers("particle_action", first, n);
    std::copy(action.begin(), action.end(), reinterpret_cast<double*>(store.action.data()));
  }
  store.id = from.wholes("particle_id", first, n);
  const auto cells = from.wholes("particle_cell", first, n);
  store.cell.assign(n, -1);
  if (same_ranks) std::copy(cells.begin(), cells.end(), store.cell.begin());
  load_rows(from, "contacts", first, n, memory_.rows);
  memory_.once = false;
  load_rows(from, "wall_contacts", first, n, wall_memory_);

  const auto force = from.numbers("wall_force"), torque = from.numbers("wall_torque"),
             total_force = from.numbers("wall_total"), total_field = from.numbers("field_total");
  const int count = walls_.count();
  wall_total_.setZero();
  field_total_.setZero();
  for (int w = 0; w < count; ++w) wall_force[w].setZero(), wall_torque[w].setZero();
  for (int r = 0; r < static_cast<int>(each.size()); ++r) {
    if (same_ranks ? r != rank : rank != 0) continue;
    for (int w = 0; w < count; ++w) {
      wall_force[w] += vec3(&force[3 * (static_cast<std::size_t>(r) * count + w)]);
      wall_torque[w] += vec3(&torque[3 * (static_cast<std::size_t>(r) * count + w)]);
    }
    wall_total_ += vec3(&total_force[3 * static_cast<std::size_t>(r)]);
    field_total_ += vec3(&total_field[3 * static_cast<std::size_t>(r)]);
  }
  const auto numbers = from.numbers("wall_states");
  std::vector<WallMotion::State> states;
  for (std::size_t k = 0; k + 4 < numbers.size(); k += 5)
    states.push_back({vec3(&numbers[k]), numbers[k + 3], numbers[k + 4]});
  walls_.set_states(states);

  if (from.rows("streams") != streams_.count())
    from.refuse(fmt::format("has {} streams of particles, this case has {}", from.rows("streams"), streams_.count()));
  const auto stream_numbers = from.numbers("streams");
  std::vector<StreamState> stream_states(streams_.count());
  std::copy(stream_numbers.begin(), stream_numbers.end(), reinterpret_cast<double*>(stream_states.data()));
  streams_.set_states(stream_states);
  const auto saved_sizes = from.numbers("particle_sizes");
  ParticleSizes sizes(materials.count());
  for (int m = 0; m < materials.count(); ++m)
    sizes.smallest[m] = saved_sizes.at(3 * m), sizes.largest[m] = saved_sizes.at(3 * m + 1);
  laws_.set_sizes(sizes);
  smallest_.radius.resize(materials.count());
  for (int m = 0; m < materials.count(); ++m) smallest_.radius[m] = saved_sizes.at(3 * m + 2);
  speed_ = options_.speed.value_or(from.number("particle_speed"));
  choose_step();
  total = static_cast<long long>(from.number("particles_total"));
  removed = static_cast<long long>(from.number("particles_removed"));
  next_id_ = static_cast<std::int64_t>(from.number("particles_next_id"));
  largest_radius_ = from.number("particles_largest_radius");
  skin_ = from.number("particles_skin");
  started_ = from.number("particles_started") != 0;
  advanced_ = true;
  if (energy_) {
    energy_->set_state({});
    if (from.has("energy_account")) {  // a row a rank
      const auto rows = from.numbers("energy_account");
      for (std::size_t r = 0; r < each.size(); ++r) {
        EnergyLedger::State state;
        if (same_ranks ? static_cast<long long>(r) != rank : rank != 0) continue;
        std::copy_n(&rows[r * sizeof(state) / sizeof(double)], sizeof(state) / sizeof(double),
                    reinterpret_cast<double*>(&state));
        energy_->add_state(state);
      }
    } else {
      energy_->restart(store);
      started_ = false;
    }
  }
  contacts.clear();
  detached_ = true;
  fluid_ = false;
  impulses = {};
  departed.clear();
  // On other ranks than those that wrote, every particle goes where its cell is.
  if (!same_ranks && migration_.any_away(store) &&
      !migration_.run(store, store.present, memory_.rows, wall_memory_).empty())
    throw RunError("a particle of the checkpoint lies outside the mesh");
}

void Engine::load_columns(const CheckpointReader& from) {
  if (store.columns.count() == 0) return;
  const auto ids = from.wholes("particle_id");
  std::unordered_map<std::int64_t, std::size_t> row;
  for (std::size_t k = 0; k < ids.size(); ++k) row[ids[k]] = k;
  for (int c = 0; c < store.columns.count(); ++c) {
    const ColumnRequest& column = store.columns.request(c);
    const std::string name = "column_" + column.name;
    if (!column.needed && !from.has(name)) continue;
    if (!from.has(name) || from.components(name) != column.width)
      from.refuse(fmt::format("was written by a case whose particles have no {}", column.name));
    const auto all = from.numbers(name);
    for (int p = 0; p < store.owned; ++p)
      std::copy_n(&all[row.at(store.id[p]) * column.width], column.width, store.columns.row(c, p));
  }
}

}  // namespace silt
