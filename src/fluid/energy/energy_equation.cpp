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
  TemperatureBoundaries::refuse(mesh, options, "without -fluid_energy yes");
  return nullptr;
}

EnergyEquation::EnergyEquation(const Mesh& mesh, Options& options, double density, const Vec3& gravity,
                               const BoundaryConditions& boundaries, int table_order)
    : mesh_(mesh),
      options_([&] {
        EnergyOptions read;
        options.read("fluid", read);
        for (const char* name : {"heat_capacity", "conductivity", "initial_temperature"})
          if (!options.given(std::string("fluid_") + name) &&
              !(std::string(name) == "initial_temperature" && options.given("fluid_initial_file")))
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
      conditions_(mesh, options, boundaries),
      mass_(lumped_mass(mesh)) {
  const Expression initial("fluid_initial_temperature", options_.initial_temperature);
  temperature_.resize(mesh.nodes);
  for (int i = 0; i < mesh.nodes; ++i)
    temperature_[i] = initial(vec3(&mesh.node_coordinates[3 * static_cast<size_t>(i)]), 0);
  old_temperature_ = next_ = outside_ = temperature_;
  change_.assign(mesh.nodes, 0.0);
  started_.assign(mesh.nodes, 0.0);
  for (auto* field : {&void_fraction_, &old_void_fraction_, &next_void_fraction_}) field->assign(mesh.nodes, 1.0);
  heat_flow_.assign(mesh.boundaries.size(), 0.0);
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
                          const std::vector<double>& flux, const std::vector<double>& outflow,
                          const std::vector<double>* eddy_conductivity) {
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
  std::vector<double> eddy;
  if (eddy_conductivity) {
    eddy = *eddy_conductivity;
    const size_t corners = mesh_.nodes_per_cell;
    for (size_t c = 0; c < eddy.size(); ++c) {
      double alpha = 0;
      for (size_t a = 0; a < corners; ++a) alpha += load.void_fraction[mesh_.cell_nodes[corners * c + a]] / corners;
      eddy[c] *= alpha;
    }
    data.cell_diffusivity = eddy.data();
  }
  transport_.assemble(data);

  std::vector<double> heat, transfer;
  conditions_.heat(end, false, heat, transfer);
  next_.resize(n);
  std::vector<double> entering(n, 0.0);  // K, of what comes in
  for (int i = 0; i < n; ++i) {
    coefficient[i] += transfer[i];
    at_node[i] += heat[i];
    const int b = conditions_.entered_boundary()[i];
    if (b >= 0 && outflow[i] < 0) {
      entering[i] = conditions_[b].has_value ? (*conditions_[b].value)(position(i), end) : outside_[i];
      coefficient[i] -= capacity * outflow[i];
      at_node[i] -= capacity * outflow[i] * entering[i];
    }
    next_[i] =
        conditions_.fixed()[i] ? conditions_.given(i, end) : bdf.e1 * temperature_[i] - bdf.e2 * old_temperature_[i];
  }
  transport_.add_at_nodes(coefficient, at_node);
  const int iterations = transport_.solve(conditions_.fixed(), next_);
  const bool bad = std::any_of(next_.begin(), next_.end(), [](double T) { return !std::isfinite(T); });
  if (mpi_any(bad)) throw SolveFailure("the temperature became non-finite");

  // Heat that left: conducted (reaction, flux, transfer) and carried.
  std::fill(heat_flow_.begin(), heat_flow_.end(), 0.0);
  const std::vector<double> held = transport_.residual(next_);
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    if (conditions_.fixed()[i]) heat_flow_[conditions_.fixed_boundary()[i]] -= held[i];
    if (outflow[i] == 0) continue;
    const int through = conditions_.entered_boundary()[i], opening = boundaries_.pressure_boundary()[i];
    const int b = through >= 0 ? through : opening >= 0 ? opening : boundaries_.velocity_boundary()[i];
    if (b < 0) continue;
    const bool enters = through >= 0 && outflow[i] < 0;
    heat_flow_[b] += capacity * outflow[i] * ((enters ? entering[i] : next_[i]) - options_.reference_temperature);
  }
  conditions_.add_heat_flow(end, next_, heat_flow_);
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
  arrays.push_back({"temperature_outside", &outside_, 1});
  arrays.push_back({"energy_void_fraction", &void_fraction_, 1});
  arrays.push_back({"energy_old_void_fraction", &old_void_fraction_, 1});
  arrays.push_back({"energy_started", &started_, 1});
}

}  // namespace silt
