// The boundary terms of GasSystem.
#include <algorithm>

#include "fluid/compressible/gas_system.hpp"
#include "fluid/compressible/viscous_flux.hpp"

namespace silt {

/// A point of a boundary facet: state and gradients from the nodes of its cell.
template <int dim>
struct GasSystem::FacetState {
  static constexpr int m = dim + 2;
  int nodes;        ///< of the cell
  const int* node;  ///< local nodes
  double N[8], g[8][3];
  double at[m] = {}, alpha = 0, radius, area;
  Vec3 normal;
  double gradient[dim][dim] = {};  ///< du_i/dx_j

  FacetState(const GasSystem& system, const GasStep& step, const std::vector<double>& state, size_t f, int q) {
    const Mesh& mesh = system.mesh_;
    const FacetRule& rule = system.boundary_.facets()[f];
    const FacetPoint& point = rule.point[q];
    nodes = mesh.nodes_per_cell;
    node = &mesh.cell_nodes[static_cast<size_t>(rule.cell) * nodes];
    area = point.area.norm();
    normal = point.area / area;
    radius = system.radius(point.x.y());
    system.shape_at(f, q, N, g);
    for (int a = 0; a < nodes; ++a) {
      const double* s = &state[static_cast<size_t>(node[a]) * m];
      alpha += N[a] * step.alpha[node[a]];
      for (int k = 0; k < m; ++k) at[k] += N[a] * s[k];
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) gradient[i][j] += g[a][j] * s[1 + i];
    }
  }
};

/// Shape functions of the facet's cell and their gradients (1/m) at one of its points.
void GasSystem::shape_at(size_t f, int q, double* N, double (*g)[3]) const {
  const FacetRule& rule = boundary_.facets()[f];
  const auto& local = facet_node_list(mesh_.cell, mesh_.facets[f].facet);
  const bool simplex = mesh_.cell == Cell::triangle || mesh_.cell == Cell::tetrahedron;
  double xi[3] = {}, dN[8][3];
  for (int a = 0; a < rule.nodes; ++a)
    for (int d = 0; d < dimension_; ++d)
      if (simplex ? local[a] == d + 1 : local[a] >> d & 1) xi[d] += rule.point[q].shape[a];
  shape(mesh_.cell, xi, N, dN);
  const double* x = &mesh_.cell_coordinates[3 * static_cast<size_t>(rule.cell) * mesh_.nodes_per_cell];
  Mat3 J = Mat3::Zero();
  for (int a = 0; a < mesh_.nodes_per_cell; ++a) J += vec3(x + 3 * a) * vec3(dN[a]).transpose();
  if (dimension_ == 2) J(2, 2) = 1;
  const Mat3 inverse = J.inverse().transpose();
  for (int a = 0; a < mesh_.nodes_per_cell; ++a) vec3(g[a]) = inverse * vec3(dN[a]);
}

namespace {

template <class S, int dim>
GasState<S, dim> state_of(const double* at) {
  GasState<S, dim> s;
  s.p = S(at[0]), s.T = S(at[dim + 1]);
  for (int i = 0; i < dim; ++i) s.u[i] = S(at[1 + i]);
  return s;
}

}  // namespace

template <int dim>
PetscErrorCode GasSystem::facets_of(const GasStep& step, const std::vector<double>& state, double* residual,
                                    Mat matrix) const {
  PetscFunctionBeginUser;
  constexpr int m = dim + 2;
  using D = Dual<m>;
  const auto& rules = boundary_.facets();
  std::vector<double> K;
  for (size_t f = 0; f < rules.size(); ++f) {
    const FacetRule& rule = rules[f];
    const auto& local = facet_node_list(mesh_.cell, mesh_.facets[f].facet);
    const int n = mesh_.nodes_per_cell, rows = n * m;
    const int* node = &mesh_.cell_nodes[static_cast<size_t>(rule.cell) * n];
    if (matrix) K.assign(static_cast<size_t>(rows) * rows, 0.0);
    for (int q = 0; q < rule.points; ++q) {
      const FacetState<dim> point(*this, step, state, f, q);
      if (point.radius == 0) continue;  // the axis
      const double w = point.alpha * point.area * point.radius;
      GasState<D, dim> s;
      s.p = D::variable(point.at[0], 0);
      for (int i = 0; i < dim; ++i) s.u[i] = D::variable(point.at[1 + i], 1 + i);
      s.T = D::variable(point.at[dim + 1], dim + 1);
      D F[m];
      if (step.open[f].empty())
        for (int i = 0; i < dim; ++i) F[1 + i] = s.p * point.normal[i];  // a wall
      else
        open_flux<D, dim>(step.law, step.open[f][q], s, point.normal.data(), F);
      for (int a = 0; a < rule.nodes; ++a)
        for (int k = 0; k < m; ++k) {
          residual[static_cast<size_t>(rule.node[a]) * m + k] += w * rule.point[q].shape[a] * F[k].value;
          for (int b = 0; matrix && b < n; ++b)
            for (int l = 0; l < m; ++l)
              K[(local[a] * m + k) * rows + b * m + l] += w * rule.point[q].shape[a] * point.N[b] * F[k].derivative[l];
        }
      if (viscous_through(step, f, q, point.normal)) {
        // Directions: u, T, grad u (row by row).
        constexpr int to_T = dim, to_gradient = dim + 1;
        using Wide = Dual<to_gradient + dim * dim>;
        auto inside = state_of<Wide, dim>(point.at);
        Wide gradient[dim][dim], V[m];
        for (int i = 0; i < dim; ++i) {
          inside.u[i] = Wide::variable(point.at[1 + i], i);
          for (int j = 0; j < dim; ++j)
            gradient[i][j] = Wide::variable(point.gradient[i][j], to_gradient + i * dim + j);
        }
        inside.T = Wide::variable(point.at[dim + 1], to_T);
        open_viscous_flux<Wide, dim>(step.law, inside, gradient, step.eddy(rule.cell), point.normal.data(), V);
        for (int a = 0; a < rule.nodes; ++a)
          for (int k = 1; k < m; ++k) {
            const double weight = -w * rule.point[q].shape[a];
            const double* d = V[k].derivative;
            residual[static_cast<size_t>(rule.node[a]) * m + k] += weight * V[k].value;
            for (int b = 0; matrix && b < n; ++b) {
              double* row = &K[(local[a] * m + k) * rows + b * m];
              row[dim + 1] += weight * point.N[b] * d[to_T];
              for (int j = 0; j < dim; ++j) {
                row[1 + j] += weight * point.N[b] * d[j];
                for (int i = 0; i < dim; ++i) row[1 + j] += weight * point.g[b][i] * d[to_gradient + j * dim + i];
              }
            }
          }
      }
    }
    if (!matrix) continue;
    constrain(step, n, node, K.data());
    PetscCall(MatSetValuesBlockedLocal(matrix, n, node, n, node, K.data(), ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode GasSystem::facets(const GasStep& step, const std::vector<double>& state, double* residual,
                                 Mat matrix) const {
  return dimension_ == 2 ? facets_of<2>(step, state, residual, matrix) : facets_of<3>(step, state, residual, matrix);
}

bool GasSystem::viscous_through(const GasStep& step, size_t f, int q, const Vec3& normal) const {
  return !step.open[f].empty() && (step.law.viscosity > 0 || !step.eddy_viscosity.empty()) &&
         viscous_flux_passes(step.law, step.open[f][q], normal.data(), dimension_);
}

/// Flux out of the domain at a point of a facet, all parts, per area.
template <int dim>
void GasSystem::flux_through(const GasStep& step, const FacetState<dim>& point, size_t f, int q, double* out) const {
  double F[dim + 2] = {}, V[dim + 2] = {};
  const auto s = state_of<double, dim>(point.at);
  if (step.open[f].empty())
    for (int i = 0; i < dim; ++i) F[1 + i] = s.p * point.normal[i];
  else
    open_flux<double, dim>(step.law, step.open[f][q], s, point.normal.data(), F);
  if (viscous_through(step, f, q, point.normal)) {
    const double eddy = step.eddy(boundary_.facets()[f].cell);
    open_viscous_flux<double, dim>(step.law, s, point.gradient, eddy, point.normal.data(), V);
  }
  for (int k = 0; k < dim + 2; ++k) out[k] = F[k] - V[k];
}

std::vector<GasBoundaryFlow> GasSystem::boundary_flow(const GasStep& step, const std::vector<double>& state) const {
  const int m = size(), d = dimension_;
  constexpr int columns = 8;  // mass, energy, volume, pressure, area, momentum
  std::vector<double> sums(columns * mesh_.boundaries.size(), 0.0);
  const auto& rules = boundary_.facets();
  const auto add = [&]<int dim>(size_t f, int q) {
    const FacetState<dim> point(*this, step, state, f, q);
    if (point.radius == 0) return;
    const double area = point.area * point.radius;
    double* sum = &sums[columns * static_cast<size_t>(rules[f].boundary)];
    double F[dim + 2], un = 0;
    flux_through<dim>(step, point, f, q, F);
    for (int i = 0; i < dim; ++i) un += point.at[1 + i] * point.normal[i];
    sum[0] += point.alpha * area * F[0];
    sum[1] += point.alpha * area * F[dim + 1];
    if (!step.open[f].empty()) sum[2] += point.alpha * area * un;
    sum[3] += area * point.at[0];
    sum[4] += area;
    for (int i = 0; i < dim; ++i) sum[5 + i] += point.alpha * area * F[1 + i];
  };
  for (size_t f = 0; f < rules.size(); ++f)
    for (int q = 0; q < rules[f].points; ++q)
      d == 2 ? add.template operator()<2>(f, q) : add.template operator()<3>(f, q);
  // The residual of the rows that conditions replaced is what the wall adds: friction, heat.
  std::vector<double> values(state.size(), 0.0);
  SILT_PETSC(assemble(step, state, values.data(), nullptr));
  add_wall_work(step, values.data());
  mesh_.sum_shared(values.data(), m);
  for (const auto& c : constraints_.constraints()) {
    if (c.node >= mesh_.owned_nodes) continue;
    double* sum = &sums[columns * static_cast<size_t>(boundary_.velocity_boundary()[c.node])];
    const double* r = &values[static_cast<size_t>(c.node) * m];
    Vec3 row = Vec3::Zero();
    for (int i = 0; i < d; ++i) row[i] = r[1 + i];
    for (int k = 0; k < c.count; ++k) vec3(sum + 5) -= c.frame[k] * c.frame[k].dot(row);
    if (boundary_.type(boundary_.velocity_boundary()[c.node]) == BoundaryType::no_slip)
      for (int i = 0; i < d; ++i) sum[1] -= step.prescribed_velocity[3 * static_cast<size_t>(c.node) + i] * r[1 + i];
  }
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    const double* r = &values[static_cast<size_t>(i) * m];
    const int b = temperature_boundary_[i];
    if (b < 0) continue;
    if (fixed_temperature_[i]) sums[columns * static_cast<size_t>(b) + 1] -= r[m - 1];
    sums[columns * static_cast<size_t>(b) + 1] -=
        step.heat[i] - step.heat_coefficient[i] * state[static_cast<size_t>(i) * m + m - 1];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  std::vector<GasBoundaryFlow> result(mesh_.boundaries.size());
  for (size_t b = 0; b < result.size(); ++b) {
    const double* s = &sums[columns * b];
    result[b] = {s[0], s[1], s[2], s[4] > 0 ? s[3] / s[4] : 0, s[4], vec3(s + 5)};
  }
  return result;
}

}  // namespace silt
