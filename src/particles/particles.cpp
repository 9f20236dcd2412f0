#include "particles/particles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "base/petsc.hpp"
#include "particles/engine.hpp"
#include "particles/insertion/insertion_options.hpp"
#include "particles/swarm_store.hpp"

namespace silt {

struct Particles::Impl : Engine {
  using Engine::Engine;
  SettleOptions settle_options;
  SwarmStore swarm;
};

Particles::Particles(const Mesh& mesh, Options& options, const Vec3& gravity, bool empty)
    : impl_(std::make_unique<Impl>(mesh, options, gravity, empty)) {
  options.read("settle", impl_->settle_options);
}

std::unique_ptr<Particles> Particles::create(const Mesh& mesh, Options& options, const Vec3& gravity, bool empty) {
  if (options.names("insertion", Options::declared<InsertionOptions>()).empty()) return nullptr;
  return std::make_unique<Particles>(mesh, options, gravity, empty);
}

void Particles::settle() { impl_->settle(impl_->settle_options); }

Particles::~Particles() = default;

int Particles::owned() const { return impl_->store.owned; }
long long Particles::total() const { return impl_->total; }
std::int64_t Particles::id(int i) const { return impl_->store.id[i]; }
Map<const Vec3> Particles::position(int i) const { return vec3(std::as_const(impl_->store).motion[i].position); }
Map<const Vec3> Particles::velocity(int i) const { return vec3(std::as_const(impl_->store).motion[i].velocity); }
Map<const Vec3> Particles::spin(int i) const { return vec3(std::as_const(impl_->store).rotation[i].spin); }
double Particles::radius(int i) const { return impl_->store.motion[i].radius; }
double Particles::mass(int i) const { return 1 / impl_->store.motion[i].inverse_mass; }
double Particles::volume(int i) const {
  const double r = radius(i);
  return 4.0 / 3.0 * std::numbers::pi * r * r * r;
}
Columns& Particles::columns() { return impl_->store.columns; }
const Columns& Particles::columns() const { return impl_->store.columns; }
bool Particles::has_heat() const { return impl_->heat() != nullptr; }
double Particles::heat_capacity(int i) const { return impl_->heat()->capacity(impl_->store, i); }
int Particles::material(int i) const { return static_cast<int>(impl_->store.rotation[i].material); }
int Particles::cell(int i) const { return impl_->store.cell[i]; }
FluidAction& Particles::fluid_action(int i) {
  impl_->store.want_actions();
  return impl_->store.action[i];
}

std::shared_ptr<const Particles::Snapshot> Particles::snapshot(bool to_repeat) const {
  return impl_->snapshot(to_repeat);
}
double Particles::bytes(const Snapshot* kept) const {
  double sum = kept ? static_cast<double>(kept->bytes()) : 0;
  for (const auto& [name, bytes] : impl_->bytes()) sum += static_cast<double>(bytes);
  return mpi_sum(sum);
}
std::string Particles::memory(const Snapshot* kept) const {
  const double particles = std::max(1.0, static_cast<double>(total()));
  std::string text = fmt::format("{:.0f} B a particle", bytes(kept) / particles);
  const char* sign = ": ";
  const auto add = [&](const std::string& name, std::size_t bytes) {
    const double each = mpi_sum(static_cast<double>(bytes)) / particles;
    if (each >= 0.5) text += fmt::format("{}{} {:.0f}", sign, name, each), sign = ", ";
  };
  for (const auto& [name, bytes] : impl_->bytes()) add(name, bytes);
  add("last good state", kept ? kept->bytes() : 0);
  return text;
}
void Particles::restore(const Snapshot& snapshot) { impl_->restore(snapshot); }
void Particles::save(CheckpointWriter& to) { impl_->save(to); }
void Particles::load(const CheckpointReader& from, bool elsewhere) { impl_->load(from, elsewhere); }
void Particles::load_columns(const CheckpointReader& from) { impl_->load_columns(from); }
DM Particles::swarm() { return impl_->swarm.refresh(impl_->mesh, impl_->store); }

void Particles::kick(int i, const Vec3& impulse) {
  Motion& motion = impl_->store.motion[i];
  if (impl_->energy()) impl_->energy()->kicked(motion, impulse);
  for (int d = 0; d < 3; ++d) motion.velocity[d] += impulse[d] * motion.inverse_mass;
  impl_->impulses.kicks += impulse;
}

void Particles::add(const std::vector<Seed>& seeds) { impl_->add(seeds); }
void Particles::supply(double time, double dt) { impl_->supply(time, dt); }
ParticleStep Particles::advance(double time, double dt) { return impl_->advance(time, dt); }
const std::vector<Departed>& Particles::departed() const { return impl_->departed; }
double Particles::time_step() const { return impl_->limit.step; }
std::string Particles::time_step_reason() const { return impl_->limit.reason; }
const std::vector<std::string>& Particles::notices() const { return impl_->laws().notices(); }
std::vector<std::string> Particles::warnings() const { return impl_->warnings(); }
const Materials& Particles::materials() const { return impl_->materials; }

Particles::Totals Particles::totals() const {
  const Store& store = impl_->store;
  double sums[10] = {}, fastest = 0;
  for (int p = 0; p < store.owned; ++p) {
    const Motion& motion = store.motion[p];
    const auto x = vec3(motion.position), v = vec3(motion.velocity);
    const double mass = 1 / motion.inverse_mass, square = motion.radius * motion.radius, speed = v.squaredNorm();
    sums[0] += mass;
    sums[1] += square * motion.radius;
    sums[2] += mass * speed;
    sums[3] += mass * square * vec3(store.rotation[p].spin).squaredNorm();
    for (int d = 0; d < 3; ++d) {
      sums[4 + d] += mass * v[d];
      sums[7 + d] += mass * x[d];
    }
    fastest = std::max(fastest, speed);
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 10, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return {sums[0],
          4 * std::numbers::pi / 3 * sums[1],
          0.5 * sums[2],
          0.2 * sums[3],
          Vec3(sums[4], sums[5], sums[6]),
          Vec3(sums[7], sums[8], sums[9]),
          std::sqrt(mpi_max(fastest))};
}
Vec3 Particles::momentum() const { return totals().momentum; }
double Particles::kinetic_energy() const { return totals().kinetic; }
double Particles::rotational_energy() const { return totals().rotational; }
double Particles::total_mass() const { return totals().mass; }
Vec3 Particles::angular_momentum(const Vec3& origin) const {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < owned(); ++i)
    sum += mass(i) * ((position(i) - origin).cross(Vec3(velocity(i))) + 0.4 * radius(i) * radius(i) * spin(i));
  return {mpi_sum(sum[0]), mpi_sum(sum[1]), mpi_sum(sum[2])};
}

double Particles::liquid_volume() const { return mpi_sum(impl_->liquid_volume()); }

Particles::Impulses Particles::take_impulses() {
  Impulses& mine = impl_->impulses;
  Impulses all = mine;
  double values[27];
  Vec3* parts[8] = {&all.gravity, &all.walls, &all.drag,    &all.fluid_force,
                    &all.kicks,   &all.added, &all.removed, &all.fields};
  double* amounts[3] = {&all.added_mass, &all.removed_mass, &all.exchanged};
  for (int k = 0; k < 8; ++k) vec3(&values[3 * k]) = *parts[k];
  for (int k = 0; k < 3; ++k) values[24 + k] = *amounts[k];
  MPI_Allreduce(MPI_IN_PLACE, values, 27, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  for (int k = 0; k < 8; ++k) *parts[k] = vec3(&values[3 * k]);
  for (int k = 0; k < 3; ++k) *amounts[k] = values[24 + k];
  mine = {};
  return all;
}

double Particles::EnergyAccount::residual() const {
  double sum = kinetic + rotational + stored + work[removed];
  for (int m = damping; m < removed; ++m) sum -= work[m];
  return sum;
}

bool Particles::has_energy_account() const { return impl_->energy() != nullptr; }

Particles::EnergyAccount Particles::energy_account() const {
  EnergyAccount account;
  const Totals now = totals();
  account.kinetic = now.kinetic;
  account.rotational = now.rotational;
  if (!impl_->energy()) return account;
  account.work = impl_->energy()->work();
  MPI_Allreduce(MPI_IN_PLACE, account.work.data(), EnergyAccount::mechanisms, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  account.stored = mpi_sum(impl_->energy()->stored());
  return account;
}

std::vector<std::string> Particles::wall_names() const {
  std::vector<std::string> names;
  names.reserve(impl_->walls().count());
  for (int w = 0; w < impl_->walls().count(); ++w) names.push_back(impl_->walls().name(w));
  return names;
}

bool Particles::wall_conducts(int wall) const { return impl_->walls().temperature(wall) != nullptr; }

std::vector<Particles::WallLoad> Particles::wall_loads() const {
  const Walls& walls = impl_->walls();
  const int count = walls.count(), boundaries = static_cast<int>(walls.boundaries().size());
  constexpr std::size_t each = 7;
  std::vector<double> sums(each * static_cast<std::size_t>(count), 0.0);
  for (std::size_t w = 0; w < impl_->wall_impulse.size() && impl_->wall_time > 0; ++w) {
    vec3(&sums[each * w]) = -impl_->wall_impulse[w] / impl_->wall_time;
    vec3(&sums[each * w + 3]) = -impl_->wall_turning[w] / impl_->wall_time;
    if (impl_->heat() && w < impl_->heat()->from_walls().size())
      sums[each * w + 6] = impl_->heat()->from_walls()[w] / impl_->wall_time;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  std::vector<WallLoad> loads(count);
  for (int w = 0; w < count; ++w) {
    loads[w].name = walls.name(w);
    const double* sum = &sums[each * static_cast<std::size_t>(w)];
    loads[w].force = vec3(sum);
    loads[w].torque = vec3(sum + 3);
    loads[w].heat = sum[6];
    if (w < boundaries) continue;
    const RigidWall& wall = walls.rigid()[w - boundaries];
    loads[w].torque -= wall.reference().cross(loads[w].force);
    loads[w].displacement = wall.motion().shift();
    loads[w].angle = wall.motion().angle();
  }
  return loads;
}

}  // namespace silt
