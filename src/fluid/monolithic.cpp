#include "fluid/monolithic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "fluid/assembly/flow_table.hpp"
#include "fluid/initial_state.hpp"

namespace silt {
namespace {

/// Void fraction, gradient and so on never divide by less than this; the coupling keeps alpha well above it.
constexpr double least_alpha = 1e-6;

MonolithicOptions read_options(Options& options) {
  MonolithicOptions result;
  options.read("fluid", result);
  return result;
}

}  // namespace

void MonolithicOptions::options(OptionGroup& option) {
  option("element", element, {"equal_order", "taylor_hood"},
         "equal_order: linear velocity and pressure, stabilised; taylor_hood: quadratic velocity, linear pressure");
  option("supg", supg, "-", "factor of the streamline term; by default 0.25 for equal_order, 0 for taylor_hood",
         non_negative);
  option("pspg", pspg, "-", "factor of the pressure stabilisation; by default 1 for equal_order, 0 for taylor_hood",
         non_negative);
  option("grad_div", grad_div, "-", "factor of the grad-div term; by default 1 for equal_order, 0 for taylor_hood",
         non_negative);
  option(
      "pressure_stage", pressure_stage, {"auto", "yes", "no"},
      "equal_order: a multigrid cycle for the pressure follows the local preconditioner; auto: from 50,000 unknowns");
}

Monolithic::Monolithic(const Mesh& mesh, Options& options, const FluidOptions& fluid, const Vec3& gravity)
    : mesh_(mesh),
      options_(read_options(options)),
      boundary_(mesh, options, fluid.density),
      system_(mesh, boundary_, options_.element == "taylor_hood" ? 2 : 1),
      solver_(system_, options_.pressure_stage),
      energy_(EnergyEquation::create(mesh, options, fluid.energy, fluid.density, gravity, boundary_,
                                     system_.space().order)),
      turbulence_(Turbulence::create(mesh, options, boundary_)),
      drive_(Drive::create(mesh, options, fluid.density)),
      order_(fluid.order) {
  density_ = fluid.density;
  viscosity_ = fluid.viscosity;
  model_a_ = fluid.model == "a";
  reduced_pressure_ = !fluid.hydrostatic;
  load_ = ParticleLoad(mesh.nodes);
  const double stabilised = system_.equal_order() ? 1 : 0;
  FlowParameters& k = fields_.parameters;
  k.density = density_;
  k.viscosity = viscosity_;
  k.supg = options_.supg.value_or(0.25 * stabilised);
  k.pspg = options_.pspg.value_or(stabilised);
  k.grad_div = options_.grad_div.value_or(stabilised);
  k.model_a = model_a_;
  k.load_as_density = !system_.equal_order();
  if (fluid.hydrostatic) static_head_ = density_ * gravity;
  fields_.backflow = fluid.backflow;
  if (options.given("fluid_body_force")) {
    auto force = std::make_shared<VectorExpression>("fluid_body_force", fluid.body_force);
    body_force_ = [force](const Vec3& x, double t) { return (*force)(x, t); };
  }

  if (!fluid.void_fraction.empty()) {
    auto formula = std::make_shared<Expression>("fluid_void_fraction", fluid.void_fraction);
    void_fraction_formula_ = [formula](const Vec3& x, double t) { return (*formula)(x, t); };
    set_void_fraction(mesh, 0);
  }
  const LagrangeSpace& space = system_.space();
  const VectorExpression initial("fluid_initial_velocity", fluid.initial_velocity);
  const Expression initial_pressure("fluid_initial_pressure", fluid.initial_pressure);
  velocity_.assign(3 * static_cast<size_t>(space.nodes), 0.0);
  for (int i = 0; i < space.nodes; ++i)
    vec3(&velocity_[3 * static_cast<size_t>(i)]) =
        initial(vec3(&space.node_coordinates[3 * static_cast<size_t>(i)]), 0);
  if (mesh.dimension == 2)
    for (int i = 0; i < space.nodes; ++i) velocity_[3 * static_cast<size_t>(i) + 2] = 0;
  pressure_.assign(mesh.nodes, 0.0);
  for (int i = 0; i < mesh.nodes; ++i)
    pressure_[i] = initial_pressure(vec3(&mesh.node_coordinates[3 * static_cast<size_t>(i)]), 0);
  step_previous_.assign(mesh.nodes, 0.0);
  lent_share_.assign(mesh.nodes, 0.0);
  driven_ = drive_ != nullptr;
  if (drive_) last_drive_.assign(mesh.nodes, 0.0);
  change_.assign(3 * static_cast<size_t>(mesh.nodes), 0.0);
  unknown_ = system_.create_vector();
  prepare_step(0, 0);
  const InitialState start = initial_state(mesh, options, boundary_, space.node_coordinates, energy_ != nullptr);
  if (!start.velocity.empty()) velocity_ = start.velocity;
  if (!start.pressure.empty()) pressure_ = start.pressure;
  if (!start.temperature.empty()) energy_->set_initial(start.temperature);
  system_.constraints().impose(fields_.prescribed_velocity.data(), velocity_.data());
  if (start.stokes) solve_stokes();
  velocity_previous_ = velocity_;
  if (turbulence_) {
    density_field_.assign(mesh.nodes, density_), viscosity_field_.assign(mesh.nodes, viscosity_);
    turbulence_->start(turbulent_flow());
  }
  system_.to_vector(velocity_.data(), pressure_.data(), unknown_);
  find_pressure_gradient();
}

void Monolithic::prepare_step(double time, double dt) {
  const LagrangeSpace& space = system_.space();
  const size_t v = space.nodes, p = mesh_.nodes;
  StepFields& f = fields_;
  f.alpha.resize(v);
  space.interpolate(load_.void_fraction.data(), f.alpha.data(), 1);
  for (double& alpha : f.alpha) alpha = std::max(alpha, least_alpha);
  f.alpha_rate = load_.void_fraction_rate;
  f.following = load_.following;
  f.nodal_load = load_.force;
  f.nodal_response = load_.response;
  f.load.resize(3 * p);
  f.response.resize(p);
  for (size_t i = 0; i < p; ++i) {
    const double inverse = 1 / system_.lumped_mass()[i];
    f.response[i] = load_.response[i] * inverse;
    for (int c = 0; c < 3; ++c) f.load[3 * i + c] = load_.force[3 * i + c] * inverse;
  }
  if (turbulence_) f.eddy_viscosity = turbulence_->cell_eddy_viscosity();
  f.body.assign(3 * v, 0.0);
  if (body_force_)
    for (size_t i = 0; i < v; ++i) vec3(&f.body[3 * i]) = body_force_(vec3(&space.node_coordinates[3 * i]), time + dt);

  const double last = mpi_max(mesh_.nodes ? step_previous_[0] : 0.0);
  bdf_ = dt <= 0 ? Bdf{0, 0, 0, 1, 0} : order_ == 2 && last > 0 ? Bdf::second(dt, last) : Bdf::first(dt);
  f.lent_share = lent_share_;  // the impulse that was lent comes back over this step
  for (double& share : f.lent_share) share *= dt > 0 && model_a_ ? last / dt : 0.0;
  f.lent_pressure = pressure_;
  if (energy_ && energy_->buoyant()) {
    std::vector<double> force(3 * p, 0.0), all(3 * v);
    energy_->add_buoyancy(bdf_, load_.void_fraction, model_a_, force);
    space.interpolate(force.data(), all.data(), 3);
    for (size_t i = 0; i < 3 * v; ++i) f.body[i] += all[i];
  }
  f.parameters.time_coefficient = bdf_.c0;
  for (int i = 0; i < 3; ++i) f.parameters.mean_gradient[i] = static_head_[i];
  f.velocity_old = velocity_;
  f.history.assign(3 * v, 0.0);
  for (size_t i = 0; i < 3 * v; ++i)
    f.history[i] = bdf_.c2 * (bdf_.c2 != 0 ? velocity_previous_[i] : 0.0) - bdf_.c1 * velocity_[i];

  boundary_.evaluate(time + dt, load_.void_fraction.data());
  f.prescribed_velocity.resize(3 * v);
  system_.constraints().evaluate(time + dt, f.alpha.data(), f.prescribed_velocity.data());
  f.prescribed_flow = boundary_.flow();
  f.boundary_pressure = boundary_.pressure();
}

void Monolithic::choose_scales() {
  // Typical sizes of the terms at a node; they make the rows comparable and say when a residual is only rounding.
  FlowParameters& k = fields_.parameters;
  double speed = 0;
  for (double u : velocity_) speed = std::max(speed, std::abs(u));
  for (double u : fields_.prescribed_velocity) speed = std::max(speed, std::abs(u));
  speed = mpi_max(speed);
  const double size = std::pow(mesh_.volume / static_cast<double>(mesh_.total_cells), 1.0 / mesh_.dimension);
  k.continuity_scale = density_ * (speed + size * k.time_coefficient) + viscosity_ / size;
  double momentum = 0, continuity = 0;
  const double driving = std::hypot(k.mean_gradient[0], k.mean_gradient[1], k.mean_gradient[2]);
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    const size_t n = 3 * static_cast<size_t>(i);
    const double mass = system_.lumped_mass()[i];
    const double u = std::max(vec3(&velocity_[n]).norm(), vec3(&fields_.prescribed_velocity[n]).norm());
    const double inertia = density_ * fields_.alpha[i] * (k.time_coefficient + u / size) + viscosity_ / (size * size);
    const double force = mass * (inertia * u + driving) + vec3(&fields_.nodal_load[n]).norm() +
                         mass * vec3(&fields_.body[n]).norm() + fields_.nodal_response[i] * u;
    momentum += force * force;
    const double flow = k.continuity_scale * (mass * (fields_.alpha[i] * u / size + std::abs(fields_.alpha_rate[i])) +
                                              std::abs(fields_.prescribed_flow[i]));
    continuity += flow * flow;
  }
  residual_scale_ = std::sqrt(mpi_sum(momentum + continuity));
}

FluidStep Monolithic::advance(double time, double dt) {
  set_void_fraction(mesh_, time + dt);
  prepare_step(time, dt);
  double stored = 0;
  for (int i = 0; i < mesh_.owned_nodes; ++i) stored += system_.lumped_mass()[i] * fields_.alpha_rate[i];
  boundary_.check_balance(mpi_sum(stored), dt);
  choose_scales();
  const std::vector<double> before = velocity_, pressure_before = pressure_;
  std::vector<double> guess = velocity_;
  const double last = mpi_max(mesh_.nodes ? step_previous_[0] : 0.0);
  // Extrapolating beyond a jump of the step does more harm than good.
  if (last > 0 && dt < 3 * last)
    for (size_t i = 0; i < guess.size(); ++i) guess[i] += (velocity_[i] - velocity_previous_[i]) * (dt / last);
  system_.constraints().impose(fields_.prescribed_velocity.data(), guess.data());
  system_.to_vector(guess.data(), pressure_.data(), unknown_);
  NewtonSolver::Result result;
  int energy_iterations = 0, turbulence_iterations = 0;
  try {
    result = drive_ ? solve_driven(time + dt) : solver_.solve(fields_, unknown_, residual_scale_);
    if (energy_) {
      std::vector<double> eddy;
      if (turbulence_) eddy = turbulence_->cell_eddy_conductivity(heat_capacity_, conductivity_, viscosity_);
      energy_iterations = energy_->solve(time, bdf_, dt, load_, system_.superficial_velocity(fields_, unknown_),
                                         system_.nodal_outflow(fields_, unknown_), turbulence_ ? &eddy : nullptr);
    }
    system_.from_vector(unknown_, velocity_.data(), pressure_.data());
    if (turbulence_) turbulence_iterations = turbulence_->solve(time, bdf_, dt, turbulent_flow());
  } catch (const SolveFailure&) {
    velocity_ = before, pressure_ = pressure_before;
    system_.to_vector(before.data(), pressure_before.data(), unknown_);
    throw;
  }
  velocity_previous_ = before;
  std::fill(step_previous_.begin(), step_previous_.end(), dt);
  lent_share_ = load_.following;
  if (boundary_.closed()) remove_mean_pressure();
  if (drive_) std::fill(last_drive_.begin(), last_drive_.end(), drive_gradient_);
  find_change(before);
  find_pressure_gradient();
  if (energy_) energy_->accept();
  if (turbulence_) turbulence_->accept();
  FluidStep step = report(dt);
  if (energy_) step.heat = energy_->heat();
  step.newton_iterations = result.newton;
  step.energy_iterations = energy_iterations;
  step.turbulence_iterations = turbulence_iterations;
  step.velocity_iterations = step.pressure_iterations = result.linear;
  return step;
}

NewtonSolver::Result Monolithic::solve_driven(double time) {
  const int d = drive_->direction();
  const double weight = fields_.parameters.mean_gradient[d];
  const auto set = [&](double gradient) {
    drive_gradient_ = gradient;
    fields_.parameters.mean_gradient[d] = weight + gradient;
    choose_scales();
  };
  if (drive_->controlled()) {
    set(mpi_max(mesh_.nodes ? last_drive_[0] : -infinity));  // a rank may have no nodes
    return find_drive(drive_->velocity(time), set);
  }
  set(drive_->gradient(time));
  return solver_.solve(fields_, unknown_, residual_scale_);
}

NewtonSolver::Result Monolithic::find_drive(double target, const std::function<void(double)>& set) {
  // Newton's method for the gradient around that for the flow; the answer of the flow to the gradient is that of its
  // linearised equations.
  constexpr int most = 20;
  constexpr double close = 1e-10;  // of the flow
  const int d = drive_->direction();
  const auto mean_flow = [&] {
    system_.from_vector(unknown_, velocity_.data(), pressure_.data());
    return total_flux()[d] / mesh_.volume;
  };
  NewtonSolver::Result result;
  const double at_start = std::abs(mean_flow() - target);
  const VecHandle answer = system_.create_vector(), base = system_.create_vector(), more = system_.create_vector();
  for (int k = 0; k < most; ++k) {
    const NewtonSolver::Result once = solver_.solve(fields_, unknown_, residual_scale_);
    result.newton += once.newton, result.linear += once.linear;
    const double missing = target - mean_flow();
    if (std::abs(missing) <= close * std::max(std::abs(target), at_start)) return result;
    // -dR/dG, the residual being linear in the gradient
    const double here = drive_gradient_, unit = std::max(std::abs(here), density_ * bdf_.c0 * std::abs(missing));
    SILT_PETSC(system_.residual(fields_, unknown_, base));
    set(here + unit);
    SILT_PETSC(system_.residual(fields_, unknown_, more));
    set(here);
    SILT_PETSC(VecAXPY(base, -1, more));
    solver_.linear_answer(fields_, unknown_, base, answer);
    SILT_PETSC(VecAXPY(unknown_, 1, answer));
    const double gained = mean_flow() - (target - missing);
    SILT_PETSC(VecAXPY(unknown_, missing / gained - 1, answer));
    const double next = here + unit * missing / gained;
    if (!std::isfinite(next)) break;
    set(next);
  }
  throw SolveFailure("no pressure gradient gives the flow asked for (-fluid_drive_...)");
}

void Monolithic::solve_stokes() {
  const FlowParameters before = fields_.parameters;
  FlowParameters& k = fields_.parameters;
  const double size = std::pow(mesh_.volume / static_cast<double>(mesh_.total_cells), 1.0 / mesh_.dimension);
  k.density = k.time_coefficient = 0;
  k.continuity_scale = viscosity_ / size;
  boundary_.check_balance(0, 0);
  system_.to_vector(velocity_.data(), pressure_.data(), unknown_);
  try {
    if (drive_)
      solve_driven(0);
    else
      solver_.solve(fields_, unknown_, 0);
  } catch (const SolveFailure& failure) {
    throw RunError(fmt::format("-fluid_initial_solve stokes: {}", failure.what()));
  }
  system_.from_vector(unknown_, velocity_.data(), pressure_.data());
  if (boundary_.closed()) remove_mean_pressure();
  if (drive_) std::fill(last_drive_.begin(), last_drive_.end(), drive_gradient_);
  fields_.parameters = before;
}

void Monolithic::remove_mean_pressure() {
  double sum = 0, volume = 0;
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    sum += system_.lumped_mass()[i] * pressure_[i];
    volume += system_.lumped_mass()[i];
  }
  const double mean = mpi_sum(sum) / mpi_sum(volume);
  for (double& p : pressure_) p -= mean;
  system_.to_vector(velocity_.data(), pressure_.data(), unknown_);
}

void Monolithic::find_change(const std::vector<double>& before) {
  if (system_.equal_order()) {
    for (size_t i = 0; i < change_.size(); ++i) change_[i] = velocity_[i] - before[i];
    return;
  }
  const LagrangeSpace& space = system_.space();
  const FlowTable& table = flow_table(mesh_.cell, space.order);
  const int np = mesh_.nodes_per_cell, nv = space.nodes_per_cell;
  std::fill(change_.begin(), change_.end(), 0.0);
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * static_cast<size_t>(c) * np];
    for (int q = 0; q < table.points; ++q) {
      Mat3 J = Mat3::Zero();
      for (int a = 0; a < np; ++a) J += vec3(x + 3 * a) * vec3(table.dM[q][a]).transpose();
      if (mesh_.dimension == 2) J(2, 2) = 1;
      Vec3 change = Vec3::Zero();
      for (int a = 0; a < nv; ++a) {
        const size_t n = 3 * static_cast<size_t>(space.cell_nodes[static_cast<size_t>(c) * nv + a]);
        change += table.N[q][a] * (vec3(&velocity_[n]) - vec3(&before[n]));
      }
      const double w = table.weight[q] * J.determinant();
      for (int a = 0; a < np; ++a)
        vec3(&change_[3 * static_cast<size_t>(mesh_.cell_nodes[static_cast<size_t>(c) * np + a])]) +=
            w * table.M[q][a] * change;
    }
  }
  mesh_.sum_shared(change_.data(), 3);
  for (int i = 0; i < mesh_.nodes; ++i) vec3(&change_[3 * static_cast<size_t>(i)]) /= system_.lumped_mass()[i];
}

void Monolithic::find_pressure_gradient() {
  // int alpha_h grad p_h = sum_i alpha_i int N_i grad p_h, whatever the velocity element.
  const FlowTable& table = flow_table(mesh_.cell, system_.space().order);
  const int np = mesh_.nodes_per_cell;
  const bool simplex = np == mesh_.dimension + 1;
  pressure_gradient_.assign(3 * static_cast<size_t>(mesh_.nodes), 0.0);
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * static_cast<size_t>(c) * np];
    const int* n = &mesh_.cell_nodes[static_cast<size_t>(c) * np];
    Vec3 gradient = Vec3::Zero();  // times the Jacobian's determinant, the same in all of a simplex
    for (int q = 0; q < table.points; ++q) {
      if (q == 0 || !simplex) {
        Mat3 J = Mat3::Zero();
        Vec3 reference = Vec3::Zero();
        for (int a = 0; a < np; ++a) {
          J += vec3(x + 3 * a) * vec3(table.dM[q][a]).transpose();
          reference += pressure_[n[a]] * vec3(table.dM[q][a]);
        }
        if (mesh_.dimension == 2) J(2, 2) = 1;
        gradient = J.determinant() * (J.inverse().transpose() * reference);
      }
      for (int a = 0; a < np; ++a)
        vec3(&pressure_gradient_[3 * static_cast<size_t>(n[a])]) += table.weight[q] * table.M[q][a] * gradient;
    }
  }
  mesh_.sum_shared(pressure_gradient_.data(), 3);
  for (int i = 0; i < mesh_.nodes; ++i)
    vec3(&pressure_gradient_[3 * static_cast<size_t>(i)]) /= system_.lumped_mass()[i];
  if (drive_)
    for (int i = 0; i < mesh_.nodes; ++i)
      pressure_gradient_[3 * static_cast<size_t>(i) + drive_->direction()] -= last_drive_[i];
}

std::unique_ptr<Fluid> make_monolithic(const Mesh& mesh, Options& options, const FluidOptions& fluid,
                                       const Vec3& gravity) {
  return std::make_unique<Monolithic>(mesh, options, fluid, gravity);
}

}  // namespace silt
