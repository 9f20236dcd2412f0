#include "fluid/prescribed.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/nodal_matrix.hpp"

namespace silt {
namespace {

PrescribedOptions read(Options& options) {
  PrescribedOptions given;
  options.read("fluid", given);
  return given;
}

}  // namespace

Prescribed::Prescribed(const Mesh& mesh, Options& options, const FluidOptions& fluid)
    : mesh_(mesh),
      velocity_formula_("fluid_velocity", read(options).velocity),
      pressure_formula_("fluid_pressure", read(options).pressure),
      mass_(lumped_mass(mesh)),
      gradient_(mesh, mass_),
      facets_(facet_rules(mesh)),
      order_(fluid.order) {
  load_ = ParticleLoad(mesh.nodes);
  density_ = fluid.density;
  viscosity_ = fluid.viscosity;
  model_a_ = fluid.model == "a";
  reduced_pressure_ = !fluid.hydrostatic;
  if (const auto& text = fluid.void_fraction; !text.empty())
    void_fraction_formula_.emplace("fluid_void_fraction", text);
  const PrescribedOptions given = read(options);
  heat_capacity_ = given.heat_capacity;
  conductivity_ = given.conductivity;
  if (!given.temperature.empty()) {
    if (!(heat_capacity_ > 0 && conductivity_ > 0))
      throw UserError("-fluid_temperature needs -fluid_heat_capacity and -fluid_conductivity");
    temperature_formula_.emplace("fluid_temperature", given.temperature);
  }
  if (given.turbulent_energy.empty() != given.turbulent_dissipation.empty())
    throw UserError("-fluid_turbulent_energy and -fluid_turbulent_dissipation go together: give both or none");
  if (!given.turbulent_energy.empty()) {
    energy_formula_.emplace("fluid_turbulent_energy", given.turbulent_energy);
    dissipation_formula_.emplace("fluid_turbulent_dissipation", given.turbulent_dissipation);
  }
  evaluate(0);
  change_.assign(velocity_.size(), 0.0);
  temperature_change_.assign(temperature_.size(), 0.0);
  if (options.find("fluid_turbulence").value_or("none") == "none")
    Turbulence::refuse(mesh, options, "with -fluid_type prescribed");
  else
    make_turbulence(options, given.velocity);
}

void Prescribed::make_turbulence(Options& options, const std::string& velocity) {
  for (const auto& boundary : mesh_.boundaries) {
    const std::string prefix = "boundary_" + boundary + "_";
    for (const char* name : {"velocity", "mass_flow", "profile", "pressure", "rotation_rate"})
      if (options.given(prefix + name))
        throw UserError(fmt::format(
            "-{}{} has no meaning with -fluid_type prescribed, whose velocity is -fluid_velocity", prefix, name));
    const std::string type = options.find(prefix + "type").value_or("");
    if (type == "velocity") options.set(prefix + "velocity", velocity);
    if (type == "mass_flow")
      throw UserError(
          fmt::format("-{}type mass_flow has no meaning with -fluid_type prescribed: type velocity is an "
                      "inflow that holds the turbulence given there",
                      prefix));
  }
  if (energy_formula_)
    throw UserError("-fluid_turbulent_energy and -fluid_turbulence exclude each other: k is given or solved for");
  boundaries_ = std::make_unique<BoundaryConditions>(mesh_, options, density_);
  turbulence_ = Turbulence::create(mesh_, options, *boundaries_);
  density_field_.assign(mesh_.nodes, density_);
  viscosity_field_.assign(mesh_.nodes, viscosity_);
  past_.assign(2 * static_cast<std::size_t>(mesh_.nodes), 0.0);
  turbulence_->start(turbulent_flow());
}

Turbulence::Flow Prescribed::turbulent_flow() const {
  return {velocity_,
          density_field_,
          viscosity_field_,
          void_fraction_formula_ ? void_fraction_ : load_.void_fraction,
          load_.turbulence,
          false,
          load_.dissipation_factor};
}

int Prescribed::solve_turbulence(double time, double dt) {
  const double steps = mpi_max(past_.empty() ? 0.0 : past_[0]), last = mpi_max(past_.empty() ? 0.0 : past_[1]);
  const Bdf bdf = order_ == 1 || steps < starting_steps ? Bdf::first(dt) : Bdf::second(dt, last);
  const int iterations = turbulence_->solve(time, bdf, dt, turbulent_flow());
  turbulence_->accept();
  for (std::size_t i = 0; i < past_.size(); i += 2)
    past_[i] = std::min(steps + 1, 1.0 * starting_steps), past_[i + 1] = dt;
  return iterations;
}

void Prescribed::evaluate(double time) {
  velocity_.resize(3 * static_cast<std::size_t>(mesh_.nodes));
  pressure_.resize(mesh_.nodes);
  if (void_fraction_formula_) void_fraction_.resize(mesh_.nodes);
  if (temperature_formula_) temperature_.resize(mesh_.nodes);
  if (energy_formula_) turbulent_energy_.resize(mesh_.nodes), turbulent_dissipation_.resize(mesh_.nodes);
  bool wrong = false, negative = false;
  for (int i = 0; i < mesh_.nodes; ++i) {
    const Vec3 x = vec3(&mesh_.node_coordinates[3 * static_cast<std::size_t>(i)]);
    Vec3 u = velocity_formula_(x, time);
    if (mesh_.dimension == 2) u[2] = 0;
    vec3(&velocity_[3 * static_cast<std::size_t>(i)]) = u;
    pressure_[i] = pressure_formula_(x, time);
    if (temperature_formula_) temperature_[i] = (*temperature_formula_)(x, time);
    if (energy_formula_) {
      turbulent_energy_[i] = (*energy_formula_)(x, time);
      turbulent_dissipation_[i] = (*dissipation_formula_)(x, time);
      negative |= !(turbulent_energy_[i] >= 0 && turbulent_dissipation_[i] >= 0);
    }
    if (void_fraction_formula_) {
      void_fraction_[i] = (*void_fraction_formula_)(x, time);
      wrong |= !(void_fraction_[i] > 0 && void_fraction_[i] <= 1);
    }
  }
  if (mpi_any(negative))
    throw UserError(fmt::format(
        "-fluid_turbulent_energy or -fluid_turbulent_dissipation is below 0 somewhere at t = {:g} s", time));
  if (mpi_any(wrong))
    throw UserError(fmt::format("-fluid_void_fraction is not above 0 and at most 1 everywhere at t = {:g} s", time));
  gradient_.apply(pressure_, 1, pressure_gradient_);
}

FluidStep Prescribed::advance(double time, double dt) {
  FluidStep step;
  const std::vector<double> velocity = velocity_, temperature = temperature_;
  evaluate(time + dt);
  try {
    if (turbulence_) step.turbulence_iterations = solve_turbulence(time, dt);
  } catch (const SolveFailure&) {
    evaluate(time);
    throw;
  }
  change_ = velocity;
  temperature_change_ = temperature;
  for (std::size_t k = 0; k < change_.size(); ++k) change_[k] = velocity_[k] - change_[k];
  for (std::size_t k = 0; k < temperature_.size(); ++k)
    temperature_change_[k] = temperature_[k] - temperature_change_[k];
  for (int i = 0; i < mesh_.owned_nodes; ++i)
    step.momentum += density_ * load_.void_fraction[i] * mass_[i] * vec3(&velocity_[3 * static_cast<std::size_t>(i)]);
  MPI_Allreduce(MPI_IN_PLACE, step.momentum.data(), 3, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  step.courant = courant_rate() * dt;
  return step;
}

double Prescribed::courant_rate() const {
  double fastest = 0;
  for (int i = 0; i < mesh_.nodes; ++i)
    fastest = std::max(fastest, vec3(&velocity_[3 * static_cast<std::size_t>(i)]).norm());
  return mpi_max(fastest) / mesh_.smallest_edge;
}

std::vector<BoundaryFlow> Prescribed::boundary_flow() const {
  const std::size_t count = mesh_.boundaries.size();
  std::vector<double> sums(6 * count, 0.0);  // volume flow, area, int p, int p n
  for (const FacetRule& rule : facets_) {
    double* sum = &sums[6 * static_cast<std::size_t>(rule.boundary)];
    for (int q = 0; q < rule.points; ++q) {
      const FacetPoint& point = rule.point[q];
      Vec3 flux = Vec3::Zero();
      double pressure = 0;
      for (int a = 0; a < rule.nodes; ++a) {
        const int i = rule.node[a];
        flux += point.shape[a] * load_.void_fraction[i] * vec3(&velocity_[3 * static_cast<std::size_t>(i)]);
        pressure += point.shape[a] * pressure_[i];
      }
      sum[0] += flux.dot(point.area);
      sum[1] += point.area.norm();
      sum[2] += pressure * point.area.norm();
      for (int d = 0; d < 3; ++d) sum[3 + d] += pressure * point.area[d];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  std::vector<BoundaryFlow> flows(count);
  for (std::size_t b = 0; b < count; ++b) {
    const double* sum = &sums[6 * b];
    flows[b].volume_flow = sum[0];
    flows[b].mean_pressure = sum[1] > 0 ? sum[2] / sum[1] : 0;
    flows[b].force = vec3(sum + 3);
  }
  return flows;
}

std::vector<Fluid::StateArray> Prescribed::state() {
  std::vector<StateArray> arrays = {
      {"velocity", &velocity_, 3}, {"velocity_change", &change_, 3}, {"pressure", &pressure_, 1}};
  if (temperature_formula_) {
    arrays.push_back({"temperature", &temperature_, 1});
    arrays.push_back({"temperature_change", &temperature_change_, 1});
  }
  if (energy_formula_) {
    arrays.push_back({"turbulent_energy", &turbulent_energy_, 1});
    arrays.push_back({"turbulent_dissipation", &turbulent_dissipation_, 1});
  }
  if (void_fraction_formula_) arrays.push_back({"given_void_fraction", &void_fraction_, 1});
  if (turbulence_) {
    arrays.push_back({"turbulence_steps", &past_, 2});
    turbulence_->add_state(arrays);
  }
  return arrays;
}

std::vector<Fluid::Scalar> Prescribed::scalars() const {
  std::vector<Scalar> result = Fluid::scalars();
  if (turbulence_) turbulence_->add_scalars(result);
  return result;
}

void Prescribed::restored() {
  gradient_.apply(pressure_, 1, pressure_gradient_);
  if (turbulence_) turbulence_->restored();
}

}  // namespace silt
