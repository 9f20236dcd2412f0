#include "particles/potential.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/expression.hpp"
#include "base/nodal_gradient.hpp"
#include "base/nodal_matrix.hpp"

namespace silt {

ElectricPotential::ElectricPotential(const Mesh& mesh, Options& options, double permittivity,
                                     const std::string& charge_density)
    : mesh_(mesh), locator_(mesh), fixed_(mesh.nodes, 0), potential_(mesh.nodes, 0.0) {
  fix_boundaries(options);
  const std::vector<double> mass = lumped_mass(mesh);
  const Expression density("electric_charge_density", charge_density);
  std::vector<double> charge(mesh.nodes);
  for (int i = 0; i < mesh.nodes; ++i)
    charge[i] = mass[i] * density(vec3(&mesh.node_coordinates[3 * static_cast<std::size_t>(i)]), 0);
  solve(permittivity, charge);
  const NodalGradient gradient(mesh, mass);
  gradient.apply(potential_, 1, field_);
  for (double& component : field_) component = -component;
  gradient.apply(field_, 3, slope_);
}

void ElectricPotential::fix_boundaries(Options& options) {
  // A node on two boundaries with a potential takes the mean of both.
  std::vector<double> sums(2 * static_cast<std::size_t>(mesh_.nodes), 0.0);
  bool given_somewhere = false;
  for (int b = 0; b < static_cast<int>(mesh_.boundaries.size()); ++b) {
    PotentialBoundaryOptions given;
    options.read("boundary_" + mesh_.boundaries[b], given);
    if (given.potential.empty()) continue;
    given_somewhere = true;
    const Expression formula("boundary_" + mesh_.boundaries[b] + "_potential", given.potential);
    std::vector<char> here(mesh_.nodes, 0);
    for (const BoundaryFacet& facet : mesh_.facets)
      if (facet.boundary == b)
        for (int k = 0; k < facet_nodes(mesh_.cell); ++k)
          here[mesh_.cell_nodes[static_cast<std::size_t>(facet.cell) * mesh_.nodes_per_cell +
                                facet_node_list(mesh_.cell, facet.facet)[k]]] = 1;
    for (int i = 0; i < mesh_.nodes; ++i)
      if (here[i]) {
        sums[2 * i] += formula(vec3(&mesh_.node_coordinates[3 * static_cast<std::size_t>(i)]), 0);
        sums[2 * i + 1] += 1;
      }
  }
  if (!given_somewhere)
    throw UserError("-electric_solve needs a boundary with a potential: -boundary_<name>_potential");
  mesh_.sum_shared(sums.data(), 2);
  for (int i = 0; i < mesh_.nodes; ++i)
    if (sums[2 * i + 1] > 0) {
      fixed_[i] = 1;
      potential_[i] = sums[2 * i] / sums[2 * i + 1];
    }
}

void ElectricPotential::solve(double permittivity, const std::vector<double>& charge) {
  const NodalGraph graph(mesh_);
  NodalMatrix matrix(graph);
  add_stiffness(matrix, permittivity);
  std::vector<double> right(mesh_.nodes);
  matrix.apply(potential_.data(), right.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i) right[i] = fixed_[i] ? 0 : charge[i] - right[i];
  // Rows and columns of given nodes are those of the unit matrix; the rest is what the potential adds to them.
  for (int i = 0; i < mesh_.nodes; ++i)
    for (int k = graph.row_start[i]; k < graph.row_start[i + 1]; ++k)
      if (fixed_[i] || fixed_[graph.column[k]])
        matrix.values[k] = graph.column[k] == i && i < mesh_.owned_nodes ? permittivity * mesh_.smallest_edge : 0;
  const MatHandle assembled = matrix.create_petsc();
  matrix.fill_petsc(assembled);
  KspHandle solver;
  VecHandle b, x;
  SILT_PETSC(MatCreateVecs(assembled, x.out(), b.out()));
  SILT_PETSC(VecPlaceArray(b, right.data()));
  SILT_PETSC(KSPCreate(PETSC_COMM_WORLD, solver.out()));
  SILT_PETSC(KSPSetOptionsPrefix(solver, "electric_"));
  SILT_PETSC(KSPSetOperators(solver, assembled, assembled));
  SILT_PETSC(KSPSetType(solver, KSPCG));
  PC preconditioner;
  SILT_PETSC(KSPGetPC(solver, &preconditioner));
  SILT_PETSC(PCSetType(preconditioner, PCGAMG));
  SILT_PETSC(KSPSetTolerances(solver, 1e-10, 0, PETSC_DEFAULT, 1000));
  SILT_PETSC(KSPSetFromOptions(solver));
  SILT_PETSC(KSPSolve(solver, b, x));
  KSPConvergedReason reason;
  SILT_PETSC(KSPGetConvergedReason(solver, &reason));
  SILT_PETSC(VecResetArray(b));
  if (reason < 0)
    throw RunError(fmt::format("the electric potential was not found (PETSc's reason {})", static_cast<int>(reason)));
  std::vector<double> change(mesh_.nodes, 0.0);
  const double* found = nullptr;
  SILT_PETSC(VecGetArrayRead(x, &found));
  std::copy_n(found, mesh_.owned_nodes, change.begin());
  SILT_PETSC(VecRestoreArrayRead(x, &found));
  mesh_.copy_from_owner(change.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i) potential_[i] += change[i];
}

double ElectricPotential::strongest() const {
  double largest = 0;
  for (std::size_t i = 0; i < field_.size(); i += 3) largest = std::max(largest, vec3(&field_[i]).norm());
  return mpi_max(largest);
}

void ElectricPotential::at(const double* x, int hint, Vec3& field, Mat3& gradient) const {
  const Place place = locator_.find(x, hint);
  double xi[3] = {place.xi[0], place.xi[1], place.xi[2]};
  const int cell = place.inside() ? place.cell : hint;
  if (!place.inside()) locator_.reference(cell, x, xi);  // just outside this rank's cells until the next rebuild
  double N[8], dN[8][3];
  shape(mesh_.cell, xi, N, dN);
  field.setZero();
  gradient.setZero();
  for (int a = 0; a < mesh_.nodes_per_cell; ++a) {
    const auto i =
        static_cast<std::size_t>(mesh_.cell_nodes[static_cast<std::size_t>(cell) * mesh_.nodes_per_cell + a]);
    field += N[a] * vec3(&field_[3 * i]);
    for (int k = 0; k < 3; ++k)
      for (int d = 0; d < 3; ++d) gradient(k, d) += N[a] * slope_[9 * i + 3 * k + d];
  }
}

}  // namespace silt
