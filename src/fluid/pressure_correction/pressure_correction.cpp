#include "fluid/pressure_correction/pressure_correction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace silt {
namespace {

/// Steps after which the pressure matrix is assembled again though only the convecting velocity in its stabilisation
/// has changed.
constexpr int longest_matrix_age = 10;

bool finite(const std::vector<double>& values) {
  double sum = 0;
  for (double v : values) sum += v * 0.0;  // NaN and infinity give NaN
  return sum == 0;
}

}  // namespace

void PressureCorrectionOptions::options(OptionGroup& option) {
  option("supg", supg, "-", "factor of the streamline stabilisation (1: full, 0: none)", non_negative);
  option("rotational", rotational, "add the divergence of the velocity to the pressure (rotational form)");
  option("velocity_tolerance", velocity_tolerance, "-", "relative residual at which the velocity solve stops",
         Range{0, 1, true, true});
  option("width", width, "-", "cells treated at once by the element loops: 2, 4 or 8; 0: what the processor does best",
         between(0, 8));
}

PressureCorrection::PressureCorrection(const Mesh& mesh, Options& options, const FluidOptions& fluid,
                                       const Vec3& gravity)
    : mesh_(mesh),
      fluid_(fluid),
      scheme_([&] {
        PressureCorrectionOptions scheme;
        options.read("fluid", scheme);
        return scheme;
      }()),
      gravity_(gravity),
      boundaries_(mesh, options, fluid.density),
      body_force_expression_("fluid_body_force", fluid.body_force),
      graph_(mesh),
      loops_(graph_, scheme_.width),
      momentum_(graph_),
      velocity_solver_(mesh),
      pressure_solver_(graph_, boundaries_.pressure_boundary(), boundaries_.closed()),
      energy_(EnergyEquation::create(mesh, options, fluid.energy, fluid.density, gravity, boundaries_, 1)),
      turbulence_(Turbulence::create(mesh, options, boundaries_)),
      drive_(Drive::create(mesh, options, fluid.density)),
      mass_(lumped_mass(mesh)) {
  load_ = ParticleLoad(mesh.nodes);
  density_ = fluid.density;
  viscosity_ = fluid.viscosity;
  model_a_ = fluid.model == "a";
  reduced_pressure_ = !fluid.hydrostatic;
  initial_pressure_given_ = options.given("fluid_initial_pressure");
  has_weight_ = (fluid.hydrostatic && gravity.norm() > 0) || (energy_ && energy_->buoyant());
  has_body_force_ = options.given("fluid_body_force") || has_weight_ || turbulence_;

  const int n = mesh.nodes;
  for (auto* field : {&velocity_, &old_velocity_, &pressure_gradient_, &velocity_change_, &convecting_, &history_,
                      &right_, &solution_, &flux_, &carrying_})
    field->assign(3 * n, 0.0);
  for (auto* field : {&pressure_, &increment_, &old_increment_, &drag_, &old_drag_, &drag_now_, &effective_, &outflow_,
                      &following_, &old_following_, &lent_pressure_})
    field->assign(n, 0.0);
  for (auto* field : {&void_fraction_, &old_void_fraction_}) field->assign(n, 1.0);
  past_.assign(4 * n, 0.0);
  if (has_body_force_) body_force_.assign(3 * n, 0.0);
  if (has_weight_) weight_.assign(3 * n, 0.0);
  load_per_drag_.assign(3 * n, 0.0);

  VectorExpression initial_velocity("fluid_initial_velocity", fluid.initial_velocity);
  Expression initial_pressure("fluid_initial_pressure", fluid.initial_pressure);
  for (int i = 0; i < n; ++i) {
    const Vec3 x = vec3(&mesh.node_coordinates[3 * i]);
    vec3(&velocity_[3 * i]) = initial_velocity(x, 0);
    if (mesh.dimension == 2) velocity_[3 * i + 2] = 0;
    pressure_[i] = initial_pressure(x, 0);
  }
  if (!fluid.void_fraction.empty()) {
    auto formula = std::make_shared<Expression>("fluid_void_fraction", fluid.void_fraction);
    void_fraction_formula_ = [formula](const Vec3& x, double t) { return (*formula)(x, t); };
    set_void_fraction(mesh, 0);
    void_fraction_ = old_void_fraction_ = load_.void_fraction;
  }
  start_from(options);
  old_velocity_ = carrying_ = velocity_;
  if (turbulence_) {
    density_field_.assign(n, density_), viscosity_field_.assign(n, viscosity_);
    turbulence_->start(turbulent_flow(velocity_));
  }
  set_pressure_gradient();
  if (fluid.hydrostatic && !initial_pressure_given_)  // what the start will find
    for (int i = 0; i < n; ++i) vec3(&pressure_gradient_[3 * i]) = density_ * gravity;

  const std::size_t padded = loops_.padded_cells();
  cell_values_.assign(20 * padded, 0.0);
  double* next = cell_values_.data();
  const auto take = [&] { return std::exchange(next, next + padded); };
  cell_ = {take(), take(), take(), take(), take(), {take(), take(), take()}, {take(), take(), take()}, take()};
  increment_factor_ = take();
  old_increment_factor_ = take();
  lent_ = take();
  for (auto& scratch : scratch_) scratch = take();

  if (drive_) start_drive();
  node_size_.assign(n, infinity);
  for (int c = 0; c < mesh.cells; ++c)
    for (int a = 0; a < mesh.nodes_per_cell; ++a) {
      double& size = node_size_[mesh.cell_nodes[static_cast<std::size_t>(c) * mesh.nodes_per_cell + a]];
      size = std::min(size, loops_.size()[c]);
    }

  for (const auto& rule : boundaries_.facets()) {
    if (boundaries_.type(rule.boundary) != BoundaryType::pressure) continue;
    OutletFacet outlet{&rule, {}};
    for (int a = 0; a < rule.nodes; ++a)
      for (int b = 0; b < rule.nodes; ++b) {
        const auto row = graph_.column.begin() + graph_.row_start[rule.node[a]];
        const auto end = graph_.column.begin() + graph_.row_start[rule.node[a] + 1];
        outlet.entry[a][b] = static_cast<int>(std::lower_bound(row, end, rule.node[b]) - graph_.column.begin());
      }
    outlets_.push_back(outlet);
  }
}

void PressureCorrection::prepare(double time, double dt, const Past& past) {
  const int n = mesh_.nodes;
  bool loaded = false;
  for (int i = 0; i < n && !loaded; ++i)
    loaded = load_.void_fraction[i] != 1 || load_.response[i] != 0 || load_.void_fraction_rate[i] != 0 ||
             load_.force[3 * i] != 0 || load_.force[3 * i + 1] != 0 || load_.force[3 * i + 2] != 0 ||
             void_fraction_[i] != 1 || old_void_fraction_[i] != 1 || drag_[i] != 0 || old_drag_[i] != 0;
  porous_ = mpi_any(loaded);

  if (past.steps == 0) {  // what the boundaries prescribe holds from the start
    boundaries_.evaluate(time, load_.void_fraction.data());
    boundaries_.impose(velocity_.data());
    old_velocity_ = carrying_ = velocity_;
    if (turbulence_) turbulence_->start(turbulent_flow(velocity_));
  }
  boundaries_.evaluate(time + dt, load_.void_fraction.data());
  bdf_dt_ = dt;
  bdf_ = fluid_.order == 1 || past.steps < starting_steps ? Bdf::first(dt) : Bdf::second(dt, past.dt);
  for (int i = 0; i < 3 * n; ++i) {
    convecting_[i] = bdf_.e1 * velocity_[i] - bdf_.e2 * old_velocity_[i];
    history_[i] = bdf_.c1 * velocity_[i] - bdf_.c2 * old_velocity_[i];
  }
  boundaries_.impose(convecting_.data());

  for (int i = 0; i < n; ++i) drag_now_[i] = mass_[i] > 0 ? load_.response[i] / mass_[i] : 0;
  if (has_weight_) {
    for (int i = 0; i < n; ++i) {
      const double share = !fluid_.hydrostatic ? 0.0 : model_a_ ? load_.void_fraction[i] : 1.0;
      vec3(&weight_[3 * i]) = density_ * share * gravity_;
    }
    if (energy_) energy_->add_buoyancy(bdf_, load_.void_fraction, model_a_, weight_);
  }
  if (drive_) choose_drive(time + dt);
  if (has_body_force_)
    for (int i = 0; i < n; ++i) {
      Vec3 force = body_force_expression_(vec3(&mesh_.node_coordinates[3 * i]), time + dt);
      if (has_weight_) force += vec3(&weight_[3 * i]);
      if (mesh_.dimension == 2) force.z() = 0;
      vec3(&body_force_[3 * i]) = force;
    }
  set_eddy_viscosity();
}

void PressureCorrection::set_momentum_terms() {
  const std::size_t padded = loops_.padded_cells();
  const double* void_fraction = porous_ ? load_.void_fraction.data() : nullptr;
  const double* body = has_body_force_ ? body_force_.data() : nullptr;
  const double* eddy = turbulence_ ? eddy_viscosity_.data() : nullptr;
  const Past before = past();
  loops_.coefficients({density_, viscosity_, bdf_.c0, model_a_, convecting_.data(), void_fraction, drag_now_.data(),
                       eddy, load_.following.data()},
                      cell_);
  if (porous_ || has_weight_) set_cell_forces(has_weight_ ? weight_.data() : nullptr);

  terms_ = {};
  terms_.density = density_, terms_.viscosity = viscosity_, terms_.rate = bdf_.c0, terms_.supg = scheme_.supg;
  terms_.velocity = convecting_.data(), terms_.history = history_.data(), terms_.body_force = body;
  terms_.eddy_viscosity = eddy;
  if (!porous_) {
    // k = 1/(rho rate): the corrections act as an extrapolated pressure.
    const double now = before.rate > 0 ? bdf_.c1 / before.rate : 0,
                 old = before.old_rate > 0 ? bdf_.c2 / before.old_rate : 0;
    for (int i = 0; i < mesh_.nodes; ++i) effective_[i] = pressure_[i] + now * increment_[i] - old * old_increment_[i];
    terms_.pressure = effective_.data();
    return;
  }
  // The mobilities of the last two corrections, from what is kept of their steps.
  const auto mobility = [&](double rate, const std::vector<double>& alpha, const std::vector<double>& drag,
                            const std::vector<double>& following, double c, double* factor) {
    std::fill(factor, factor + padded, 0.0);
    if (rate == 0 || c == 0) return;
    CoefficientTerms then{density_,     viscosity_,  rate, model_a_,        convecting_.data(),
                          alpha.data(), drag.data(), eddy, following.data()};
    CellCoefficients result{scratch_[0], scratch_[1], scratch_[2], factor, scratch_[3], {}, {}, scratch_[4]};
    loops_.coefficients(then, result);
    for (std::size_t k = 0; k < padded; ++k) factor[k] *= cell_.void_fraction[k] * density_ * c;
  };
  mobility(before.rate, void_fraction_, drag_, following_, bdf_.c1, increment_factor_);
  mobility(before.old_rate, old_void_fraction_, old_drag_, old_following_, bdf_.c2, old_increment_factor_);
  set_lent(before.dt);
  terms_.pressure = pressure_.data(), terms_.increment = increment_.data(),
  terms_.old_increment = old_increment_.data();
  terms_.void_fraction = void_fraction, terms_.void_fraction_rate = load_.void_fraction_rate.data();
  terms_.cell_void_fraction = cell_.void_fraction, terms_.cell_pressure_share = cell_.pressure_share;
  terms_.cell_following = cell_.following, terms_.cell_lent = lent_, terms_.lent_pressure = lent_pressure_.data();
  terms_.cell_drag = cell_.drag;
  terms_.increment_factor = increment_factor_, terms_.old_increment_factor = old_increment_factor_;
  for (int d = 0; d < 3; ++d) terms_.force[d] = cell_.force[d];
}

void PressureCorrection::add_backflow() {
  if (fluid_.backflow == 0) return;
  for (const auto& outlet : outlets_) {
    const auto& rule = *outlet.rule;
    for (int q = 0; q < rule.points; ++q) {
      const auto& point = rule.point[q];
      Vec3 w = Vec3::Zero();
      double alpha = 0;
      for (int a = 0; a < rule.nodes; ++a) {
        w += point.shape[a] * vec3(&convecting_[3 * rule.node[a]]);
        alpha += point.shape[a] * load_.void_fraction[rule.node[a]];
      }
      const double inflow = -w.dot(point.area);
      if (inflow <= 0) continue;
      const double factor = fluid_.backflow * density_ * alpha * inflow;
      for (int a = 0; a < rule.nodes; ++a)
        for (int b = 0; b < rule.nodes; ++b)
          momentum_.values[outlet.entry[a][b]] += factor * point.shape[a] * point.shape[b];
    }
  }
}

void PressureCorrection::assemble_momentum() {
  momentum_.zero();
  std::fill(right_.begin(), right_.end(), 0.0);
  loops_.momentum(terms_, momentum_.values.data(), right_.data());
  add_backflow();
  mesh_.sum_shared(right_.data(), 3);
  if (drive_) add_drive();
  if (!porous_) return;
  for (int i = 0; i < mesh_.owned_nodes; ++i) momentum_.values[graph_.diagonal[i]] += load_.response[i];
  for (int i = 0; i < mesh_.nodes; ++i)
    for (int d = 0; d < mesh_.dimension; ++d)
      right_[3 * i + d] += load_.force[3 * i + d] + load_.response[i] * carrying_[3 * i + d];
}

std::vector<double> PressureCorrection::continuity(const std::vector<double>& u, std::vector<double>& divergence) {
  const int n = mesh_.nodes;
  flux_ = u;
  if (porous_)
    for (int i = 0; i < 3 * n; ++i)
      flux_[i] = load_.void_fraction[i / 3] * u[i] + load_.following[i / 3] * (u[i] - carrying_[i]);
  const bool balance = porous_ || has_weight_;
  ContinuityTerms in{flux_.data(), pressure_.data(), nullptr, cell_.stabilisation, {}};
  for (int d = 0; d < 3; ++d) in.balance[d] = balance ? cell_.balance[d] : nullptr;

  std::vector<double> sums(4 * n, 0.0);
  projection_.resize(3 * n);
  loops_.projection(in, sums.data());
  mesh_.sum_shared(sums.data(), 4);
  for (int i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d) projection_[3 * i + d] = sums[4 * i + d] / sums[4 * i + 3];

  in.projection = projection_.data();
  std::fill(sums.begin(), sums.begin() + 2 * n, 0.0);
  loops_.continuity(in, sums.data());
  mesh_.sum_shared(sums.data(), 2);
  std::vector<double> right(n);
  divergence.resize(n);
  for (int i = 0; i < n; ++i) {
    const double rate = mass_[i] * load_.void_fraction_rate[i];
    right[i] = sums[2 * i] - boundaries_.flow()[i] - rate;
    divergence[i] = (sums[2 * i + 1] + rate) / mass_[i];
  }
  return right;
}

void PressureCorrection::assemble_pressure(const Past& past) {
  // In the first two steps gamma/dt and the convecting velocity change at once, and with them the matrix by orders.
  const bool start = past.steps < 2 || renew_, stepped = std::abs(bdf_.c0 / matrix_rate_ - 1) > 1e-10;
  if (!start && !porous_ && !stepped && ++matrix_age_ < longest_matrix_age) return;
  const std::vector<double> coefficient = pressure_coefficient();
  pressure_solver_.matrix().zero();
  loops_.diffusion(coefficient.data(), pressure_solver_.matrix().values.data());
  pressure_solver_.update(start);
  matrix_rate_ = bdf_.c0;
  matrix_age_ = 0;
}

FluidStep PressureCorrection::advance(double time, double dt) {
  set_void_fraction(mesh_, time + dt);
  const Past before = past();
  FluidStep step;
  try {
    prepare(time, dt, before);
    std::vector<double> phi, divergence;
    const bool unknown = before.steps == 0 && !initial_pressure_given_;
    const std::vector<double> start = unknown ? pressure_ : std::vector<double>();
    try {
      if (unknown) set_static_pressure(before);
      solve(before, step, phi, divergence);
      if (energy_) {
        std::vector<double> outflow = outflow_;
        for (int i = 0; i < mesh_.nodes; ++i) outflow[i] += boundaries_.flow()[i];
        std::vector<double> eddy;
        if (turbulence_) eddy = turbulence_->cell_eddy_conductivity(heat_capacity_, conductivity_, viscosity_);
        step.energy_iterations =
            energy_->solve(time, bdf_, dt, load_, superficial_velocity(phi), outflow, turbulence_ ? &eddy : nullptr);
      }
      if (turbulence_) step.turbulence_iterations = turbulence_->solve(time, bdf_, dt, turbulent_flow(solution_));
    } catch (const SolveFailure&) {
      if (unknown) pressure_ = start;
      throw;
    }
    accept(before, dt, phi, divergence);
    if (energy_) energy_->accept();
    if (turbulence_) turbulence_->accept();
  } catch (const SolveFailure&) {
    renew_ = true;
    throw;
  }
  step.mass_residual = mass_residual_;
  const FluidStep balance = report(dt);
  if (energy_) step.heat = energy_->heat();
  step.courant = balance.courant, step.boundary_force = balance.boundary_force;
  step.momentum = balance.momentum, step.lent = balance.lent;
  step.drive_gradient = balance.drive_gradient, step.drive_velocity = balance.drive_velocity;
  return step;
}

void PressureCorrection::solve(const Past& before, FluidStep& step, std::vector<double>& phi,
                               std::vector<double>& divergence) {
  const int n = mesh_.nodes;
  set_momentum_terms();
  assemble_momentum();
  solution_ = convecting_;
  step.velocity_iterations += velocity_solver_.solve(momentum_, momentum_.diagonal(), boundaries_, right_, solution_,
                                                     scheme_.velocity_tolerance);
  if (drive_ && drive_->controlled()) step.velocity_iterations += control_flow();

  std::vector<double> right = continuity(solution_, divergence);
  const std::vector<double> full_right = right;
  double flows = 0, inflow = 0;
  for (double flow : boundaries_.boundary_flow()) flows += flow, inflow += std::max(0.0, -flow);
  const double volume_rate = mesh_.dot(mass_.data(), load_.void_fraction_rate.data(), 1);
  if (boundaries_.closed()) {
    // Quadrature of an inflow that balances exactly leaves a small rest, spread evenly.
    boundaries_.check_balance(volume_rate, bdf_dt_);
    const double rest = (flows + volume_rate) / mesh_.volume;
    for (int i = 0; i < n; ++i) right[i] += mass_[i] * rest;
  }
  assemble_pressure(before);

  const auto& outlet = boundaries_.pressure_boundary();
  const double growth = before.dt > 0 ? bdf_dt_ / before.dt : 1;
  phi.resize(n);
  for (int i = 0; i < n; ++i)
    phi[i] = outlet[i] >= 0 ? boundaries_.pressure()[i] - pressure_[i]
                            : growth * ((1 + growth) * increment_[i] - growth * old_increment_[i]);
  step.pressure_iterations += pressure_solver_.solve(right, phi);
  if (mpi_any(!finite(phi) || !finite(solution_))) throw SolveFailure("the flow field became non-finite");

  const std::vector<double> rows = pressure_solver_.fixed_rows(phi);
  for (int i = 0; i < n; ++i) outflow_[i] = outlet[i] >= 0 ? full_right[i] - rows[i] : 0;
  mass_residual_ = volume_imbalance(flows, inflow, volume_rate);
}

std::unique_ptr<Fluid> make_pressure_correction(const Mesh& mesh, Options& options, const FluidOptions& fluid,
                                                const Vec3& gravity) {
  return std::make_unique<PressureCorrection>(mesh, options, fluid, gravity);
}

}  // namespace silt
