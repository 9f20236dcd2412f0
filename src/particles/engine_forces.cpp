// What acts on the particles at one moment: contacts, walls, fields.
#include <fmt/format.h>

#include <algorithm>

#include "particles/engine.hpp"

namespace silt {
namespace {

/// A sweep over contacts of either kind: what it reads of the particles, and the loads it adds to.
template <class Sweep>
Sweep sweep_over(Store& store, const LawSetup& laws, double dt) {
  Sweep sweep;
  sweep.motion = store.motion.data();
  sweep.rotation = store.rotation.data();
  sweep.load = store.present.data();
  sweep.laws = laws;
  sweep.dt = dt;
  return sweep;
}

}  // namespace

void Engine::act_fields(double time, double dt) {
  FieldStep step{store, periods_, materials, communicator_, time, dt};
  // Who couples the particles to a fluid wants to know what the fields gave each of them.
  std::vector<Vec3> contacts_only(store.acted_on ? store.owned : 0);
  for (std::size_t p = 0; p < contacts_only.size(); ++p) contacts_only[p] = vec3(store.present[p].force);
  if (energy_) energy_->before_fields(store);
  for (const auto& field : fields_) field->act(step);
  if (energy_) energy_->after_fields(store);
  for (std::size_t p = 0; p < contacts_only.size(); ++p)
    vec3(store.action[p].field_impulse) += dt * (vec3(store.present[p].force) - contacts_only[p]);
  field_total_ = step.external;
  if (plane_) field_total_[2] = 0;
  field_size_ = step.size;
}

void Engine::want_turns(Integration& step) {
  if (std::none_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->turns(); })) return;
  store.turned.reserve(4 * static_cast<std::size_t>(store.owned));
  step.turned = reinterpret_cast<double(*)[4]>(store.turned.data());
}

void Engine::evaluate(double time, double dt) {
  const LawSetup& setup = laws_.setup();
  if (!trouble_.empty()) {  // the ranks have not heard of it yet
    halo_.finish(store);
    return;
  }
  // Walls need no ghosts, which are under way meanwhile. A wall that has been left in this step is looked at once more
  // where a law's force ends with a jump.
  walls_.points(store.motion.data(), time, wall_contacts.next(), setup.jumping ? strode_ : 0);
  wall_contacts.adopt(store.motion.data(), setup.leave_gap);
  act_contacts(dt);

  std::fill(wall_force_sum_.begin(), wall_force_sum_.end(), 0.0);
  std::fill(wall_torque_sum_.begin(), wall_torque_sum_.end(), 0.0);
  auto walls = sweep_over<WallSweep>(store, setup, dt);
  walls.wall_force = reinterpret_cast<double(*)[3]>(wall_force_sum_.data());
  walls.wall_torque = reinterpret_cast<double(*)[3]>(wall_torque_sum_.data());
  wall_contacts.fill(walls);
  if (energy_) energy_->trace(walls);
  kernels_.walls(walls);
  wall_total_.setZero();
  for (std::size_t b = 0; b < wall_force.size(); ++b) {
    wall_force[b] = vec3(&wall_force_sum_[3 * b]);
    wall_torque[b] = vec3(&wall_torque_sum_[3 * b]);
    wall_total_ += wall_force[b];
  }
  if (plane_) wall_total_[2] = 0;
  for (const WallPoint& point : wall_contacts.points()) {
    const Motion& motion = store.motion[point.particle];
    if (point.distance < motion.radius) *store.columns.row(last_wall_, point.particle) = point.boundary + 1;
    if (motion.radius - point.distance > options_.overlap_limit * motion.radius)
      report(options_.deep,
             fmt::format(
                 "a particle overlaps the wall {} by {:.4g} of its radius, limit {:g} (-particles_overlap_limit): {}",
                 walls_.name(point.boundary), 1 - point.distance / motion.radius, options_.overlap_limit,
                 describe(point.particle)));
  }
  if (!fields_.empty()) act_fields(time, dt);
}

void Engine::act_contacts(double dt) {
  const LawSetup& setup = laws_.setup();
  auto sweep = sweep_over<PairSweep>(store, setup, dt);
  sweep.periods = periods_;
  sweep.deepest_share = options_.overlap_limit;
  constexpr int cached = 30000;  // particles whose records stay in a core's caches
  sweep.scattered = contacts.contacts() < store.owned / 2 || store.owned > cached;
  sweep.leaving = contacts.leaving();
  // Contacts without a ghost are computed while ghosts are under way, unless somebody must know of new ones first.
  const int inner = contacts.first_inner();
  const int swept = halo_.under_way() && !energy_ && !liquid_.active() ? std::max(inner, contacts.last_full()) : inner;
  constexpr int at_once = 16384;
  leaving_count_ = 0;
  for (int from = inner; from < swept; from += at_once) {
    leaving_count_ += sweep_contacts(sweep, from, std::min(from + at_once, swept));
    halo_.poke();
  }
  path_ += std::max(way_, halo_.finish(store));
  way_ = 0;

  CandidateSweep search;
  search.motion = store.motion.data();
  search.periods = periods_;
  search.enter_gap = setup.enter_gap;
  contacts.look(search, path_ / skin_, skin_, kernels_.candidates);

  liquid_.exchange(store, contacts, wall_contacts, periods_, dt);

  sweep.leaving = contacts.leaving(true);
  if (energy_) {
    sweep.pairs = contacts.pairs();
    energy_->trace(sweep);
  }
  leaving_count_ += sweep_contacts(sweep, swept, contacts.contacts());
  sweep.scattered = true;  // contacts with ghosts go along the ghosts
  leaving_count_ += sweep_contacts(sweep, 0, inner);
  note_loaded();
  if (!energy_) contacts.leave(leaving_count_);
}

int Engine::sweep_contacts(PairSweep& sweep, int from, int to) {
  sweep.pairs = contacts.pairs();
  sweep.first = from;
  sweep.pairs.count = std::min(to, sweep.pairs.count);
  kernels_.pairs(sweep);
  if (sweep.too_deep >= 0) report(options_.deep, describe_deepest(sweep.too_deep));
  return sweep.leaving_count;
}

/// Where few particles touch anything, the others' loads, which are zero, need not pass through the processor.
void Engine::note_loaded() {
  constexpr double dense = 0.75;  // contacts a particle
  few_loaded_ = fields_.empty() && contacts.contacts() < dense * store.owned;
  if (!few_loaded_) return;
  loaded_.assign(store.all() + 2, 0);
  for (int k = 0; k < contacts.contacts(); ++k) loaded_[contacts.contact_i()[k]] = loaded_[contacts.contact_j()[k]] = 1;
  for (const WallPoint& point : wall_contacts.points()) loaded_[point.particle] = 1;
}

void Engine::account(double h) {
  if (!energy_) return;
  energy_->account({store, contacts, wall_contacts, laws_, periods_, pass(h), fluid_, h});
  contacts.leave(leaving_count_);
}

void Engine::correct(double h) {
  if (options_.late_share() == 0) return;
  Integration step = pass(h);
  step.correct = true;
  kernels_.integrate(step);
}

}  // namespace silt
