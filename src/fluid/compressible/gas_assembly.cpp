// The loops of GasSystem over cells and facets.
#include <algorithm>

#include "fluid/compressible/gas_system.hpp"

namespace silt {

template <Cell C>
void GasSystem::gather(const GasStep& step, const std::vector<double>& state, int c, GasCell<C>& out) const {
  constexpr int dim = GasCell<C>::dim, m = dim + 2;
  out.rate = step.rate;
  out.axisymmetric = step.axisymmetric;
  std::copy_n(step.gravity, 3, out.gravity);
  out.porous = true;
  for (int a = 0; a < GasCell<C>::nodes; ++a) {
    const size_t i = mesh_.cell_nodes[static_cast<size_t>(c) * GasCell<C>::nodes + a];
    std::copy_n(&mesh_.cell_coordinates[3 * (static_cast<size_t>(c) * GasCell<C>::nodes + a)], dim, out.x[a]);
    const double* s = &state[i * m];
    out.state[a].p = s[0];
    for (int k = 0; k < dim; ++k) out.state[a].u[k] = s[1 + k];
    out.state[a].T = s[dim + 1];
    out.alpha[a] = step.alpha[i];
    out.alpha_rate[a] = step.alpha_rate[i];
    std::copy_n(&step.known[i * m], m, out.known[a]);
    std::copy_n(&step.source[i * m], m, out.source[a]);
  }
}

template <Cell C>
void GasSystem::freeze_cells(GasStep& step, const std::vector<double>& state,
                             const std::vector<double>& rate_now) const {
  constexpr int dim = GasCell<C>::dim, m = dim + 2, each = dim * m * m;
  const FlowTable& table = flow_table(C, 1);
  step.frozen.carried.resize(static_cast<size_t>(each) * mesh_.cells);
  step.frozen.viscosity.resize(mesh_.cells);
  step.frozen.first_order.resize(mesh_.cells);
  GasCell<C> cell;
  for (int c = 0; c < mesh_.cells; ++c) {
    gather(step, state, c, cell);
    cell.rate = 0;
    for (int a = 0; a < GasCell<C>::nodes; ++a)
      std::copy_n(&rate_now[static_cast<size_t>(mesh_.cell_nodes[static_cast<size_t>(c) * GasCell<C>::nodes + a]) * m],
                  m, cell.known[a]);
    step.frozen.viscosity[c] =
        freeze_cell<C>(cell, step.law, table, step.capturing, step.rate,
                       &step.frozen.carried[static_cast<size_t>(each) * c], step.frozen.first_order[c]);
  }
}

void GasSystem::freeze(GasStep& step, const std::vector<double>& state, const std::vector<double>& rate_now) const {
  switch (mesh_.cell) {
    case Cell::triangle:
      return freeze_cells<Cell::triangle>(step, state, rate_now);
    case Cell::quadrilateral:
      return freeze_cells<Cell::quadrilateral>(step, state, rate_now);
    case Cell::tetrahedron:
      return freeze_cells<Cell::tetrahedron>(step, state, rate_now);
    case Cell::hexahedron:
      return freeze_cells<Cell::hexahedron>(step, state, rate_now);
  }
}

PetscErrorCode GasSystem::cells(const GasStep& step, const std::vector<double>& state, double* residual,
                                Mat matrix) const {
  PetscFunctionBeginUser;
  const int n = mesh_.nodes_per_cell, m = size(), rows = n * m;
  GasData data{&flow_table(mesh_.cell, 1),
               step.law,
               mesh_.cell_nodes.data(),
               mesh_.cell_coordinates.data(),
               state.data(),
               step.known.data(),
               step.source.data(),
               step.alpha.data(),
               step.alpha_rate.data(),
               step.frozen.carried.data(),
               step.frozen.viscosity.data(),
               step.rate,
               {step.gravity[0], step.gravity[1], step.gravity[2]},
               step.axisymmetric,
               false};
  for (int i = 0; i < mesh_.nodes && !data.porous; ++i) data.porous = step.alpha[i] != 1 || step.alpha_rate[i] != 0;
  const size_t each = static_cast<size_t>(rows) * rows;
  std::vector<double> r(static_cast<size_t>(loop_.lanes) * rows), K(matrix ? loop_.lanes * each : 0);
  for (int first = 0; first < mesh_.cells; first += loop_.lanes) {
    const int count = std::min(loop_.lanes, mesh_.cells - first);
    loop_.evaluate(data, first, count, r.data(), matrix ? K.data() : nullptr);
    for (int l = 0; l < count; ++l) {
      const int* node = &mesh_.cell_nodes[static_cast<size_t>(first + l) * n];
      for (int a = 0; a < n; ++a)
        for (int k = 0; k < m; ++k) residual[static_cast<size_t>(node[a]) * m + k] += r[(l * n + a) * m + k];
      if (!matrix) continue;
      constrain(step, n, node, &K[l * each]);
      PetscCall(MatSetValuesBlockedLocal(matrix, n, node, n, node, &K[l * each], ADD_VALUES));
    }
  }
  PetscFunctionReturn(0);
}

template <int dim>
PetscErrorCode GasSystem::facets(const GasStep& step, const std::vector<double>& state, double* residual,
                                 Mat matrix) const {
  PetscFunctionBeginUser;
  constexpr int m = dim + 2;
  using D = Dual<m>;
  const auto& rules = boundary_.facets();
  for (size_t f = 0; f < rules.size(); ++f) {
    const FacetRule& rule = rules[f];
    const int n = rule.nodes, rows = n * m;
    double K[16 * (dim + 2) * (dim + 2)] = {};
    for (int q = 0; q < rule.points; ++q) {
      const FacetPoint& point = rule.point[q];
      double at[m] = {}, alpha = 0;
      for (int a = 0; a < n; ++a) {
        const size_t i = rule.node[a];
        alpha += point.shape[a] * step.alpha[i];
        for (int k = 0; k < m; ++k) at[k] += point.shape[a] * state[i * m + k];
      }
      const double area = point.area.norm(), w = alpha * area * radius(point.x.y());
      const Vec3 normal = point.area / area;
      GasState<D, dim> s;
      s.p = D::variable(at[0], 0);
      for (int i = 0; i < dim; ++i) s.u[i] = D::variable(at[1 + i], 1 + i);
      s.T = D::variable(at[dim + 1], dim + 1);
      D F[m];
      if (step.open[f].empty())
        for (int i = 0; i < dim; ++i) F[1 + i] = s.p * normal[i];  // a wall
      else
        open_flux<D, dim>(step.law, step.open[f][q], s, normal.data(), F);
      for (int a = 0; a < n; ++a)
        for (int k = 0; k < m; ++k) {
          residual[static_cast<size_t>(rule.node[a]) * m + k] += w * point.shape[a] * F[k].value;
          for (int b = 0; matrix && b < n; ++b)
            for (int l = 0; l < m; ++l)
              K[(a * m + k) * rows + b * m + l] += w * point.shape[a] * point.shape[b] * F[k].derivative[l];
        }
    }
    if (!matrix) continue;
    constrain(step, n, rule.node.data(), K);
    PetscCall(MatSetValuesBlockedLocal(matrix, n, rule.node.data(), n, rule.node.data(), K, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode GasSystem::assemble(const GasStep& step, const std::vector<double>& state, double* residual,
                                   Mat matrix) const {
  PetscFunctionBeginUser;
  PetscCall(cells(step, state, residual, matrix));
  PetscCall(dimension_ == 2 ? facets<2>(step, state, residual, matrix) : facets<3>(step, state, residual, matrix));
  nodes(step, state, residual);
  PetscFunctionReturn(0);
}

std::vector<double> GasSystem::conserved(const GasStep& step, const std::vector<double>& state) const {
  const size_t m = size();
  std::vector<double> U(state.size());
  for (int i = 0; i < mesh_.nodes; ++i) {
    const double* s = &state[i * m];
    double* out = &U[i * m];
    const double rho = step.alpha[i] * s[0] / s[m - 1];
    double kinetic = 0;
    for (size_t k = 1; k + 1 < m; ++k) kinetic += 0.5 * s[k] * s[k];
    out[0] = rho;
    for (size_t k = 1; k + 1 < m; ++k) out[k] = rho * s[k];
    out[m - 1] = step.alpha[i] * s[0] * step.law.cv() + rho * kinetic;
  }
  return U;
}

std::vector<GasBoundaryFlow> GasSystem::boundary_flow(const GasStep& step, const std::vector<double>& state) const {
  const int m = size(), d = dimension_;
  constexpr int columns = 8;  // mass, energy, volume, pressure, area, momentum
  std::vector<double> sums(columns * mesh_.boundaries.size(), 0.0);
  const auto& rules = boundary_.facets();
  for (size_t f = 0; f < rules.size(); ++f) {
    const FacetRule& rule = rules[f];
    double* sum = &sums[columns * static_cast<size_t>(rule.boundary)];
    for (int q = 0; q < rule.points; ++q) {
      const FacetPoint& point = rule.point[q];
      double at[5] = {}, alpha = 0;
      for (int a = 0; a < rule.nodes; ++a) {
        alpha += point.shape[a] * step.alpha[rule.node[a]];
        for (int k = 0; k < m; ++k) at[k] += point.shape[a] * state[static_cast<size_t>(rule.node[a]) * m + k];
      }
      const double length = point.area.norm(), area = length * radius(point.x.y());
      const Vec3 normal = point.area / length;
      double F[5] = {};
      const auto evaluate = [&]<int dim>() {
        GasState<double, dim> s;
        s.p = at[0], s.T = at[dim + 1];
        for (int i = 0; i < dim; ++i) s.u[i] = at[1 + i];
        double flux[dim + 2] = {};
        if (step.open[f].empty())
          for (int i = 0; i < dim; ++i) flux[1 + i] = s.p * normal[i];
        else
          open_flux<double, dim>(step.law, step.open[f][q], s, normal.data(), flux);
        std::copy_n(flux, dim + 2, F);
      };
      d == 2 ? evaluate.template operator()<2>() : evaluate.template operator()<3>();
      double un = 0;
      for (int i = 0; i < d; ++i) un += at[1 + i] * normal[i];
      sum[0] += alpha * area * F[0];
      sum[1] += alpha * area * F[m - 1];
      if (!step.open[f].empty()) sum[2] += alpha * area * un;
      sum[3] += area * at[0];
      sum[4] += area;
      for (int i = 0; i < d; ++i) sum[5 + i] += alpha * area * F[1 + i];
    }
  }
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
