#include "coupling/coupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace silt {
namespace {

/// Adds up some vectors and numbers over all ranks in one message.
class GlobalSums {
 public:
  void add(Vec3& v) {
    for (int d = 0; d < 3; ++d) add(v[d]);
  }
  void add(double& x) {
    places_.push_back(&x);
    values_.push_back(x);
  }
  void sum() {
    MPI_Allreduce(MPI_IN_PLACE, values_.data(), static_cast<int>(values_.size()), MPI_DOUBLE, MPI_SUM,
                  PETSC_COMM_WORLD);
    for (std::size_t k = 0; k < values_.size(); ++k) *places_[k] = values_[k];
  }

 private:
  std::vector<double*> places_;
  std::vector<double> values_;
};

constexpr int load_components = 6;  // volume, response, impulse, volume that follows

}  // namespace

Coupling::Coupling(const Mesh& mesh, Particles& particles, Fluid& fluid, Options& options, const Vec3& gravity)
    : mesh_(mesh),
      particles_(particles),
      fluid_(fluid),
      gravity_(gravity),
      locator_(mesh),
      kernel_(mesh),
      void_fraction_(mesh),
      mass_(lumped_mass(mesh)),
      properties_(mesh, fluid) {
  options.read("coupling", options_);
  drag_ = DragModels::read(options, "drag", "gidaspow", "drag law of the particles");
  forces_ = std::make_unique<FluidForces>(mesh, mass_, options, options_.viscous_stress);
  thermophoresis_ = Thermophoresis::create(mesh, mass_, fluid, options);
  dispersion_ = Dispersion::create(fluid, particles, options);
  modulation_ = TurbulenceModulation::create(mesh, mass_, fluid, options);
  if (particles.has_heat() && !fluid.temperature().empty())
    heat_ = std::make_unique<HeatExchange>(mesh, mass_, particles, fluid, options);
  if (fluid.total_energy()) work_ = std::make_unique<WorkExchange>(mesh, mass_, particles, fluid);
  if (mesh.dimension == 2) {
    if (!options_.depth)
      throw UserError("coupling_depth: give the thickness in m that the 2D mesh stands for; particles have a volume");
    depth_ = *options_.depth;
  } else if (options_.depth) {
    throw UserError("-coupling_depth is the thickness that a 2D mesh stands for; this one is in space");
  }
  const bool drag = std::visit([](const auto& law) { return std::string(law.name) != "none"; }, drag_);
  if (!(fluid.viscosity() > 0) && (drag || heat_))
    throw UserError(
        "-fluid_viscosity 0: drag and heat transfer have no laws without a viscosity; give one, or -drag_type none and "
        "-heat_particles no");
  take_void_fraction();
}

Coupling::~Coupling() = default;

void Coupling::prepare_filter() {
  double largest = 0;
  for (int p = 0; p < particles_.owned(); ++p) largest = std::max(largest, 2 * particles_.radius(p));
  largest = mpi_max(largest);
  // A user's length does not depend on the particles; the automatic one follows a larger particle when it appears.
  const bool changed = largest > diameter_ * (1 + 1e-9);
  diameter_ = std::max(diameter_, largest);
  if (filter_ && (options_.filter_length || !changed)) return;
  filter_ = std::make_unique<Filter>(
      mesh_, mass_,
      options_.filter_length ? uniform_diffusivity(*options_.filter_length) : automatic_diffusivity(mesh_, diameter_));
}

void Coupling::place_particles() {
  const int count = particles_.owned();
  kernel_.resize(count);
  bool outside = false;
  for (int p = 0; p < count; ++p) {
    const auto x = particles_.position(p);
    const int hint = particles_.cell(p);
    const Place place = locator_.find(x.data(), hint);
    double xi[3];
    if (place.inside()) {
      kernel_.place(p, place.cell, place.xi.data());
    } else if (hint >= 0 && locator_.reference(hint, x.data(), xi)) {
      // A tie with a lower rank: the engine keeps it here until it looks again, and the weights of this cell are the
      // same.
      const bool near =
          *std::min_element(xi, xi + mesh_.dimension) > -1e-6 && *std::max_element(xi, xi + mesh_.dimension) < 1 + 1e-6;
      outside = outside || !near;
      kernel_.place(p, hint, xi);
    } else {
      outside = true;
      kernel_.place(p, 0, place.xi.data());
    }
  }
  if (mpi_any(outside))
    throw RunError("a particle lies in no cell of the rank that holds it: the coupling cannot place it");
}

void Coupling::place_clamped(int p, int cell, const Vec3& x) {
  double xi[3] = {0, 0, 0};
  locator_.reference(cell, x.data(), xi);
  double sum = 0;
  for (int d = 0; d < mesh_.dimension; ++d) sum += xi[d] = std::clamp(xi[d], 0.0, 1.0);
  const bool simplex = mesh_.cell == Cell::triangle || mesh_.cell == Cell::tetrahedron;
  if (simplex && sum > 1) {
    for (double& s : xi) s /= sum;
  }
  kernel_.place(p, cell, xi);
}

void Coupling::start() {
  take_void_fraction();
  const int count = particles_.owned();
  at_particles_.resize(3 * static_cast<std::size_t>(count));
  for (int p = 0; p < count; ++p)
    for (int d = 0; d < 3; ++d) at_particles_[3 * p + d] = particles_.volume(p) * particles_.velocity(p)[d];
  nodal_.resize(3 * static_cast<std::size_t>(mesh_.nodes));
  kernel_.deposit(at_particles_, nodal_, 3);
  for (std::size_t k = 0; k < nodal_.size(); ++k) nodal_[k] /= mass_[k / 3] * depth_;
  filter_->apply(nodal_.data(), 3);
  fluid_.meet_continuity(nodal_);
}

void Coupling::take_void_fraction() {
  prepare_filter();
  place_particles();
  const int count = particles_.owned();
  at_particles_.resize(count);
  nodal_.resize(mesh_.nodes);
  for (int p = 0; p < count; ++p) at_particles_[p] = particles_.volume(p);
  kernel_.deposit(at_particles_, nodal_, 1);
  for (int i = 0; i < mesh_.nodes; ++i) nodal_[i] /= mass_[i] * depth_;
  filter_->apply(nodal_.data(), 1);
  void_fraction_.start(nodal_, options_.void_fraction_minimum);
  const auto alpha = void_fraction_.previous();
  std::copy(alpha.begin(), alpha.end(), fluid_.load().void_fraction.begin());
}

void Coupling::restored(double largest_diameter, double last_step) {
  last_step_ = last_step;
  if (largest_diameter > diameter_) {
    diameter_ = largest_diameter;
    filter_.reset();
    prepare_filter();
  }
  const auto alpha = void_fraction_.previous();
  std::copy(alpha.begin(), alpha.end(), fluid_.load().void_fraction.begin());
}

void Coupling::before_particles(double dt) {
  place_particles();
  const int count = particles_.owned();
  const auto velocity = fluid_.carrying_velocity();
  nodal_.assign(velocity.begin(), velocity.end());
  filter_->apply(nodal_.data(), 3);
  at_particles_.resize(4 * static_cast<std::size_t>(count));
  const std::span<double> u(at_particles_.data(), 3 * static_cast<std::size_t>(count)),
      alpha(u.data() + u.size(), count);
  kernel_.sample(nodal_, u, 3);
  const auto given = fluid_.given_void_fraction();
  kernel_.sample(given.empty() ? void_fraction_.previous() : given, alpha, 1);
  if (dispersion_) dispersion_->act(fluid_, *filter_, kernel_, particles_, dt, u);

  properties_.sample(*filter_, kernel_);
  // Model B leaves the whole pressure gradient to the fluid; its drag is then that of model A over alpha (Zhou et al.
  // 2010).
  const bool model_a = fluid_.model_a();
  // The static head acts on a particle by -V_p grad p when model A's pressure holds it, else here. The fluid has its
  // part of it: none when gravity is left out of its equation, rho g (gravity and the reaction of the buoyancy) in
  // model B.
  const bool buoyant = fluid_.reduced_pressure() || !model_a;
  ledger_ = ExchangeLedger{};
  exchanged_ = 0;
  std::visit(
      [&](const auto& law) {
        for (int p = 0; p < count; ++p) {
          FluidAction& action = particles_.fluid_action(p);
          const auto v = particles_.velocity(p);
          const double* w = &u[3 * p];
          const double speed = (vec3(w) - v).norm();
          const double density = properties_.density(p);
          const double k = law.exchange({2 * particles_.radius(p), alpha[p], density, properties_.viscosity(p), speed,
                                         properties_.mach(p, speed)});
          action.exchange = model_a ? k : k / alpha[p];
          const double displaced = buoyant ? density * particles_.volume(p) : 0;
          for (int d = 0; d < 3; ++d) {
            action.velocity[d] = w[d];
            action.force[d] = action.owed[d] / dt - displaced * gravity_[d];
            action.impulse[d] = action.field_impulse[d] = 0;
            action.start_velocity[d] = v[d];
            ledger_.delivered[d] += action.owed[d];
            ledger_.buoyancy[d] -= displaced * gravity_[d] * dt;
          }
        }
      },
      drag_);
  for (int p = 0; p < count; ++p) vec3(particles_.fluid_action(p).reaction).setZero();
  if (forces_->any()) forces_->act(fluid_, properties_, *filter_, kernel_, particles_, last_step_);
  if (thermophoresis_) thermophoresis_->act(fluid_, properties_, *filter_, kernel_, particles_);
  if (heat_) heat_->before_particles(properties_, *filter_, kernel_, alpha);
}

void Coupling::before_fluid(double dt) {
  prepare_filter();
  place_particles();
  const int count = particles_.owned();
  // Those that left in this step gave the fluid their impulse too: it goes to the last place they had.
  const std::vector<Departed>& departed = particles_.departed();
  const int all = count + static_cast<int>(departed.size());
  kernel_.resize(all);
  responses_.resize(count);
  at_particles_.assign(load_components * static_cast<std::size_t>(all), 0.0);
  nodal_.resize(load_components * static_cast<std::size_t>(mesh_.nodes));
  ledger_.particle_volume = 0;
  ledger_.drag_on_particles.setZero();
  ledger_.forces_on_particles.setZero();
  ledger_.drag_on_fluid.setZero();
  exchanged_ = 0;
  for (int p = 0; p < count; ++p) {
    FluidAction& action = particles_.fluid_action(p);
    const double mass = particles_.mass(p), volume = particles_.volume(p);
    const Vec3 force = vec3(action.force) + mass * gravity_ + vec3(action.field_impulse) / dt;
    const double h = held(vec3(action.start_velocity), particles_.velocity(p), vec3(action.velocity), force,
                          mass + action.added_mass, action.exchange, dt, action.held);
    responses_[p] = response(mass, action.exchange, h, dt, action.added_mass);
    double* q = &at_particles_[load_components * static_cast<std::size_t>(p)];
    q[0] = volume;
    q[1] = responses_[p].mass;
    for (int d = 0; d < 3; ++d) {
      q[2 + d] = action.impulse[d] + dt * action.reaction[d];
      ledger_.drag_on_particles[d] += action.impulse[d];
      ledger_.forces_on_particles[d] += dt * action.reaction[d];
    }
    // A free particle takes on the share 1 - exp(-k dt/m) of a change of the flow, and its volume with it.
    q[5] = volume * (1 - h) * responses_[p].free / mass;
    ledger_.particle_volume += volume;
    exchanged_ += vec3(&q[2]).norm();
  }
  for (int p = count; p < all; ++p) {
    const Departed& gone = departed[p - count];
    place_clamped(p, gone.cell, gone.position);
    double* q = &at_particles_[load_components * static_cast<std::size_t>(p)];
    for (int d = 0; d < 3; ++d) {
      q[2 + d] = gone.action.impulse[d] + gone.acted * gone.action.reaction[d];
      ledger_.drag_on_particles[d] += gone.action.impulse[d];
      ledger_.forces_on_particles[d] += gone.acted * gone.action.reaction[d];
    }
    exchanged_ += vec3(&q[2]).norm();
  }
  if (modulation_) modulation_->before_fluid(depth_, *filter_, kernel_, particles_, fluid_);
  if (heat_) heat_->before_fluid(dt, depth_, *filter_, kernel_);
  if (work_) work_->before_fluid(dt, depth_, *filter_, kernel_);
  kernel_.deposit(at_particles_, nodal_, load_components);
  for (int i = 0; i < mesh_.nodes; ++i) {
    for (int c = 0; c < load_components; ++c) nodal_[load_components * i + c] /= mass_[i] * depth_;
  }
  filter_->apply(nodal_.data(), load_components);
  kernel_.resize(count);

  ParticleLoad& load = fluid_.load();
  solids_.resize(mesh_.nodes);
  for (int i = 0; i < mesh_.nodes; ++i) {
    const double* f = &nodal_[load_components * static_cast<std::size_t>(i)];
    solids_[i] = f[0];
    load.response[i] = mass_[i] * f[1] / dt;
    for (int d = 0; d < 3; ++d) load.force[3 * i + d] = -mass_[i] * f[2 + d] / dt;
    load.following[i] = f[5];
  }
  void_fraction_.advance(solids_, dt, options_.void_fraction_minimum, load.void_fraction, load.void_fraction_rate);
  for (int i = 0; i < mesh_.owned_nodes; ++i) ledger_.drag_on_fluid += depth_ * dt * vec3(&load.force[3 * i]);
  if (fluid_.total_energy() && !warned_) watch_following();
}

void Coupling::watch_following() {
  const ParticleLoad& load = fluid_.load();
  double most = 0;
  for (int i = 0; i < mesh_.owned_nodes; ++i) most = std::max(most, load.following[i] / load.void_fraction[i]);
  most = mpi_max(most);
  if (!(most > 1)) return;
  warned_ = true;
  warning_ = fmt::format(
      "warning: free powder so dense and fine that it follows the gas within a step, (1 - alpha)(1 - exp(-k dt/m)) = "
      "{:.3g} alpha somewhere: a compressible gas may oscillate above 1; take a shorter -time_step",
      most);
}

void Coupling::after_fluid(double dt) {
  const int count = kernel_.count();
  const bool model_a = fluid_.model_a();
  const int components = model_a ? 6 : 3;
  const auto change = fluid_.velocity_change(), gradient = fluid_.pressure_gradient();
  const ParticleLoad& load = fluid_.load();
  nodal_.resize(components * static_cast<std::size_t>(mesh_.nodes));
  for (int i = 0; i < mesh_.nodes; ++i) {
    for (int d = 0; d < 3; ++d) {
      nodal_[components * i + d] = change[3 * i + d];
      if (model_a) nodal_[components * i + 3 + d] = gradient[3 * i + d];
    }
  }
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    // Not 1 - alpha, whose round-off is that of 1: a lone particle must balance too.
    const double solids = mass_[i] * solids_[i] * depth_;
    ledger_.deposited_volume += solids;
    for (int d = 0; d < 3; ++d) {
      ledger_.response_on_fluid[d] -= depth_ * dt * load.response[i] * change[3 * i + d];
      if (model_a) ledger_.pressure_on_fluid[d] += dt * solids * gradient[3 * i + d];
    }
  }
  filter_->apply(nodal_.data(), components);
  at_particles_.resize(components * static_cast<std::size_t>(count));
  kernel_.sample(nodal_, at_particles_, components);
  if (work_) work_->after_fluid(dt, depth_, *filter_, kernel_);
  for (int p = 0; p < count; ++p) {
    FluidAction& action = particles_.fluid_action(p);
    const double* f = &at_particles_[components * static_cast<std::size_t>(p)];
    const Response& r = responses_[p];
    const Vec3 owed = r.mass * vec3(f), at_once = (1 - r.held) * r.free * vec3(f);
    Vec3 pressure = Vec3::Zero();
    if (model_a) pressure = -particles_.volume(p) * dt * vec3(f + 3);
    action.held = r.held;
    vec3(action.owed) = owed - at_once + pressure;
    if (work_) work_->settle(p, r.mass, at_once, pressure);
    particles_.kick(p, at_once);
    ledger_.response_on_particles += owed;
    ledger_.pressure_on_particles += pressure;
    ledger_.given_at_once += at_once;
    ledger_.in_transit += vec3(action.owed);
    exchanged_ += owed.norm() + pressure.norm();
  }
  if (work_) work_->close(dt, depth_);
  if (heat_) heat_->after_fluid(dt, depth_, *filter_, kernel_);
  void_fraction_.commit(load.void_fraction);
  last_step_ = dt;

  GlobalSums sums;
  for (Vec3* v : {&ledger_.drag_on_particles, &ledger_.forces_on_particles, &ledger_.drag_on_fluid,
                  &ledger_.response_on_particles, &ledger_.response_on_fluid, &ledger_.pressure_on_particles,
                  &ledger_.pressure_on_fluid, &ledger_.buoyancy, &ledger_.given_at_once, &ledger_.delivered,
                  &ledger_.in_transit}) {
    sums.add(*v);
  }
  sums.add(ledger_.particle_volume);
  sums.add(ledger_.deposited_volume);
  sums.add(exchanged_);
  sums.sum();
  const double imbalance =
      std::max({(ledger_.drag_on_particles + ledger_.forces_on_particles + ledger_.drag_on_fluid).norm(),
                (ledger_.response_on_particles + ledger_.response_on_fluid).norm(),
                (ledger_.pressure_on_particles + ledger_.pressure_on_fluid).norm()});
  if (!std::isfinite(exchanged_))  // std::max would lose it
    throw RunError("what fluid and particles exchanged is not a number: one of them has become non-finite");
  const char* what = "the exchange between fluid and particles";
  ledger_.residual =
      std::max(balanced(what, imbalance, exchanged_),
               balanced(what, std::abs(ledger_.deposited_volume - ledger_.particle_volume), ledger_.particle_volume));
}

std::string Coupling::description() const {
  const std::string law = std::visit([](const auto& chosen) { return std::string(chosen.name); }, drag_);
  const std::string width = options_.filter_length ? fmt::format("length {:.4g} m", *options_.filter_length)
                            : diameter_ > 0 ? fmt::format("two diameters ({:.4g} m), at least two cells", 2 * diameter_)
                                            : std::string("two diameters of the largest particle, at least two cells");
  return fmt::format("drag {}{}{}{}{}, model {}, filter {} in {} passes", law, forces_->description(),
                     thermophoresis_ ? ", thermophoresis " + thermophoresis_->name() : "",
                     (dispersion_ ? ", dispersion " + dispersion_->name() : "") +
                         (modulation_ ? ", turbulence " + modulation_->name() : ""),
                     heat_ ? ", heat by " + heat_->name() : "", fluid_.model_a() ? "A" : "B", width, filter_->passes());
}

}  // namespace silt
