#include "fluid/initial_projection.hpp"

#include <algorithm>

#include "base/nodal_gradient.hpp"
#include "base/nodal_matrix.hpp"
#include "fluid/pressure_correction/cell_loops.hpp"
#include "fluid/pressure_correction/pressure_solver.hpp"

namespace silt {
namespace {

/// The gradient at the nodes is a mean over the cells around: what it leaves of the divergence is taken by the next
/// pass.
constexpr int passes = 4;

}  // namespace

double project_onto_continuity(const Mesh& mesh, const BoundaryConditions& boundary,
                               std::span<const double> void_fraction, std::span<const double> solids_flux,
                               std::vector<double>& velocity) {
  const NodalGraph graph(mesh);
  const CellLoops loops(graph);
  const std::vector<double> mass = lumped_mass(mesh), before = velocity;
  const std::size_t nodes = mesh.nodes, padded = loops.padded_cells(), nv = mesh.nodes_per_cell;
  std::vector<double> weight(padded, 1.0);
  for (std::size_t c = 0; c < static_cast<std::size_t>(mesh.cells); ++c) {
    weight[c] = 0;
    for (std::size_t a = 0; a < nv; ++a)
      weight[c] += void_fraction[mesh.cell_nodes[nv * c + a]] / static_cast<double>(nv);
  }
  PressureSolver solver(graph, boundary.pressure_boundary(), boundary.closed());
  solver.matrix().zero();
  loops.diffusion(weight.data(), solver.matrix().values.data());
  solver.update(true);
  const NodalGradient gradient(mesh, mass);
  const std::vector<double> nothing(3 * nodes, 0.0), none(padded, 0.0);
  std::vector<double> flux(3 * nodes), sums(2 * nodes), right(nodes), slope;
  for (int pass = 0; pass < passes; ++pass) {
    // int alpha grad q . grad phi = int grad q . (alpha u + j) - oint q U.n
    for (std::size_t k = 0; k < flux.size(); ++k) flux[k] = void_fraction[k / 3] * velocity[k] + solids_flux[k];
    std::fill(sums.begin(), sums.end(), 0.0);
    loops.continuity({flux.data(), nothing.data(), nothing.data(), none.data(), {nullptr, nullptr, nullptr}},
                     sums.data());
    mesh.sum_shared(sums.data(), 2);
    double rest = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
      right[i] = sums[2 * i] - boundary.flow()[i];
      if (i < static_cast<std::size_t>(mesh.owned_nodes)) rest += right[i];
    }
    if (boundary.closed()) {  // what the boundaries prescribe and the solids leave over is spread evenly
      rest = mpi_sum(rest) / mesh.volume;
      for (std::size_t i = 0; i < nodes; ++i) right[i] -= mass[i] * rest;
    }
    std::vector<double> phi(nodes, 0.0);
    for (int k = 0; k < 3; ++k) solver.solve(right, phi);  // each solve leaves a thousandth
    gradient.apply(phi, 1, slope);
    for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] -= slope[k];
    if (mesh.dimension == 2)
      for (std::size_t i = 0; i < nodes; ++i) velocity[3 * i + 2] = 0;
    boundary.impose(velocity.data());
  }
  double change = 0;
  for (std::size_t i = 0; i < nodes; ++i)
    change = std::max(change, (vec3(&velocity[3 * i]) - vec3(&before[3 * i])).norm());
  return mpi_max(change);
}

}  // namespace silt
