#include "particles/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/error.hpp"
#include "particles/insertion/insertion.hpp"
#include "particles/log_event.hpp"

namespace silt {
namespace {

template <class T>
T read(Options& options, const char* prefix) {
  T object;
  options.read(prefix, object);
  return object;
}

std::vector<std::string> names_of(const Materials& materials) {
  std::vector<std::string> names;
  names.reserve(materials.count());
  for (int m = 0; m < materials.count(); ++m) names.push_back(materials[m].name);
  return names;
}

}  // namespace

Engine::Engine(const Mesh& on_mesh, Options& options, const Vec3& gravity, bool empty)
    : mesh(on_mesh),
      materials(options),
      contacts(0),
      wall_contacts(0),
      options_(read<ParticleOptions>(options, "particles")),
      laws_(options, materials),
      liquid_(laws_, store.columns),
      walls_(on_mesh, options, names_of(materials)),
      streams_(walls_, options, materials, names_of(materials)),
      migration_(on_mesh, communicator_),
      halo_(communicator_),
      news_(communicator_),
      kernels_(choose_kernels(options_.instructions.c_str())),
      gravity_(gravity),
      plane_(options_.plane || on_mesh.dimension == 2),
      memory_(laws_.history_components()),
      wall_memory_(WallContacts::row_width(laws_.history_components())),
      brownian_(read<BrownianOptions>(options, "brownian")),
      fields_(make_force_fields(options, on_mesh, store.columns, options_.instructions)),
      heat_(ParticleHeat::create(options, materials, store.columns)) {
  contacts = ContactLists(laws_.history_components());
  wall_contacts = WallContacts(laws_.history_components(), liquid_.active());
  laws_.read_springs_at(options_.spring_share());
  laws_.take_slip_at_radius(options_.slip_arm == "radius");
  if (options_.energy) energy_ = std::make_unique<EnergyLedger>(store.columns);
  if (walls_.count() > 0) last_wall_ = store.columns.add({.name = "last_wall", .output = false, .needed = false});
  if (options_.orientation)
    orientation_ =
        store.columns.add({.name = "orientation", .width = 4, .start = [](const Seed&, double* row) { row[0] = 1; }});
  if (plane_) gravity_[2] = 0;
  for (int d = 0; d < 3; ++d)
    if (mesh.periodic[d]) {
      periods_.length[d] = migration_.locator().period()[d];
      periods_.inverse[d] = 1 / periods_.length[d];
      periods_.any = true;
    }
  wall_force.assign(walls_.count(), Vec3::Zero());
  wall_torque = wall_impulse = wall_turning = wall_force;
  wall_force_sum_.assign(3 * walls_.count() + 3, 0.0);
  wall_torque_sum_ = wall_force_sum_;
  store.reserve(0);
  check_warm_walls();
  for (const int material : streams_.materials())
    if (heat_) heat_->check(material);
  const std::vector<Seed> seeds = make_insertions(walls_, options, names_of(materials), empty);
  if (!seeds.empty()) add(seeds);
}

void Engine::add(const std::vector<Seed>& seeds) {
  std::vector<Vec3> points;
  points.reserve(seeds.size());
  for (const auto& seed : seeds) {
    if (seed.material < 0 || seed.material >= materials.count())
      throw UserError("particles need a material: give -material_<name>_density and the other properties");
    if (!(seed.radius > 0)) throw UserError(fmt::format("a particle radius of {} m; allowed: above 0", seed.radius));
    if (heat_) heat_->check(seed.material);
    points.push_back(seed.position);
  }
  const std::vector<Place> places = migration_.locator().claim(points);
  long long here = 0;
  for (const auto& place : places) here += place.inside();
  if (mpi_sum(here) != static_cast<long long>(seeds.size())) {
    std::vector<int> held(seeds.size()), found(seeds.size());
    for (std::size_t k = 0; k < seeds.size(); ++k) held[k] = places[k].inside();
    MPI_Allreduce(held.data(), found.data(), static_cast<int>(seeds.size()), MPI_INT, MPI_MAX, communicator_);
    const auto k = static_cast<std::size_t>(std::find(found.begin(), found.end(), 0) - found.begin());
    throw UserError(fmt::format("particle {} of {} to be added lies outside the mesh: ({:g}, {:g}, {:g}) m", k + 1,
                                seeds.size(), seeds[k].position[0], seeds[k].position[1], seeds[k].position[2]));
  }
  if (!detached_) detach();
  store.ghosts = 0;
  store.id.resize(store.owned);
  store.reserve(store.owned + static_cast<int>(here));
  store.id.reserve(store.owned + here);
  store.cell.reserve(store.owned + here);
  double fastest = 0;
  smallest_.radius.assign(materials.count(), infinity);
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    const Seed& seed = seeds[k];
    fastest = std::max(fastest, seed.velocity.norm());
    largest_radius_ = std::max(largest_radius_, seed.radius);
    if (!places[k].inside()) continue;
    const Vec3 position = migration_.locator().wrapped(seed.position, places[k]);
    const int p = store.owned++;
    store.reserve(store.owned);
    Motion& motion = store.motion[p];
    motion = Motion{};
    Rotation& rotation = store.rotation[p];
    rotation = Rotation{};
    for (int d = 0; d < 3; ++d) {
      motion.position[d] = position[d];
      motion.velocity[d] = seed.velocity[d];
      rotation.spin[d] = seed.spin[d];
    }
    if (plane_) motion.velocity[2] = rotation.spin[0] = rotation.spin[1] = 0;
    motion.radius = seed.radius;
    const double mass = *materials[seed.material].density * 4.0 / 3.0 * std::numbers::pi * std::pow(seed.radius, 3);
    motion.inverse_mass = 1 / mass;
    rotation.material = seed.material;
    store.present[p] = store.previous[p] = Load{};
    store.id.push_back(next_id_ + static_cast<std::int64_t>(k));
    store.cell.push_back(places[k].cell);
    if (store.acted_on) store.action.emplace_back();
    store.columns.start(p, seed);
    memory_.rows.append(nullptr, 0);
    wall_memory_.append(nullptr, 0);
    impulses.added += mass * vec3(motion.velocity);
    impulses.added_mass += mass;
    if (energy_) energy_->came(store.body(p));
  }
  next_id_ += static_cast<std::int64_t>(seeds.size());
  total += static_cast<long long>(seeds.size());

  for (int p = 0; p < store.owned; ++p) {
    double& radius = smallest_.radius[static_cast<int>(store.rotation[p].material)];
    radius = std::min(radius, store.motion[p].radius);
    fastest = std::max(fastest, vec3(store.motion[p].velocity).norm());
  }
  MPI_Allreduce(MPI_IN_PLACE, smallest_.radius.data(), materials.count(), MPI_DOUBLE, MPI_MIN, communicator_);
  take_sizes();
  const double fall = std::sqrt(2 * gravity_.norm() * (mesh.upper - mesh.lower).norm());
  if (brownian_.active())
    for (int m = 0; m < materials.count(); ++m)
      if (smallest_.radius[m] < infinity)
        fastest = std::max(fastest, brownian_.speed(*materials[m].density * 4.0 / 3.0 * std::numbers::pi *
                                                    std::pow(smallest_.radius[m], 3)));
  speed_ = options_.speed.value_or(std::max(mpi_max(fastest), fall));
  choose_step();

  skin_ = options_.skin > 0 ? options_.skin : std::max(skin_, 0.2 * largest_radius_);
  const double reach = 2 * largest_radius_ + laws_.setup().leave_gap + skin_;
  for (int d = 0; d < 3; ++d)
    if (mesh.periodic[d] && periods_.length[d] < 2 * reach)
      throw UserError(
          fmt::format("the periodic length {:g} m is too short for particles of diameter {:g} m that act over a "
                      "gap of {:g} m: two of them would meet twice; allowed: at least {:g} m",
                      periods_.length[d], 2 * largest_radius_, laws_.setup().leave_gap, 2 * reach));
  started_ = false;
}

void Engine::choose_step() {
  std::vector<StepBound> bounds;
  for (const auto& field : fields_)
    for (const StepBound& bound : field->bounds(materials, smallest_)) bounds.push_back(bound);
  for (int m = 0; m < materials.count() && heat_; ++m)
    if (const double time = smallest_.radius[m] < infinity ? heat_->conduction_time(smallest_.radius[m], m) : infinity;
        time < infinity)
      bounds.push_back({time, fmt::format("heat conduction of {}", materials[m].name)});
  limit = limit_step(options_, materials, laws_, smallest_, speed_, bounds);
}

void Engine::sum_up() {
  mass_ = 0;
  fluid_force_.setZero();
  for (int p = 0; p < store.owned; ++p) mass_ += 1 / store.motion[p].inverse_mass;
  if (fluid_)
    for (const auto& action : store.action) fluid_force_ += vec3(action.force);
  if (plane_) fluid_force_[2] = 0;
}

Integration Engine::pass(double h) {
  Integration step;
  step.motion = store.motion.data();
  step.rotation = store.rotation.data();
  step.present = store.present.data();
  step.previous = store.previous.data();
  if (few_loaded_ && few_loaded_before_) {
    step.loaded = loaded_.data();
    step.loaded_before = loaded_before_.data();
  }
  step.drag = fluid_ ? store.drag.data() : nullptr;
  step.turning = turning_ ? store.turning.data() : nullptr;
  step.count = store.owned;
  step.dt = h;
  step.late_share = options_.late_share();
  step.leapfrog = options_.leapfrog();
  step.second = (1 - step.late_share) * h * h;
  if (orientation_ >= 0) step.orientation = reinterpret_cast<double(*)[4]>(store.columns.values(orientation_));
  for (int d = 0; d < 3; ++d) step.gravity[d] = gravity_[d];
  if (plane_) {
    step.move[2] = 0;
    step.turn[0] = step.turn[1] = 0;
  }
  return step;
}

void Engine::start(double time) {
  walls_.pose(time);
  rebuild(store.present, false, 0);
  for (int p = 0; p < store.all(); ++p) store.present[p] = Load{};
  trouble_.clear();
  evaluate(time, 0);
  account(0);
  try {
    stop_if_any(trouble_);
  } catch (const RunError& error) {
    if (advanced_) throw;
    throw UserError(std::string("at the start ") + error.what());
  }
  started_ = true;
}

ParticleStep Engine::advance(double time, double dt) {
  ParticleStep result;
  departed.swap(taken_out_);
  taken_out_.clear();
  rebuilds_ = 0;
  wall_impulse.assign(walls_.count(), Vec3::Zero());
  wall_turning = wall_impulse;
  wall_time = dt;
  if (heat_) heat_->restart_account(walls_.count());
  result.removed = removed;
  if (dt <= 0) return result;
  if (total == 0) {  // walls do not wait for particles
    for (int w = 0; w < walls_.count(); ++w) wall_force[w].setZero(), wall_torque[w].setZero();
    wall_total_.setZero();
    move_walls(time, dt);
    return result;
  }
  if (options_.fixed && !settling_) return hold(time, dt);
  if (!started_)
    start(time);
  else if (detached_) {
    walls_.pose(time);
    rebuild(store.present, false, 0);
  }
  const int substeps = std::max(1, static_cast<int>(std::ceil(dt / limit.step * (1 - 1e-12))));
  const double h = dt / substeps;
  acted_ = 0;
  prepare_fluid(h);
  sum_up();
  if (energy_) energy_->begin(store);
  const double late = options_.late_share(), early = 1 - late;
  trouble_.clear();
  static const PetscLogEvent event = log_event("SiltSubsteps");
  auto logged = std::make_optional<Logged>(event);
  for (int s = 0; s < substeps; ++s) {
    impulses.gravity += h * mass_ * gravity_;
    impulses.fluid_force += h * fluid_force_;
    acted_ += h;

    Integration step = pass(h);
    step.correct = s > 0 && late > 0 && !energy_;
    step.drift = true;
    want_turns(step);
    kernels_.integrate(step);
    hear();
    strode_ = way_ = std::sqrt(step.largest_square);
    double farthest = travel_ + strode_;
    if (brownian_.active() && fluid_) {
      const BrownianWay noise = brownian_.act(store, step, time + (s + 1) * h);
      farthest = noise.from_lists;
      way_ += noise.jump;
    }
    if (step.turned)
      for (const auto& field : fields_) field->turn(store, step.turned);
    store.present.swap(store.previous);
    loaded_.swap(loaded_before_);
    few_loaded_before_ = few_loaded_;
    if (!std::isfinite(step.check)) trouble_ = find_bad();
    const double walls_before = walls_.moved();
    move_walls(time + s * h, h);
    strode_ += std::max(0.0, walls_.moved() - walls_before);
    ++steps_since_rebuild_;
    if (agree_on_lists(farthest))
      rebuild(store.previous, true, h);
    else
      halo_.begin(store, way_);  // evaluate() waits for them
    const Vec3 before = wall_total_, drawn = field_total_;
    add_wall_impulses(early * h);
    evaluate(time + (s + 1) * h, h);
    add_wall_impulses(late * h);
    impulses.walls += h * (early * before + late * wall_total_);
    impulses.fields += h * (early * drawn + late * field_total_);
    impulses.exchanged += h * field_size_;
    if (energy_) {
      correct(h);
      account(h);
    }
    if (heat_) heat_->advance(store, contacts, wall_contacts, walls_, periods_, time + (s + 1) * h, h);
  }
  hear();
  if (!energy_) correct(h);
  logged.reset();
  collect_fluid();
  // The positions of each step have been looked at; now the velocities that the last forces left, and temperatures.
  double sum = 0;
  for (int p = 0; p < store.owned; ++p) sum += vec3(store.motion[p].velocity).squaredNorm();
  if (heat_) sum = std::accumulate(heat_->temperatures(store), heat_->temperatures(store) + store.owned, sum);
  if (!std::isfinite(sum)) trouble_ = find_bad();
  stop_if_any(trouble_);
  advanced_ = !settling_;
  // Nobody asks for the cells of particles without a fluid: those that came into another rank's, and cannot leave the
  // domain there, may wait until the lists are made anew.
  if (!migration_.all_at_home(store, !store.acted_on && walls_.closed())) {
    const long long before = removed;
    rebuild(store.present, false, h);
    if (removed > before) {  // the forces that those gone exerted must not act on
      for (int p = 0; p < store.all(); ++p) store.present[p] = Load{};
      evaluate(time + dt, 0);
      account(0);
      stop_if_any(trouble_);
    }
  }
  result.substeps = substeps;
  result.rebuilds = rebuilds_;
  result.removed = removed;
  count_contacts(result);
  return result;
}

}  // namespace silt
