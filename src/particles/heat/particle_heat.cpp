#include "particles/heat/particle_heat.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/physical_constants.hpp"
#include "particles/particles.hpp"

namespace silt {

std::unique_ptr<ParticleHeat> ParticleHeat::create(Options& options, const Materials& materials, Columns& columns) {
  HeatOptions chosen;
  options.read("heat", chosen);
  if (!chosen.particles) return nullptr;
  return std::make_unique<ParticleHeat>(chosen, materials, columns);
}

void ParticleHeat::check(int material) const {
  const Material& m = materials_[material];
  if (!m.heat_capacity)
    throw UserError(fmt::format("-material_{}_heat_capacity is missing: -heat_particles needs it", m.name));
  if (options_.conduction && !m.conductivity)
    throw UserError(fmt::format("-material_{}_conductivity is missing: -heat_conduction needs it", m.name));
}

void ParticleHeat::check(const Walls& walls) const {
  for (int w = 0; w < walls.count(); ++w) {
    const Material& m = materials_[walls.material(w)];
    if (walls.temperature(w) && options_.conduction && !m.conductivity)
      throw UserError(fmt::format("-material_{}_conductivity is missing: the wall {} has a temperature and conducts",
                                  m.name, walls.name(w)));
  }
}

ParticleHeat::ParticleHeat(const HeatOptions& options, const Materials& materials, Columns& columns)
    : options_(options),
      materials_(materials),
      source_("heat_source", options.source),
      environment_("heat_environment", options.environment),
      initial_(std::make_shared<Expression>("heat_initial_temperature", options.initial_temperature)) {
  ColumnRequest request{"temperature", 1, options.conduction ? GhostValues::every_step : GhostValues::none, true, {}};
  request.start = [initial = initial_](const Seed& seed, double* row) { *row = (*initial)(seed.position, 0); };
  temperature_ = columns.add(request);
  fluid_temperature_ = columns.add({"fluid_temperature", 1, GhostValues::none, false, {}});
  exchange_ = columns.add({"heat_exchange", 1, GhostValues::none, false, {}});
  received_ = columns.add({"heat_received", 1, GhostValues::none, false, {}});
}

void ParticleHeat::conduct(Store& store, const ContactLists& contacts, const Periods& periods) {
  const double* temperature = store.columns.values(temperature_);
  const bool lens = options_.contact_radius == "lens";
  for (int k = 0; k < contacts.contacts(); ++k) {
    const int i = contacts.contact_i()[k], j = contacts.contact_j()[k];
    const Motion &a = store.motion[i], &b = store.motion[j];
    double square = 0;
    for (int d = 0; d < 3; ++d) {
      double apart = a.position[d] - b.position[d];
      apart -= periods.length[d] * std::nearbyint(apart * periods.inverse[d]);
      square += apart * apart;
    }
    const double distance = std::sqrt(square), overlap = a.radius + b.radius - distance;
    if (!(overlap > 0)) continue;
    double area;  // over pi
    if (lens) {
      const double plane = 0.5 * (a.radius * a.radius - b.radius * b.radius + square) / distance;
      area = a.radius * a.radius - plane * plane;
    } else {
      area = a.radius * b.radius / (a.radius + b.radius) * overlap;
    }
    const double flow =
        conductance(area, static_cast<int>(store.rotation[i].material), static_cast<int>(store.rotation[j].material)) *
        (temperature[j] - temperature[i]);
    gain_[i] += flow;
    gain_[j] -= flow;
  }
}

double ParticleHeat::conductance(double area, int first, int second) const {
  const Material &one = materials_[first], &other = materials_[second];
  double radius = std::sqrt(std::max(area, 0.0));
  if (options_.real_young_modulus)
    radius *= std::pow(0.5 * (one.young_modulus + other.young_modulus) / *options_.real_young_modulus, 0.2);
  return 4 * radius / (1 / one.conductivity.value() + 1 / other.conductivity.value());
}

void ParticleHeat::conduct_from_walls(Store& store, const WallContacts& at_walls, const Walls& walls, double time,
                                      double dt) {
  const double* temperature = store.columns.values(temperature_);
  const bool lens = options_.contact_radius == "lens";
  for (const WallPoint& point : at_walls.points()) {
    const Expression* wall = walls.temperature(point.boundary);
    const int p = point.particle;
    const double r = store.motion[p].radius, overlap = r - point.distance;
    if (!wall || !(overlap > 0)) continue;
    const Vec3 spot = vec3(store.motion[p].position) - point.distance * vec3(point.normal);
    const double flow = conductance(lens ? r * r - point.distance * point.distance : r * overlap,
                                    static_cast<int>(store.rotation[p].material), point.material) *
                        ((*wall)(spot, time) - temperature[p]);
    gain_[p] += flow;
    from_walls_[static_cast<std::size_t>(point.boundary)] += flow * dt;
  }
}

void ParticleHeat::advance(Store& store, const ContactLists& contacts, const WallContacts& at_walls, const Walls& walls,
                           const Periods& periods, double time, double dt) {
  gain_.assign(static_cast<std::size_t>(store.all()) + 2, 0.0);
  if (options_.conduction) {
    conduct(store, contacts, periods);
    conduct_from_walls(store, at_walls, walls, time - dt, dt);
  }
  double* temperature = store.columns.values(temperature_);
  const double* outside = store.columns.values(fluid_temperature_);
  const double* exchange = store.columns.values(exchange_);
  double* received = store.columns.values(received_);
  const bool made = !(source_.constant() && source_(Vec3::Zero(), 0) == 0);
  for (int p = 0; p < store.owned; ++p) {
    const Motion& motion = store.motion[p];
    const Vec3 x = vec3(motion.position);
    double gain = gain_[p];
    const double T = temperature[p], r = motion.radius;
    if (made) gain += source_(x, time - dt) * 4.0 / 3.0 * std::numbers::pi * r * r * r;
    if (options_.emissivity > 0)
      gain += options_.emissivity * stefan_boltzmann_constant * 4 * std::numbers::pi * r * r *
              (std::pow(environment_(x, time - dt), 4) - T * T * T * T);
    const double capacity = this->capacity(store, p), z = exchange[p] * dt / capacity;
    // dT = ((T_f - T) + gain/(h A)) (1 - exp(-z)), and its limit without exchange.
    const double relaxed = z > 0 ? -std::expm1(-z) : 0, share = z > 1e-12 ? relaxed / z : 1;
    const double change = relaxed * (outside[p] - T) + share * gain * dt / capacity;
    temperature[p] += change;
    received[p] += capacity * change - gain * dt;
  }
}

double ParticleHeat::conduction_time(double radius, int material) const {
  const Material& m = materials_[material];
  if (!options_.conduction || radius >= infinity) return infinity;
  // Twelve neighbours, each through a contact of half the radius: C/(12 * 2 a lambda).
  const double capacity = *m.density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * *m.heat_capacity;
  return capacity / (12 * 2 * 0.5 * radius * *m.conductivity);
}

}  // namespace silt
