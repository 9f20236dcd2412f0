#include "fluid/turbulence/two_equation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "fluid/turbulence/realizable_k_epsilon.hpp"
#include "fluid/turbulence/sst_k_omega.hpp"
#include "fluid/turbulence/two_layer.hpp"
#include "fluid/turbulence/wall_distance.hpp"
#include "fluid/turbulence/wall_law.hpp"

namespace silt {
namespace {

constexpr double tiny = 1e-30;
const double friction_factor = std::pow(wall_law::C_mu, 0.25);  // u* = C_mu^(1/4) sqrt(k)

}  // namespace

template <class Model>
TwoEquation<Model>::TwoEquation(const Mesh& mesh, Options& options, const TurbulenceOptions& read,
                                const BoundaryConditions& boundaries, bool axisymmetric)
    : Turbulence(read, wall_distance_of(mesh, boundaries)),
      mesh_(mesh),
      boundaries_(boundaries),
      inflow_(mesh, options, boundaries),
      rule_(mesh, axisymmetric),
      graph_(mesh),
      layer_(mesh, boundaries, wall_distance_),
      resolved_(read.wall == "resolved"),
      axisymmetric_(axisymmetric),
      k_transport_(rule_, graph_, "fluid_turbulent_energy_"),
      second_transport_(rule_, graph_, "fluid_turbulent_dissipation_"),
      initial_(mesh, options, read, epsilon),
      dilatation_(read.compressibility_correction),
      turning_(read.production == "kato_launder") {
  for (auto* field : {&k_, &old_k_, &second_, &old_second_, &dissipation_, &eddy_viscosity_})
    field->assign(mesh.nodes, 0.0);
  cell_eddy_viscosity_.assign(mesh.cells, 0.0);
  wall_y_plus_.assign(mesh.cells, 0.0);
  const auto source = [&options](const std::string& name, const std::string& text) {
    std::function<double(const Vec3&, double)> formula;
    if (!options.given(name)) return formula;
    const auto expression = std::make_shared<Expression>(name, text);
    formula = [expression](const Vec3& x, double t) { return (*expression)(x, t); };
    return formula;
  };
  energy_source = source("fluid_turbulent_energy_source", read.energy_source);
  second_source = source("fluid_turbulent_dissipation_source", read.dissipation_source);
}

template <class Model>
double TwoEquation<Model>::inflow_second(int boundary, const Flow& flow, int node, double t, double k) const {
  const auto scale = inflow_.scale(boundary, vec3(&mesh_.node_coordinates[3 * static_cast<std::size_t>(node)]), t);
  return scale.length > 0
             ? Model::second_of_length(k, scale.length)
             : Model::second_of_viscosity(flow.density[node], k, scale.viscosity_ratio * flow.viscosity[node]);
}

template <class Model>
void TwoEquation<Model>::start(const Flow& flow) {
  if (dilatation_.law != DilatationDissipation::Law::none && !flow.compressible)
    throw UserError(
        fmt::format("-fluid_compressibility_correction {} needs -fluid_type compressible: sound has no speed otherwise",
                    options_.compressibility_correction));
  k_ = initial_.k(), second_ = initial_.second();
  if (!initial_.from_file()) {
    k_.resize(mesh_.nodes), second_.resize(mesh_.nodes);
    for (int i = 0; i < mesh_.nodes; ++i) {
      const Vec3 x = vec3(&mesh_.node_coordinates[3 * static_cast<std::size_t>(i)]);
      k_[i] = initial_.energy(x);
      const double mu_t = initial_.viscosity_ratio(x) * flow.viscosity[i];
      second_[i] = Model::second_of_viscosity(flow.density[i], k_[i], mu_t);
    }
  }
  State state{k_, second_, eddy_viscosity_, {}, {}};
  for (int i = 0; i < mesh_.nodes; ++i)  // so that no scheme starts from a wall with the turbulence of the core
    if (layer_.kind()[i] == WallLayer::wall && resolved_) state.k[i] = 0;
  for (int i = 0; i < mesh_.nodes; ++i) wall_value(flow, k_, i, state.second[i]);
  set_viscosity(flow, fields(flow), state);
  next_ = std::move(state);
  accept();
  old_k_ = k_, old_second_ = second_;
}

template <class Model>
auto TwoEquation<Model>::fields(const Flow& flow) const -> Fields {
  const std::size_t n = mesh_.nodes;
  Fields f;
  std::vector<double> gradient;
  rule_.gradient(flow.velocity, 3, gradient);
  f.strain.resize(n);
  f.flux.resize(3 * n);
  for (std::size_t i = 0; i < n; ++i) {
    Mat3 g = Eigen::Map<const Mat3>(&gradient[9 * i]).transpose();
    if (axisymmetric_) {  // u_r/r, on the axis du_r/dr
      const double r = mesh_.node_coordinates[3 * i + 1];
      g(2, 2) = r > 1e-12 * mesh_.upper.y() ? flow.velocity[3 * i + 1] / r : g(1, 1);
    }
    f.strain[i] = strain(g);
    vec3(&f.flux[3 * i]) = flow.void_fraction[i] * flow.density[i] * vec3(&flow.velocity[3 * i]);
  }
  f.speed = layer_.speed(flow.velocity);
  add_entering(f);
  return f;
}

template <class Model>
void TwoEquation<Model>::add_entering(Fields& f) const {
  const std::size_t n = mesh_.nodes;
  f.entering.assign(n, 0.0);
  f.entering_from.assign(n, -1);
  std::vector<double> through(n);
  for (int b = 0; b < static_cast<int>(mesh_.boundaries.size()); ++b) {
    if (!boundaries_.open(b) || !inflow_.given(b)) continue;
    std::fill(through.begin(), through.end(), 0.0);
    for (const auto& facet : boundaries_.facets()) {
      if (facet.boundary != b) continue;
      for (int q = 0; q < facet.points; ++q) {
        const auto& point = facet.point[q];
        const double area = axisymmetric_ ? point.x.y() : 1.0;
        for (int a = 0; a < facet.nodes; ++a) {
          const std::size_t node = facet.node[a];
          through[node] -= area * point.shape[a] * vec3(&f.flux[3 * node]).dot(point.area);
        }
      }
    }
    mesh_.sum_shared(through.data(), 1);
    for (std::size_t i = 0; i < n; ++i)
      if (through[i] > 0 && f.entering_from[i] < 0) f.entering[i] = through[i], f.entering_from[i] = b;
  }
}

template <class Model>
std::vector<TurbulentPoint> TwoEquation<Model>::points(const Flow& flow, const Fields& f, const State& state) const {
  const std::size_t n = mesh_.nodes;
  std::vector<double> both(2 * n), gradient;
  for (std::size_t i = 0; i < n; ++i) both[2 * i] = state.k[i], both[2 * i + 1] = state.second[i];
  rule_.gradient(both, 2, gradient);
  std::vector<TurbulentPoint> result(n);
  for (std::size_t i = 0; i < n; ++i) {
    auto& p = result[i];
    p = {flow.density[i], flow.viscosity[i], state.k[i], state.second[i], wall_distance_[i], 0, 0, f.strain[i]};
    p.cross = vec3(&gradient[6 * i]).dot(vec3(&gradient[6 * i + 3]));
    const double shear = state.viscosity[i] * p.strain.shear * (turning_ ? p.strain.vorticity : p.strain.shear);
    p.production = wall_production(flow, f, p.k, static_cast<int>(i), shear);
  }
  return result;
}

template <class Model>
double TwoEquation<Model>::eddy_viscosity(const TurbulentPoint& p, int node) const {
  if (resolved_ && layer_.kind()[node] == WallLayer::wall) return 0;
  double mu_t = Model::eddy_viscosity(p);
  if constexpr (epsilon)
    if (resolved_) mu_t = two_layer::eddy_viscosity(mu_t, p.density, p.viscosity, p.k, p.distance);
  return std::min(mu_t, options_.largest_ratio * p.viscosity);
}

template <class Model>
bool TwoEquation<Model>::wall_value(const Flow& flow, const std::vector<double>& k, int i, double& value) const {
  const auto kind = layer_.kind()[i];
  const double nu = flow.viscosity[i] / flow.density[i];
  const double y = kind == WallLayer::interior ? wall_distance_[i] : layer_.height()[i];
  if (kind != WallLayer::interior && !(y > 0)) {  // a corner whose cells have no node inside
    value = tiny;
    return true;
  }
  if (resolved_) {
    if constexpr (epsilon) {
      if (kind == WallLayer::interior && !two_layer::holds(nu, k[i], y)) return false;
      value = std::max(two_layer::dissipation(nu, k[i], y), tiny);
      return true;
    }
    if (kind != WallLayer::wall) return false;
    value = 60 * nu / (SstKOmega::beta_1 * y * y);
    return true;
  }
  if (kind == WallLayer::interior) return false;
  const double friction = friction_factor * std::sqrt(k[i]);
  if constexpr (epsilon) {
    const double shifted = std::max(y, wall_law::sublayer * nu / std::max(friction, tiny));
    value = std::max(friction * friction * friction / (wall_law::kappa * shifted), tiny);
  } else {
    const double viscous = 6 * nu / (SstKOmega::beta_1 * y * y),
                 logarithmic = friction / (std::sqrt(SstKOmega::beta_star) * wall_law::kappa * y);
    value = std::hypot(viscous, logarithmic);
  }
  return true;
}

template <class Model>
double TwoEquation<Model>::wall_production(const Flow& flow, const Fields& f, double k, int i, double otherwise) const {
  if (resolved_ || layer_.kind()[i] == WallLayer::interior) return otherwise;
  const double rho = flow.density[i], nu = flow.viscosity[i] / rho, y = layer_.height()[i];
  if (!(y > 0)) return 0;
  const double friction = std::max(friction_factor * std::sqrt(k), tiny), y_plus = friction * y / nu;
  if (!epsilon && y_plus < wall_law::sublayer) return otherwise;
  const double shifted = std::max(y, wall_law::sublayer * nu / friction);
  return rho * friction * friction * f.speed[i] / (wall_law::speed(y_plus) * wall_law::kappa * shifted);
}

template <class Model>
std::vector<char> TwoEquation<Model>::impose(const Flow& flow, double t, State& state) const {
  std::vector<char> fixed(mesh_.nodes, 0);
  for (int i = 0; i < mesh_.nodes; ++i) {
    const std::size_t at = 3 * static_cast<std::size_t>(i);
    const int b = boundaries_.velocity_boundary()[i];
    if (layer_.kind()[i] == WallLayer::wall) {
      fixed[i] = resolved_;
      if (resolved_) state.k[i] = 0;
    } else if (b >= 0 && !boundaries_.open(b) && boundaries_.type(b) != BoundaryType::slip && inflow_.given(b)) {
      const double k = inflow_.energy(b, vec3(&mesh_.node_coordinates[at]), t, vec3(&flow.velocity[at]).norm());
      if (!(k > 0)) continue;  // nothing enters yet; k = 0 would leave the scale of its eddies undefined
      fixed[i] = 2;
      state.k[i] = k;
      state.second[i] = inflow_second(b, flow, i, t, k);
    }
  }
  return fixed;
}

template <class Model>
void TwoEquation<Model>::set_sources(const Flow& flow, const std::vector<TurbulentPoint>& points, const State& state,
                                     double t, PositiveTransport::Terms& energy,
                                     PositiveTransport::Terms& second) const {
  for (int i = 0; i < mesh_.nodes; ++i) {
    const TurbulentPoint& p = points[i];
    const Vec3 x = vec3(&mesh_.node_coordinates[3 * static_cast<std::size_t>(i)]);
    const double alpha = flow.void_fraction[i];
    const TurbulentTerms terms = Model::terms(p, state.viscosity[i]);
    energy.diffusivity[i] = alpha * terms.k_diffusivity, second.diffusivity[i] = alpha * terms.second_diffusivity;
    energy.production[i] = alpha * terms.k_production, second.production[i] = alpha * terms.second_production;
    energy.destruction[i] = alpha * terms.k_destruction, second.destruction[i] = alpha * terms.second_destruction;
    const auto add = [](double source, double value, double& production, double& destruction) {
      production += std::max(0.0, source);
      destruction += std::max(0.0, -source) / std::max(value, tiny);
    };
    if (energy_source) add(energy_source(x, t), p.k, energy.production[i], energy.destruction[i]);
    if (second_source) add(second_source(x, t), p.second, second.production[i], second.destruction[i]);
    if (flow.compressible) {  // work of the dilatation, -2/3 rho k div u
      const double rate = 2.0 / 3 * alpha * p.density * p.strain.dilatation;
      energy.production[i] += std::max(0.0, -rate) * p.k;
      energy.destruction[i] += std::max(0.0, rate);
    }
    add_dilatation(flow, p, terms.free, i, energy, second);
    if (flow.source.empty() || flow.source[i] == 0) continue;
    const double added = flow.source[i] / rule_.volume()[i], k = std::max(p.k, tiny);
    add(added, p.k, energy.production[i], energy.destruction[i]);
    const double factor = flow.dissipation_factor - (epsilon ? 0 : 1);  // d(omega)/omega = d(epsilon)/epsilon - dk/k
    add(factor * added * p.second / k, p.second, second.production[i], second.destruction[i]);
  }
}

template <class Model>
void TwoEquation<Model>::add_dilatation(const Flow& flow, const TurbulentPoint& p, double free, int i,
                                        PositiveTransport::Terms& energy, PositiveTransport::Terms& second) const {
  if (flow.sound.empty()) return;
  const double share = free * dilatation_.ratio(p.k, flow.sound[i], flow.heat_ratio);
  if (share == 0) return;
  const double dissipated = flow.void_fraction[i] * share * p.density * Model::dissipation(p.k, p.second);
  // epsilon_d = epsilon_d* (2 k/k* - 1), as the epsilon of the equation of k; omega = epsilon/(beta* k) rises as k
  // falls.
  energy.production[i] += dissipated;
  energy.destruction[i] += 2 * dissipated / std::max(p.k, tiny);
  if constexpr (!epsilon) second.production[i] += dissipated * p.second / std::max(p.k, tiny);
}

template <class Model>
int TwoEquation<Model>::solve(double time, const Bdf& bdf, double dt, const Flow& flow) {
  const int n = mesh_.nodes;
  const double end = time + dt;
  const Fields f = fields(flow);
  PositiveTransport::Terms energy(n), second(n);
  for (auto* terms : {&energy, &second}) {
    terms->flux = &f.flux, terms->rate = bdf.c0, terms->entering = f.entering;
    terms->entering_value.assign(n, 0.0);
  }
  for (int i = 0; i < n; ++i) {
    const std::size_t at = 3 * static_cast<std::size_t>(i);
    energy.storage[i] = second.storage[i] = flow.void_fraction[i] * flow.density[i];
    energy.history[i] = bdf.c1 * k_[i] - bdf.c2 * old_k_[i];
    second.history[i] = bdf.c1 * second_[i] - bdf.c2 * old_second_[i];
    const int b = f.entering_from[i];
    if (b < 0) continue;
    energy.entering_value[i] =
        inflow_.energy(b, vec3(&mesh_.node_coordinates[at]), end, vec3(&flow.velocity[at]).norm());
    second.entering_value[i] = inflow_second(b, flow, i, end, energy.entering_value[i]);
  }
  next_ = {k_, second_, eddy_viscosity_, {}, {}};
  const std::vector<char> fixed = impose(flow, end, next_);
  int iterations = 0;
  for (int pass = 0; pass < options_.iterations; ++pass) {
    set_sources(flow, points(flow, f, next_), next_, end, energy, second);
    iterations += k_transport_.solve(energy, fixed, next_.k);
    std::vector<double> nearby = next_.k;  // on resolved walls, where k is 0, that of the first nodes
    if (resolved_) layer_.extend(nearby);
    std::vector<char> second_fixed(n);
    for (int i = 0; i < n; ++i) second_fixed[i] = fixed[i] == 2 || wall_value(flow, nearby, i, next_.second[i]);
    iterations += second_transport_.solve(second, second_fixed, next_.second);
    set_viscosity(flow, f, next_);
  }
  exchange_.resize(n);
  for (int i = 0; i < n; ++i)
    exchange_[i] = rule_.volume()[i] * (energy.production[i] - energy.destruction[i] * next_.k[i]);
  return iterations;
}

template <class Model>
void TwoEquation<Model>::set_viscosity(const Flow& flow, const Fields& f, State& state) const {
  const std::vector<TurbulentPoint> at_nodes = points(flow, f, state);
  for (int i = 0; i < mesh_.nodes; ++i) state.viscosity[i] = eddy_viscosity(at_nodes[i], i);
  const std::size_t corners = mesh_.nodes_per_cell;
  state.cell_viscosity.assign(mesh_.cells, 0.0);
  state.y_plus.assign(mesh_.cells, 0.0);
  for (int c = 0; c < mesh_.cells; ++c)
    for (std::size_t a = 0; a < corners; ++a)
      state.cell_viscosity[c] += state.viscosity[mesh_.cell_nodes[corners * c + a]] / corners;
  if (resolved_) return;
  for (const auto& at : layer_.cells()) {
    const double rho = layer_.mean(at.cell, flow.density), mu = layer_.mean(at.cell, flow.viscosity);
    const double y_plus = rho * friction_factor * std::sqrt(layer_.mean(at.cell, state.k)) * at.height / mu;
    if (!epsilon && y_plus < wall_law::sublayer) continue;
    state.cell_viscosity[at.cell] = mu * std::max(0.0, y_plus / wall_law::speed(y_plus) - 1);
    state.y_plus[at.cell] = y_plus;
  }
}

template <class Model>
void TwoEquation<Model>::set_dissipation() {
  for (int i = 0; i < mesh_.nodes; ++i) dissipation_[i] = Model::dissipation(k_[i], second_[i]);
}

template <class Model>
void TwoEquation<Model>::accept() {
  old_k_ = std::exchange(k_, next_.k);
  old_second_ = std::exchange(second_, next_.second);
  eddy_viscosity_ = next_.viscosity;
  cell_eddy_viscosity_ = next_.cell_viscosity;
  wall_y_plus_ = next_.y_plus;
  set_dissipation();
}

template <class Model>
void TwoEquation<Model>::add_scalars(std::vector<Fluid::Scalar>& scalars) const {
  scalars.push_back({"turbulent_energy", k_});
  scalars.push_back({epsilon ? "turbulent_dissipation" : "specific_dissipation", second_});
  Turbulence::add_scalars(scalars);
}

template <class Model>
void TwoEquation<Model>::add_state(std::vector<Fluid::StateArray>& arrays) {
  arrays.push_back({"turbulent_energy", &k_, 1});
  arrays.push_back({"old_turbulent_energy", &old_k_, 1});
  arrays.push_back({"turbulent_dissipation", &second_, 1});
  arrays.push_back({"old_turbulent_dissipation", &old_second_, 1});
  Turbulence::add_state(arrays);
}

template class TwoEquation<RealizableKEpsilon>;
template class TwoEquation<SstKOmega>;

}  // namespace silt
