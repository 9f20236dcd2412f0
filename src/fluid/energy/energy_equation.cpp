#include "fluid/energy/energy_equation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"

namespace silt {

void EnergyOptions::options(OptionGroup& option) {
  option("heat_capacity", heat_capacity, "J/(kg K)", "specific heat capacity of the fluid at constant pressure",
         positive);
  option("conductivity", conductivity, "W/(m K)", "thermal conductivity of the fluid", non_negative);
  option("expansion", expansion, "1/K", "thermal expansion, which makes warm fluid rise (Boussinesq); 0: none");
  option("reference_temperature", reference_temperature, "K",
         "temperature at which the density is the one given; heat is counted from it");
  option("initial_temperature", initial_temperature, "K, formula in x, y, z");
  option("heat_source", heat_source, "W/m3 of mixture, formula in x, y, z, t");
  option("energy_supg", energy_supg, "-", "factor of the streamline stabilisation of the temperature", non_negative);
}

std::unique_ptr<EnergyEquation> EnergyEquation::create(const Mesh& mesh, Options& options, bool wanted, double density,
                                                       const Vec3& gravity, const BoundaryConditions& boundaries,
                                                       int table_order) {
  if (wanted) return std::make_unique<EnergyEquation>(mesh, options, density, gravity, boundaries, table_order);
  for (const auto& name : Options::declared<EnergyOptions>())
    if (options.given("fluid_" + name))
      throw UserError(fmt::format("-fluid_{} has no meaning without -fluid_energy yes", name));
  for (const auto& boundary : mesh.boundaries)
    for (const auto& name : Options::declared<TemperatureOptions>())
      if (options.given("boundary_" + boundary + "_temperature_" + name))
        throw UserError(
            fmt::format("-boundary_{}_temperature_{} has no meaning without -fluid_energy yes", boundary, name));
  return nullptr;
}

EnergyEquation::EnergyEquation(const Mesh& mesh, Options& options, double density, const Vec3& gravity,
                               const BoundaryConditions& boundaries, int table_order)
    : mesh_(mesh),
      options_([&] {
        EnergyOptions read;
        options.read("fluid", read);
        for (const char* name : {"heat_capacity", "conductivity", "initial_temperature"})
          if (!options.given(std::string("fluid_") + name))
            throw UserError(fmt::format("-fluid_{} is missing: the energy equation needs it", name));
        if (read.expansion != 0 && !options.given("fluid_reference_temperature"))
          throw UserError("-fluid_reference_temperature is missing: -fluid_expansion needs it");
        return read;
      }()),
      density_(density),
      gravity_(gravity),
      boundaries_(boundaries),
      source_("fluid_heat_source", options_.heat_source),
      transport_(mesh, "fluid_energy_", table_order),
      mass_(lumped_mass(mesh)) {
  read_conditions(options);
  find_fixed();
  const Expression initial("fluid_initial_temperature", options_.initial_temperature);
  temperature_.resize(mesh.nodes);
  for (int i = 0; i < mesh.nodes; ++i)
    temperature_[i] = initial(vec3(&mesh.node_coordinates[3 * static_cast<size_t>(i)]), 0);
  old_temperature_ = next_ = temperature_;
  change_.assign(mesh.nodes, 0.0);
  started_.assign(mesh.nodes, 0.0);
  for (auto* field : {&void_fraction_, &old_void_fraction_, &next_void_fraction_}) field->assign(mesh.nodes, 1.0);
  heat_flow_.assign(mesh.boundaries.size(), 0.0);
}

void EnergyEquation::read_conditions(Options& options) {
  for (size_t b = 0; b < mesh_.boundaries.size(); ++b) {
    const std::string& name = mesh_.boundaries[b];
    const std::string prefix = "boundary_" + name + "_temperature";
    TemperatureOptions read;
    options.read(prefix, read);
    const BoundaryType flow = boundaries_.type(static_cast<int>(b));
    const bool inflow = flow == BoundaryType::velocity || flow == BoundaryType::mass_flow;
    const bool open = flow == BoundaryType::pressure;
    if (read.type.empty()) read.type = inflow ? "given" : "adiabatic";
    Condition c;
    c.kind = read.type == "given"           ? Condition::given
             : read.type == "flux"          ? Condition::flux
             : read.type == "heat_transfer" ? Condition::heat_transfer
                                            : Condition::adiabatic;
    if (open && c.kind != Condition::adiabatic)
      throw UserError(
          fmt::format("-{}_type: on a boundary of type pressure heat leaves with the fluid; only {}_value, "
                      "the temperature of fluid that enters, can be given",
                      prefix, prefix));
    const auto check = [&](const char* property, bool allowed, bool required) {
      const std::string option = prefix + "_" + property;
      if (options.given(option) && !allowed)
        throw UserError(fmt::format("-{} has no meaning with -{}_type {}", option, prefix, read.type));
      if (required && !options.given(option))
        throw UserError(
            fmt::format("-{} is missing: the temperature condition of boundary {} is {}", option, name, read.type));
    };
    const bool outside = c.kind == Condition::given || c.kind == Condition::heat_transfer;
    check("value", outside || open, outside);
    check("flux", c.kind == Condition::flux, c.kind == Condition::flux);
    check("coefficient", c.kind == Condition::heat_transfer, c.kind == Condition::heat_transfer);
    c.has_value = options.given(prefix + "_value");
    c.value = std::make_unique<Expression>(prefix + "_value", read.value);
    c.flux_density = std::make_unique<Expression>(prefix + "_flux", read.flux);
    c.coefficient = std::make_unique<Expression>(prefix + "_coefficient", read.coefficient);
    conditions_.push_back(std::move(c));
  }
}

/// A node between boundaries takes the temperature of the one whose flow condition is the strongest.
void EnergyEquation::find_fixed() {
  fixed_.assign(mesh_.nodes, 0);
  fixed_boundary_.assign(mesh_.nodes, -1);
  std::vector<int> best(mesh_.nodes, std::numeric_limits<int>::max());
  std::vector<double> touch(mesh_.nodes);
  for (size_t b = 0; b < conditions_.size(); ++b) {
    if (conditions_[b].kind != Condition::given) continue;
    std::fill(touch.begin(), touch.end(), 0.0);
    for (const auto& facet : boundaries_.facets())
      if (facet.boundary == static_cast<int>(b))
        for (int a = 0; a < facet.nodes; ++a) touch[facet.node[a]] = 1;
    mesh_.sum_shared(touch.data(), 1);
    const int strength = boundaries_.strength(static_cast<int>(b));
    for (int i = 0; i < mesh_.nodes; ++i)
      if (touch[i] > 0 && strength < best[i]) {
        best[i] = strength;
        fixed_[i] = 1;
        fixed_boundary_[i] = static_cast<int>(b);
      }
  }
}

void EnergyEquation::add_buoyancy(const Bdf& bdf, const std::vector<double>& void_fraction, bool model_a,
                                  std::vector<double>& force) const {
  if (!buoyant()) return;
  for (int i = 0; i < mesh_.nodes; ++i) {
    const double T = bdf.e1 * temperature_[i] - bdf.e2 * old_temperature_[i];
    const double share = model_a ? void_fraction[i] : 1.0;
    vec3(&force[3 * static_cast<size_t>(i)]) -=
        share * density_ * options_.expansion * (T - options_.reference_temperature) * gravity_;
  }
}

int EnergyEquation::solve(double time, const Bdf& bdf, double dt, const ParticleLoad& load,
                          const std::vector<double>& flux, const std::vector<double>& outflow) {
  const int n = mesh_.nodes;
  const double capacity = density_ * options_.heat_capacity, end = time + dt;
  const auto position = [&](int i) { return vec3(&mesh_.node_coordinates[3 * static_cast<size_t>(i)]); };
  if (mpi_max(n > 0 ? started_[0] : 0.0) == 0)
    void_fraction_ = old_void_fraction_ = [&] {
      std::vector<double> before = load.void_fraction;  // alpha^n of the first step
      for (int i = 0; i < n; ++i) before[i] -= dt * load.void_fraction_rate[i];
      return before;
    }();
  next_void_fraction_ = load.void_fraction;

  std::vector<double> mass(n), known(n), diffusivity(n), reaction(n), density(n), at_node(n), coefficient(n);
  double given = 0;
  for (int i = 0; i < n; ++i) {
    const double now = bdf.c1 * void_fraction_[i], old = bdf.c2 * old_void_fraction_[i];
    const double q = source_(position(i), end);
    mass[i] = capacity * (now - old);
    known[i] = -capacity * (now * temperature_[i] - old * old_temperature_[i]) - q;
    diffusivity[i] = load.void_fraction[i] * options_.conductivity;
    coefficient[i] = load.heat_response[i];
    at_node[i] = load.heat[i] + load.heat_response[i] * temperature_[i];
    reaction[i] = coefficient[i] / mass_[i];
    density[i] = at_node[i] / mass_[i];
    if (i < mesh_.owned_nodes) given += mass_[i] * q;
  }
  source_total_ = mpi_sum(given);
  TransportData data;
  data.flux = flux.data();
  data.carried = capacity;
  data.mass = mass.data(), data.known = known.data(), data.diffusivity = diffusivity.data();
  data.reaction = reaction.data(), data.load = density.data();
  data.supg = options_.energy_supg;
  transport_.assemble(data);

  // What boundaries give, at their nodes; `conducted` keeps it apart for each of them.
  std::vector<double> gain(2 * static_cast<size_t>(n), 0.0);
  for (const auto& facet : boundaries_.facets()) {
    const Condition& c = conditions_[facet.boundary];
    if (c.kind != Condition::flux && c.kind != Condition::heat_transfer) continue;
    for (int p = 0; p < facet.points; ++p) {
      const FacetPoint& point = facet.point[p];
      const double area = point.area.norm();
      const bool transfer = c.kind == Condition::heat_transfer;
      const double h = transfer ? (*c.coefficient)(point.x, end) : 0.0;
      const double q = transfer ? h * (*c.value)(point.x, end) : (*c.flux_density)(point.x, end);
      for (int a = 0; a < facet.nodes; ++a) {
        gain[2 * static_cast<size_t>(facet.node[a])] += point.shape[a] * area * h;
        gain[2 * static_cast<size_t>(facet.node[a]) + 1] += point.shape[a] * area * q;
      }
    }
  }
  mesh_.sum_shared(gain.data(), 2);
  next_.resize(n);
  std::vector<double> entering(n, 0.0);  // K, of what comes in
  for (int i = 0; i < n; ++i) {
    coefficient[i] += gain[2 * static_cast<size_t>(i)];
    at_node[i] += gain[2 * static_cast<size_t>(i) + 1];
    const int b = boundaries_.pressure_boundary()[i];
    if (b >= 0 && conditions_[b].has_value && outflow[i] < 0) {
      entering[i] = (*conditions_[b].value)(position(i), end);
      coefficient[i] -= capacity * outflow[i];
      at_node[i] -= capacity * outflow[i] * entering[i];
    }
    next_[i] = fixed_[i] ? (*conditions_[fixed_boundary_[i]].value)(position(i), end)
                         : bdf.e1 * temperature_[i] - bdf.e2 * old_temperature_[i];
  }
  transport_.add_at_nodes(coefficient, at_node);
  const int iterations = transport_.solve(fixed_, next_);
  const bool bad = std::any_of(next_.begin(), next_.end(), [](double T) { return !std::isfinite(T); });
  if (mpi_any(bad)) throw SolveFailure("the temperature became non-finite");

  // Heat that left: conducted (reaction, flux, transfer) and carried.
  std::fill(heat_flow_.begin(), heat_flow_.end(), 0.0);
  const std::vector<double> held = transport_.residual(next_);
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    if (fixed_[i]) heat_flow_[fixed_boundary_[i]] -= held[i];
    if (outflow[i] == 0) continue;
    const int b = boundaries_.pressure_boundary()[i] >= 0 ? boundaries_.pressure_boundary()[i]
                                                          : boundaries_.velocity_boundary()[i];
    if (b < 0) continue;
    const bool enters = outflow[i] < 0 && boundaries_.pressure_boundary()[i] >= 0 && conditions_[b].has_value;
    heat_flow_[b] += capacity * outflow[i] * ((enters ? entering[i] : next_[i]) - options_.reference_temperature);
  }
  for (const auto& facet : boundaries_.facets()) {
    const Condition& c = conditions_[facet.boundary];
    if (c.kind != Condition::flux && c.kind != Condition::heat_transfer) continue;
    for (int p = 0; p < facet.points; ++p) {
      const FacetPoint& point = facet.point[p];
      const bool transfer = c.kind == Condition::heat_transfer;
      const double h = transfer ? (*c.coefficient)(point.x, end) : 0.0;
      const double q = transfer ? h * (*c.value)(point.x, end) : (*c.flux_density)(point.x, end);
      for (int a = 0; a < facet.nodes; ++a)
        heat_flow_[facet.boundary] -= point.shape[a] * point.area.norm() * (q - h * next_[facet.node[a]]);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, heat_flow_.data(), static_cast<int>(heat_flow_.size()), MPI_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
  return iterations;
}

void EnergyEquation::accept() {
  for (size_t i = 0; i < change_.size(); ++i) change_[i] = next_[i] - temperature_[i];
  std::swap(old_temperature_, temperature_);
  temperature_ = next_;
  std::swap(old_void_fraction_, void_fraction_);
  void_fraction_ = next_void_fraction_;
  std::fill(started_.begin(), started_.end(), 1.0);
}

double EnergyEquation::heat() const {
  double sum = 0;
  for (int i = 0; i < mesh_.owned_nodes; ++i)
    sum += mass_[i] * void_fraction_[i] * (temperature_[i] - options_.reference_temperature);
  return density_ * options_.heat_capacity * mpi_sum(sum);
}

void EnergyEquation::add_state(std::vector<Fluid::StateArray>& arrays) {
  arrays.push_back({"temperature", &temperature_, 1});
  arrays.push_back({"old_temperature", &old_temperature_, 1});
  arrays.push_back({"temperature_change", &change_, 1});
  arrays.push_back({"energy_void_fraction", &void_fraction_, 1});
  arrays.push_back({"energy_old_void_fraction", &old_void_fraction_, 1});
  arrays.push_back({"energy_started", &started_, 1});
}

}  // namespace silt
