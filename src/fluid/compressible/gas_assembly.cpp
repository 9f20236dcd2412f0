// The loops of GasSystem over cells.
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
  out.turbulent = !step.eddy_viscosity.empty();
  if (out.turbulent) out.eddy_viscosity = step.eddy_viscosity[c], out.eddy_conductivity = step.eddy_conductivity[c];
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
  step.frozen.normal.resize(static_cast<size_t>(dim) * mesh_.cells);
  GasCell<C> cell;
  for (int c = 0; c < mesh_.cells; ++c) {
    gather(step, state, c, cell);
    cell.rate = 0;
    for (int a = 0; a < GasCell<C>::nodes; ++a)
      std::copy_n(&rate_now[static_cast<size_t>(mesh_.cell_nodes[static_cast<size_t>(c) * GasCell<C>::nodes + a]) * m],
                  m, cell.known[a]);
    step.frozen.viscosity[c] = freeze_cell<C>(
        cell, step.law, table, step.capturing, step.rate, &step.frozen.carried[static_cast<size_t>(each) * c],
        &step.frozen.normal[static_cast<size_t>(dim) * c], step.frozen.first_order[c]);
  }
}

void GasSystem::freeze(GasStep& step, const std::vector<double>& state, const std::vector<double>& rate_now) const {
  step.frozen.lumped = false;
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
               step.frozen.normal.data(),
               step.eddy_viscosity.empty() ? nullptr : step.eddy_viscosity.data(),
               step.eddy_conductivity.data(),
               step.rate,
               {step.gravity[0], step.gravity[1], step.gravity[2]},
               step.axisymmetric,
               false,
               step.frozen.lumped};
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

PetscErrorCode GasSystem::assemble(const GasStep& step, const std::vector<double>& state, double* residual,
                                   Mat matrix) const {
  PetscFunctionBeginUser;
  PetscCall(cells(step, state, residual, matrix));
  PetscCall(facets(step, state, residual, matrix));
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

}  // namespace silt
