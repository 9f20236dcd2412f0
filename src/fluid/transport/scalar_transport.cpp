#include "fluid/transport/scalar_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "fluid/assembly/flow_table.hpp"

namespace silt {

ScalarTransport::ScalarTransport(const Mesh& mesh, const std::string& prefix, int table_order)
    : mesh_(mesh),
      prefix_(prefix),
      order_(table_order),
      graph_(mesh),
      matrix_(graph_),
      constrained_(graph_),
      kernel_(transport_kernel(mesh.cell)),
      cell_size_(shortest_edges(mesh)),
      right_(mesh.nodes, 0.0),
      petsc_(matrix_.create_petsc()) {
  SILT_PETSC(VecCreateMPI(PETSC_COMM_WORLD, mesh.owned_nodes, PETSC_DETERMINE, unknown_.out()));
  SILT_PETSC(VecDuplicate(unknown_, load_.out()));
  SILT_PETSC(KSPCreate(PETSC_COMM_WORLD, ksp_.out()));
  SILT_PETSC(KSPSetOptionsPrefix(ksp_, prefix.c_str()));
  SILT_PETSC(KSPSetType(ksp_, KSPBCGS));
  PC pc;
  SILT_PETSC(KSPGetPC(ksp_, &pc));
  SILT_PETSC(PCSetType(pc, PCBJACOBI));
  SILT_PETSC(KSPSetOperators(ksp_, petsc_, petsc_));
}

int ScalarTransport::points() const { return flow_table(mesh_.cell, order_).points; }

void ScalarTransport::assemble(TransportData data) {
  data.table = &flow_table(mesh_.cell, order_);
  data.nodes = mesh_.cell_nodes.data();
  data.coordinates = mesh_.cell_coordinates.data();
  data.cell_size = cell_size_.data();
  const size_t n = mesh_.nodes_per_cell;
  std::vector<double> K(kernel_.lanes * n * n), r(kernel_.lanes * n);
  matrix_.zero();
  std::fill(right_.begin(), right_.end(), 0.0);
  for (int first = 0; first < mesh_.cells; first += kernel_.lanes) {
    const int count = std::min(kernel_.lanes, mesh_.cells - first);
    kernel_.assemble(data, first, count, K.data(), r.data());
    const int* entry = &graph_.cell_entry[static_cast<size_t>(first) * n * n];
    for (size_t k = 0; k < count * n * n; ++k) matrix_.values[entry[k]] += K[k];
    const int* node = &mesh_.cell_nodes[static_cast<size_t>(first) * n];
    for (size_t k = 0; k < count * n; ++k) right_[node[k]] += r[k];
  }
  mesh_.sum_shared(right_.data(), 1);
}

void ScalarTransport::add_at_nodes(const std::vector<double>& coefficient, const std::vector<double>& right) {
  for (int i = 0; i < mesh_.owned_nodes; ++i) matrix_.values[graph_.diagonal[i]] += coefficient[i];
  for (int i = 0; i < mesh_.nodes; ++i) right_[i] += right[i];
}

int ScalarTransport::solve(const std::vector<char>& fixed, std::vector<double>& T) {
  // Solved for the change, so that a large mean value does not hide it from the tolerance.
  std::vector<double> rest = residual(T);
  constrained_.values = matrix_.values;
  for (int i = 0; i < mesh_.nodes; ++i) {
    if (!fixed[i]) continue;
    for (int k = graph_.row_start[i]; k < graph_.row_start[i + 1]; ++k) constrained_.values[k] = 0;
    constrained_.values[graph_.diagonal[i]] = i < mesh_.owned_nodes ? 1 : 0;
    rest[i] = 0;
  }
  constrained_.fill_petsc(petsc_);
  double* array;
  SILT_PETSC(VecGetArrayWrite(load_, &array));
  double scale = 0;
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    array[i] = -rest[i];
    if (!fixed[i]) scale += right_[i] * right_[i];
  }
  SILT_PETSC(VecRestoreArrayWrite(load_, &array));
  scale = std::sqrt(mpi_sum(scale));
  if (!std::isfinite(scale)) throw SolveFailure(prefix_ + " equation holds non-finite values");
  SILT_PETSC(KSPSetTolerances(ksp_, 1e-7, std::max(1e-13 * scale, 1e-290), PETSC_DEFAULT, 1000));
  SILT_PETSC(KSPSetFromOptions(ksp_));
  SILT_PETSC(VecSet(unknown_, 0));
  KSPConvergedReason reason = KSP_DIVERGED_BREAKDOWN;
  PetscInt iterations = 0;
  const PetscErrorCode code = KSPSolve(ksp_, load_, unknown_);
  if (!code) {
    SILT_PETSC(KSPGetConvergedReason(ksp_, &reason));
    SILT_PETSC(KSPGetIterationNumber(ksp_, &iterations));
  }
  if (mpi_any(code || reason < 0))
    throw SolveFailure(fmt::format("the equation {} did not converge ({}) in {} iterations", prefix_,
                                   KSPConvergedReasons[reason], iterations));
  const double* change;
  std::vector<double> delta(mesh_.nodes, 0.0);
  SILT_PETSC(VecGetArrayRead(unknown_, &change));
  std::copy(change, change + mesh_.owned_nodes, delta.begin());
  SILT_PETSC(VecRestoreArrayRead(unknown_, &change));
  mesh_.copy_from_owner(delta.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i) T[i] += delta[i];
  return static_cast<int>(iterations);
}

std::vector<double> ScalarTransport::residual(const std::vector<double>& T) const {
  std::vector<double> r(mesh_.nodes);
  matrix_.apply(T.data(), r.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i) r[i] -= right_[i];
  return r;
}

}  // namespace silt
