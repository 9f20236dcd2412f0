#include "fluid/compressible/compressible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/nodal_matrix.hpp"
#include "fluid/compressible/surroundings.hpp"
#include "fluid/initial_state.hpp"

namespace silt {

void CompressibleOptions::options(OptionGroup& option) {
  option("gas_constant", gas_constant, "J/(kg K)", "specific gas constant: p = density times it times T", positive);
  option("heat_ratio", heat_ratio, "-", "ratio of the specific heats", Range{1, 3, true, false});
  option("prandtl", prandtl, "-", "Prandtl number of the gas", positive);
  option(
      "viscosity_law", viscosity_law, {"constant", "sutherland"},
      "how the viscosity depends on temperature; sutherland: -fluid_viscosity is that at -fluid_viscosity_temperature");
  option("viscosity_temperature", viscosity_temperature, "K", "temperature of the viscosity given (sutherland)",
         positive);
  option("sutherland_temperature", sutherland_temperature, "K", "Sutherland's constant", positive);
  option("symmetry", symmetry, {"none", "axisymmetric"},
         "axisymmetric: a 2D mesh whose x is the axis and y the distance from it");
  option("march", march, {"time", "steady"},
         "time: accurate in time; steady: towards a steady state, shocks held by the spatial residual alone and the "
         "step grown while Newton finds it easy");
  option("shock_capturing", shock_capturing, "-", "factor of the residual-based viscosity at shocks", non_negative);
  option("expansion_sensor", expansion_sensor, "-",
         "factor of the viscosity on expansions by more than a factor of 2.3 within a cell (nozzle lips)",
         non_negative);
  option("shock_sensor", shock_sensor, "-",
         "factor of a first-order viscosity on compressions by more than a factor of 1.2 within a cell, along the "
         "shock, not "
         "through it: steadies strong shocks along mesh lines (Mach disks)",
         non_negative);
  option("initial_temperature", initial_temperature, "K, formula in x, y, z");
  option("heat_source", heat_source, "W/m3 of mixture, formula in x, y, z, t");
}

Compressible::Compressible(const Mesh& mesh, Options& options, const FluidOptions& fluid, const Vec3& gravity)
    : mesh_(mesh),
      options_([&] {
        CompressibleOptions read;
        options.read("fluid", read);
        for (const char* name : {"density", "heat_capacity", "conductivity", "expansion", "turbulent_energy_source",
                                 "turbulent_dissipation_source"})
          if (options.given(std::string("fluid_") + name))
            throw UserError(fmt::format("-fluid_{} has no meaning with -fluid_type compressible", name));
        for (const char* name : {"initial_pressure", "initial_temperature"})
          if (!options.given(std::string("fluid_") + name) && !options.given("fluid_initial_file"))
            throw UserError(fmt::format("-fluid_{} is missing: compressible flow needs it", name));
        if (fluid.model != "a") throw UserError("-fluid_model b is not available with -fluid_type compressible");
        if (fluid.hydrostatic)
          throw UserError("-fluid_hydrostatic: the pressure of compressible flow always includes the static head");
        if (read.symmetry == "axisymmetric" && mesh.dimension != 2)
          throw UserError("-fluid_symmetry axisymmetric needs a 2D mesh");
        if (read.symmetry == "axisymmetric" && mesh.lower.y() < 0)
          throw UserError(
              fmt::format("-fluid_symmetry axisymmetric: y is the distance from the axis, and the mesh "
                          "reaches y = {:g} m",
                          mesh.lower.y()));
        return read;
      }()),
      order_(fluid.order),
      boundaries_(mesh, options, 1, true, options_.symmetry == "axisymmetric"),
      thermal_(mesh, options, boundaries_),
      system_(mesh, boundaries_, thermal_),
      newton_(system_),
      turbulence_(Turbulence::create(mesh, options, boundaries_, options_.symmetry == "axisymmetric")),
      cell_size_(shortest_edges(mesh)) {
  for (size_t b = 0; b < mesh.boundaries.size(); ++b)
    if (boundaries_.has_pressure(static_cast<int>(b)) && fluid.viscosity == 0)
      throw UserError(
          fmt::format("-boundary_{}_pressure: a gas without viscosity enters at the pressure inside where velocity and "
                      "temperature are given",
                      mesh.boundaries[b]));
  if (turbulence_ && fluid.viscosity == 0) throw UserError("-fluid_turbulence needs -fluid_viscosity above 0");
  viscosity_ = fluid.viscosity;
  model_a_ = true;
  reduced_pressure_ = false;
  load_ = ParticleLoad(mesh.nodes);
  heat_capacity_ = options_.heat_ratio / (options_.heat_ratio - 1) * options_.gas_constant;
  conductivity_ = viscosity_ * heat_capacity_ / options_.prandtl;
  step_.axisymmetric = options_.symmetry == "axisymmetric";
  system_.set_axisymmetric(step_.axisymmetric);
  step_.capturing = {options_.shock_capturing, options_.expansion_sensor, options_.shock_sensor};

  const VectorExpression velocity("fluid_initial_velocity", fluid.initial_velocity);
  const Expression pressure("fluid_initial_pressure", fluid.initial_pressure);
  const Expression temperature("fluid_initial_temperature", options_.initial_temperature);
  const size_t n = mesh.nodes, m = system_.size();
  velocity_.assign(3 * n, 0.0), velocity_change_ = pressure_gradient_ = velocity_;
  pressure_.assign(n, 0.0), temperature_change_ = mach_ = density_field_ = temperature_ = pressure_;
  viscosity_field_ = sound_ = pressure_;
  for (size_t i = 0; i < n; ++i) {
    const Vec3 x = vec3(&mesh.node_coordinates[3 * i]);
    vec3(&velocity_[3 * i]) = velocity(x, 0);
    pressure_[i] = pressure(x, 0);
    temperature_[i] = temperature(x, 0);
  }
  const InitialState start = initial_state(mesh, options, boundaries_, mesh.node_coordinates, true, true);
  if (!start.velocity.empty()) velocity_ = start.velocity;
  if (!start.pressure.empty()) pressure_ = start.pressure;
  if (!start.temperature.empty()) temperature_ = start.temperature;
  bool bad = false;
  for (size_t i = 0; i < n; ++i) {
    if (mesh.dimension == 2) velocity_[3 * i + 2] = 0;
    bad = bad || !(pressure_[i] > 0) || !(temperature_[i] > 0);
  }
  if (mpi_any(bad)) throw UserError("the initial pressure and temperature of a gas must be above 0 everywhere");
  read_sources(options, fluid);
  choose_units(gravity);
  past_.assign(2 * n, 0.0);
  last_capturing_.assign(mesh.cells, 0.0);
  last_normal_.assign(static_cast<size_t>(mesh.dimension) * mesh.cells, 0.0);
  rate_.assign(n * m, 0.0);
  state_.resize(n * m);
  step_.alpha.assign(n, 1.0);
  for (size_t i = 0; i < n; ++i) {
    state_[i * m] = pressure_[i] / p0_;
    for (size_t k = 0; k + 2 < m; ++k) state_[i * m + 1 + k] = velocity_[3 * i + k] / u0_;
    state_[i * m + m - 1] = temperature_[i] / T0_;
  }
  unknown_ = system_.create_vector();
  prepare(0, 0, 1);
  system_.freeze(step_, state_, rate_);
  conserved_ = old_conserved_ = system_.conserved(step_, state_);
  from_state();
  if (!turbulence_) return;
  turbulence_->start(turbulent_flow());
  take_eddy_viscosity();
}

void Compressible::read_sources(const Options& options, const FluidOptions& fluid) {
  if (!options.given("fluid_body_force") && !options.given("fluid_heat_source")) return;
  const auto force = std::make_shared<VectorExpression>("fluid_body_force", fluid.body_force);
  const auto warmth = std::make_shared<Expression>("fluid_heat_source", options_.heat_source);
  source_ = [force, warmth](const Vec3& x, double t, double& mass, Vec3& momentum, double& heat) {
    mass = 0, momentum = (*force)(x, t), heat = (*warmth)(x, t);
  };
}

/// Units of the order of the initial state, so that the rows and the unknowns have comparable sizes.
void Compressible::choose_units(const Vec3& gravity) {
  mass_ = lumped_mass(mesh_);
  const std::vector<double> ones(mesh_.nodes, 1.0);
  p0_ = mesh_.dot(mass_.data(), pressure_.data(), 1) / mesh_.volume;
  T0_ = mesh_.dot(mass_.data(), temperature_.data(), 1) / mesh_.volume;
  u0_ = std::sqrt(options_.gas_constant * T0_);
  density_ = p0_ / (u0_ * u0_);
  GasLaw& law = step_.law;
  law.gamma = options_.heat_ratio;
  law.prandtl = options_.prandtl;
  law.constant_viscosity = options_.viscosity_law == "constant";
  law.sutherland = options_.sutherland_temperature / T0_;
  const double ratio = T0_ / options_.viscosity_temperature;
  const double factor = law.constant_viscosity
                            ? 1
                            : ratio * std::sqrt(ratio) *
                                  (options_.viscosity_temperature + options_.sutherland_temperature) /
                                  (T0_ + options_.sutherland_temperature);
  law.viscosity = viscosity_ * factor * u0_ / p0_;
  for (int i = 0; i < 3; ++i) step_.gravity[i] = i < mesh_.dimension ? gravity[i] / (u0_ * u0_) : 0.0;
}

/// A far field takes what it does not know from the state inside at the start of the step.
void Compressible::let_surroundings_follow(OpenBoundary& outside, const FacetRule& rule, int q, double dt) const {
  const size_t m = system_.size();
  const int dim = mesh_.dimension;
  const Vec3 n = rule.point[q].area.normalized();
  if (outside.enters_sonic(step_.law, n.data(), dim)) return;
  double inside[5] = {};
  for (int a = 0; a < rule.nodes; ++a)
    for (size_t k = 0; k < m; ++k)
      inside[k] += rule.point[q].shape[a] * state_[static_cast<size_t>(rule.node[a]) * m + k];
  const double length = (mesh_.upper - mesh_.lower).norm();
  follow_inside(step_.law, outside, inside[0], inside + 1, inside[m - 1], n.data(), dim, dt * u0_, length);
}

void Compressible::set_outside(double time, double dt) {
  step_.open.assign(boundaries_.facets().size(), {});
  for (size_t f = 0; f < step_.open.size(); ++f) {
    const FacetRule& rule = boundaries_.facets()[f];
    const int b = rule.boundary;
    const BoundaryType type = boundaries_.type(b);
    if (!boundaries_.open(b) && type != BoundaryType::velocity) continue;
    for (int q = 0; q < rule.points; ++q) {
      const Vec3& x = rule.point[q].x;
      OpenBoundary o;
      using enum BoundaryType;
      o.kind = type == pressure            ? OpenBoundary::pressure
               : type == total_pressure    ? OpenBoundary::total_pressure
               : type == mass_flow         ? OpenBoundary::mass_flow
               : type == far_field         ? OpenBoundary::far_field
               : type == supersonic_inflow ? OpenBoundary::supersonic_inflow
               : type == velocity          ? OpenBoundary::velocity
                                           : OpenBoundary::supersonic_outflow;
      if (type == pressure || type == total_pressure || type == far_field || type == supersonic_inflow)
        o.p = boundaries_.given_pressure(b, x, time) / p0_;
      o.has_pressure = boundaries_.has_pressure(b);
      if (o.has_pressure) o.p = boundaries_.given_pressure(b, x, time) / p0_;
      if (type == far_field || type == supersonic_inflow) {
        const Vec3 u = boundaries_.given_velocity(b, x, time) / u0_;
        std::copy_n(u.data(), 3, o.u);
      }
      o.has_temperature = thermal_[b].has_value;
      if (o.has_temperature) o.T = (*thermal_[b].value)(x, time) / T0_;
      if (type == mass_flow) o.inflow = boundaries_.mass_flux(b, x, time) / (p0_ / u0_);
      if (!(o.p > 0) || !(o.T > 0))
        throw RunError(fmt::format("boundary {}: pressure and temperature must be above 0 at t = {:g} s",
                                   mesh_.boundaries[b], time));
      if (type == far_field) let_surroundings_follow(o, rule, q, dt);
      step_.open[f].push_back(o);
    }
  }
}

void Compressible::prepare(double time, double dt, int order) {
  const size_t n = mesh_.nodes, m = system_.size();
  boundaries_.evaluate(time + dt, load_.void_fraction.data());
  set_outside(time + dt, dt);
  step_.alpha = load_.void_fraction;
  step_.alpha_rate = load_.void_fraction_rate;
  for (double& v : step_.alpha_rate) v /= u0_;
  step_.force.assign(n * m, 0.0);
  step_.response.resize(n);
  step_.old_velocity.assign(3 * n, 0.0);
  step_.source.assign(n * m, 0.0);
  step_.prescribed_velocity.assign(3 * n, 0.0);
  step_.prescribed_temperature.assign(n, 0.0);
  thermal_.heat(time + dt, step_.axisymmetric, step_.heat, step_.heat_coefficient);
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k + 2 < m; ++k) {
      step_.force[i * m + 1 + k] = load_.force[3 * i + k] / p0_;
      step_.old_velocity[3 * i + k] = state_[i * m + 1 + k];
      step_.prescribed_velocity[3 * i + k] = boundaries_.velocity()[3 * i + k] / u0_;
    }
    step_.response[i] = load_.response[i] * u0_ / p0_;
    // Heat with its response: heat - response (T - T^n).
    step_.force[i * m + m - 1] =
        (load_.energy[i] + load_.heat[i] + load_.heat_response[i] * T0_ * state_[i * m + m - 1]) / (p0_ * u0_);
    step_.heat[i] /= p0_ * u0_;
    step_.heat_coefficient[i] = (step_.heat_coefficient[i] + load_.heat_response[i]) * T0_ / (p0_ * u0_);
    if (thermal_.fixed()[i]) step_.prescribed_temperature[i] = thermal_.given(static_cast<int>(i), time + dt) / T0_;
    if (source_) {
      double mass = 0, heat = 0;
      Vec3 momentum = Vec3::Zero();
      source_(vec3(&mesh_.node_coordinates[3 * i]), time + dt, mass, momentum, heat);
      step_.source[i * m] = mass * u0_ / p0_;
      for (size_t k = 0; k + 2 < m; ++k) step_.source[i * m + 1 + k] = momentum[static_cast<int>(k)] / p0_;
      step_.source[i * m + m - 1] = heat / (p0_ * u0_);
    }
  }
  if (turbulence_ && dt > 0 && !turbulence_->exchange().empty())
    for (size_t i = 0; i < n; ++i) step_.force[i * m + m - 1] -= turbulence_->exchange()[i] / (p0_ * u0_);
  const double steps = mpi_max(n > 0 ? past_[0] : 0.0);
  if (steps == 0 && dt > 0) {  // what there is at the start leaves room for the particles that are there
    for (size_t i = 0; i < n; ++i) step_.alpha[i] -= dt * load_.void_fraction_rate[i];
    conserved_ = system_.conserved(step_, state_);
    step_.alpha = load_.void_fraction;
  }
  // What the conditions prescribe holds from the guess on.
  system_.impose(step_, state_);
  step_.known.assign(n * m, 0.0);
  step_.rate = 0;
  if (dt <= 0) return;
  const Bdf bdf = difference(dt, order);
  step_.rate = bdf.c0 / u0_;
  for (size_t k = 0; k < n * m; ++k)
    step_.known[k] = ((bdf.c2 != 0 ? bdf.c2 * old_conserved_[k] : 0.0) - bdf.c1 * conserved_[k]) / u0_;
}

/// An impulsive start among particles keeps its momentum and energy with three BDF1 steps (coupling.md).
Bdf Compressible::difference(double dt, int order) const {
  const bool nodes = !past_.empty();
  const double steps = mpi_max(nodes ? past_[0] : 0.0), last = mpi_max(nodes ? past_[1] : 0.0);
  const bool laden = mpi_max(nodes ? *std::max_element(load_.response.begin(), load_.response.end()) : 0.0) > 0;
  return order == 2 && steps >= (laden ? 3 : 1) ? Bdf::second(dt, last) : Bdf::first(dt);
}

double Compressible::norm_scale() const {
  double sum = 0;
  const double size = std::pow(mesh_.volume / static_cast<double>(mesh_.total_cells), 1.0 / mesh_.dimension);
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    const double term = system_.weights()[i] * (step_.rate + 1 / size);
    sum += term * term;
  }
  return std::sqrt(mpi_sum(sum));
}

void Compressible::from_state() {
  const size_t n = mesh_.nodes, m = system_.size();
  for (size_t i = 0; i < n; ++i) {
    const double* s = &state_[i * m];
    double speed2 = 0;
    for (size_t k = 0; k + 2 < m; ++k) {
      velocity_[3 * i + k] = s[1 + k] * u0_;
      speed2 += s[1 + k] * s[1 + k];
    }
    pressure_[i] = s[0] * p0_;
    temperature_[i] = s[m - 1] * T0_;
    density_field_[i] = s[0] / s[m - 1] * p0_ / (u0_ * u0_);
    viscosity_field_[i] = step_.law.mu(s[m - 1]) * p0_ / u0_;
    sound_[i] = std::sqrt(step_.law.gamma * s[m - 1]) * u0_;
    mach_[i] = std::sqrt(speed2) * u0_ / sound_[i];
  }
  find_pressure_gradient();
}

double Compressible::courant_rate() const {
  double rate = 0;
  for (int c = 0; c < mesh_.cells; ++c)
    for (int a = 0; a < mesh_.nodes_per_cell; ++a) {
      const size_t i = mesh_.cell_nodes[static_cast<size_t>(c) * mesh_.nodes_per_cell + a];
      const double sound = std::sqrt(options_.heat_ratio * options_.gas_constant * temperature_[i]);
      rate = std::max(rate, (vec3(&velocity_[3 * i]).norm() + sound) / cell_size_[c]);
    }
  return mpi_max(rate);
}

double Compressible::longest_step(double last) const {
  if (options_.march != "steady") return infinity;
  if (last <= 0) return 10 / courant_rate();
  return last * (last_newton_ <= 4 ? 1.4 : last_newton_ <= 7 ? 1.0 : 0.7);
}

std::unique_ptr<Fluid> make_compressible(const Mesh& mesh, Options& options, const FluidOptions& fluid,
                                         const Vec3& gravity) {
  return std::make_unique<Compressible>(mesh, options, fluid, gravity);
}

}  // namespace silt
