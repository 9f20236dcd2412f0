#include "fluid/compressible/gas_system.hpp"

#include <algorithm>
#include <cmath>

#include "fluid/assembly/flow_table.hpp"

namespace silt {

GasSystem::GasSystem(const Mesh& mesh, const BoundaryConditions& boundary, const TemperatureBoundaries& thermal)
    : mesh_(mesh),
      boundary_(boundary),
      space_(mesh, 1),
      constraints_(space_, boundary),
      fixed_temperature_(thermal.fixed()),
      temperature_boundary_(thermal.fixed_boundary()),
      dimension_(mesh.dimension),
      loop_(gas_loop(mesh.cell)) {
  for (const FacetRule& facet : boundary.facets())
    if (thermal[facet.boundary].kind == TemperatureBoundaries::Condition::flux ||
        thermal[facet.boundary].kind == TemperatureBoundaries::Condition::heat_transfer)
      for (int a = 0; a < facet.nodes; ++a)
        if (int& b = temperature_boundary_[facet.node[a]]; b < 0) b = facet.boundary;
  set_axisymmetric(false);
  const int m = size();
  global_.resize(mesh.nodes);
  std::vector<PetscInt> rows(static_cast<size_t>(mesh.nodes) * m);
  for (int i = 0; i < mesh.nodes; ++i) {
    global_[i] = static_cast<PetscInt>(mesh.node_global[i]);
    for (int k = 0; k < m; ++k) rows[static_cast<size_t>(i) * m + k] = global_[i] * m + k;
  }
  SILT_PETSC(VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(rows.size()), local_.out()));
  IsHandle from;
  SILT_PETSC(
      ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(rows.size()), rows.data(), PETSC_COPY_VALUES, from.out()));
  const VecHandle global = create_vector();
  SILT_PETSC(VecScatterCreate(global, from, local_, nullptr, scatter_.out()));
}

/// Volume that belongs to each node, the radius included.
void GasSystem::set_axisymmetric(bool axisymmetric) {
  axisymmetric_ = axisymmetric;
  weights_.assign(mesh_.nodes, 0.0);
  const FlowTable& table = flow_table(mesh_.cell, 1);
  const int n = mesh_.nodes_per_cell;
  for (int c = 0; c < mesh_.cells; ++c) {
    const double* x = &mesh_.cell_coordinates[3 * static_cast<size_t>(c) * n];
    for (int q = 0; q < table.points; ++q) {
      Mat3 J = Mat3::Zero();
      double y = 0;
      for (int a = 0; a < n; ++a) {
        J += vec3(x + 3 * a) * vec3(table.dM[q][a]).transpose();
        y += table.M[q][a] * x[3 * a + 1];
      }
      if (mesh_.dimension == 2) J(2, 2) = 1;
      const double w = table.weight[q] * J.determinant() * radius(y);
      for (int a = 0; a < n; ++a) weights_[mesh_.cell_nodes[static_cast<size_t>(c) * n + a]] += w * table.M[q][a];
    }
  }
  mesh_.sum_shared(weights_.data(), 1);
}

void GasSystem::impose(const GasStep& step, std::vector<double>& state) const {
  for (const auto& c : constraints_.constraints()) {
    const auto given = vec3(&step.prescribed_velocity[3 * static_cast<size_t>(c.node)]);
    double* u = &state[static_cast<size_t>(c.node) * size() + 1];
    Vec3 now = Vec3::Zero();
    for (int i = 0; i < dimension_; ++i) now[i] = u[i];
    const Vec3 missing = given - now;
    for (int k = 0; k < c.count; ++k) now += c.frame[k] * c.frame[k].dot(missing);
    for (int i = 0; i < dimension_; ++i) u[i] = now[i];
  }
  for (int i = 0; i < mesh_.nodes; ++i)
    if (fixed_temperature_[i]) state[static_cast<size_t>(i) * size() + dimension_ + 1] = step.prescribed_temperature[i];
}

VecHandle GasSystem::create_vector() const {
  VecHandle x;
  SILT_PETSC(VecCreate(PETSC_COMM_WORLD, x.out()));
  SILT_PETSC(VecSetSizes(x, static_cast<PetscInt>(mesh_.owned_nodes) * size(), PETSC_DETERMINE));
  SILT_PETSC(VecSetBlockSize(x, size()));
  SILT_PETSC(VecSetType(x, VECSTANDARD));
  return x;
}

MatHandle GasSystem::create_matrix() const {
  MatHandle pattern, matrix;
  const PetscInt rows = static_cast<PetscInt>(mesh_.owned_nodes) * size();
  Handle<ISLocalToGlobalMapping, ISLocalToGlobalMappingDestroy> mapping;
  SILT_PETSC(ISLocalToGlobalMappingCreate(PETSC_COMM_WORLD, size(), mesh_.nodes, global_.data(), PETSC_COPY_VALUES,
                                          mapping.out()));
  const auto shape_as = [&](Mat m, MatType type) {
    SILT_PETSC(MatSetSizes(m, rows, rows, PETSC_DETERMINE, PETSC_DETERMINE));
    SILT_PETSC(MatSetBlockSize(m, size()));
    SILT_PETSC(MatSetType(m, type));
    SILT_PETSC(MatSetLocalToGlobalMapping(m, mapping, mapping));
  };
  SILT_PETSC(MatCreate(PETSC_COMM_WORLD, pattern.out()));
  shape_as(pattern, MATPREALLOCATOR);
  SILT_PETSC(MatSetUp(pattern));
  const int n = mesh_.nodes_per_cell;
  const std::vector<double> zero(static_cast<size_t>(n * size()) * n * size(), 0.0);
  for (int c = 0; c < mesh_.cells; ++c) {
    const int* node = &mesh_.cell_nodes[static_cast<size_t>(c) * n];
    SILT_PETSC(MatSetValuesBlockedLocal(pattern, n, node, n, node, zero.data(), ADD_VALUES));
  }
  SILT_PETSC(MatAssemblyBegin(pattern, MAT_FINAL_ASSEMBLY));
  SILT_PETSC(MatAssemblyEnd(pattern, MAT_FINAL_ASSEMBLY));
  SILT_PETSC(MatCreate(PETSC_COMM_WORLD, matrix.out()));
  shape_as(matrix, MATBAIJ);
  SILT_PETSC(MatPreallocatorPreallocate(pattern, PETSC_TRUE, matrix));
  SILT_PETSC(MatSetOption(matrix, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_TRUE));
  return matrix;
}

void GasSystem::to_frames(double* values) const {
  silt::to_frames(
      constraints_, dimension_, [this](int node) { return velocity_place(node); }, values);
}

void GasSystem::to_vector(const std::vector<double>& state, Vec x) const {
  std::vector<double> values = state;
  to_frames(values.data());
  SILT_PETSC(to_global(values, local_, scatter_, x, INSERT_VALUES));
}

PetscErrorCode GasSystem::from_vector(Vec x, std::vector<double>& state) const {
  PetscFunctionBeginUser;
  PetscCall(from_global(x, scatter_, local_, state));
  from_frames(
      constraints_, dimension_, [this](int node) { return velocity_place(node); }, state.data());
  PetscFunctionReturn(0);
}

/// Energy rows of moving walls: the wall does the work of the viscous traction that its momentum rows find.
void GasSystem::add_wall_work(const GasStep& step, double* residual) const {
  for (const auto& c : constraints_.constraints()) {
    if (boundary_.type(boundary_.velocity_boundary()[c.node]) != BoundaryType::no_slip) continue;
    double* r = residual + static_cast<size_t>(c.node) * size();
    for (int i = 0; i < dimension_; ++i)
      r[dimension_ + 1] -= step.prescribed_velocity[3 * static_cast<size_t>(c.node) + i] * r[1 + i];
  }
}

PetscErrorCode GasSystem::residual(const GasStep& step, Vec x, Vec r) const {
  PetscFunctionBeginUser;
  std::vector<double> state, values(static_cast<size_t>(mesh_.nodes) * size(), 0.0);
  PetscCall(from_vector(x, state));
  PetscCall(assemble(step, state, values.data(), nullptr));
  add_wall_work(step, values.data());
  to_frames(values.data());
  PetscCall(to_global(values, local_, scatter_, r, ADD_VALUES));
  PetscInt first;
  PetscCall(VecGetOwnershipRange(r, &first, nullptr));
  const double* unknown;
  PetscCall(VecGetArrayRead(x, &unknown));
  double* array;
  PetscCall(VecGetArray(r, &array));
  for (const auto& c : constraints_.constraints()) {
    if (c.node >= mesh_.owned_nodes) continue;
    const PetscInt row = global_[c.node] * size() + 1 - first;
    for (int k = 0; k < c.count; ++k)
      array[row + k] =
          unknown[row + k] - c.frame[k].dot(vec3(&step.prescribed_velocity[3 * static_cast<size_t>(c.node)]));
  }
  for (int i = 0; i < mesh_.owned_nodes; ++i)
    if (fixed_temperature_[i]) {
      const PetscInt row = global_[i] * size() + dimension_ + 1 - first;
      array[row] = unknown[row] - step.prescribed_temperature[i];
    }
  PetscCall(VecRestoreArrayRead(x, &unknown));
  PetscCall(VecRestoreArray(r, &array));
  PetscFunctionReturn(0);
}

void GasSystem::constrain(const GasStep& step, int count, const int* node, double* matrix) const {
  const int m = size(), rows = count * m, d = dimension_;
  for (int a = 0; a < count; ++a) {
    const int index = constraints_.of_node()[node[a]], first = a * m + 1;
    if (index >= 0) {
      const auto& c = constraints_.constraints()[index];
      if (boundary_.type(boundary_.velocity_boundary()[c.node]) == BoundaryType::no_slip)
        for (int i = 0; i < d; ++i) {
          const double u = step.prescribed_velocity[3 * static_cast<size_t>(c.node) + i];
          for (int k = 0; u != 0 && k < rows; ++k)
            matrix[(a * m + d + 1) * rows + k] -= u * matrix[(first + i) * rows + k];
        }
      if (c.count < d)
        for (int k = 0; k < rows; ++k) {
          Vec3 row = Vec3::Zero();
          for (int i = 0; i < d; ++i) row[i] = matrix[(first + i) * rows + k];
          for (int i = 0; i < d; ++i) matrix[(first + i) * rows + k] = c.frame[i].dot(row);
        }
      if (c.count < d)
        for (int k = 0; k < rows; ++k) {
          Vec3 column = Vec3::Zero();
          for (int i = 0; i < d; ++i) column[i] = matrix[k * rows + first + i];
          for (int i = 0; i < d; ++i) matrix[k * rows + first + i] = c.frame[i].dot(column);
        }
      for (int i = 0; i < c.count; ++i)
        for (int k = 0; k < rows; ++k) matrix[(first + i) * rows + k] = matrix[k * rows + first + i] = 0;
    }
    if (fixed_temperature_[node[a]])
      for (int k = 0; k < rows; ++k) matrix[(a * m + d + 1) * rows + k] = matrix[k * rows + a * m + d + 1] = 0;
  }
}

PetscErrorCode GasSystem::jacobian(const GasStep& step, Vec x, Mat matrix) const {
  PetscFunctionBeginUser;
  std::vector<double> state, values(static_cast<size_t>(mesh_.nodes) * size(), 0.0);
  PetscCall(from_vector(x, state));
  PetscCall(MatZeroEntries(matrix));
  PetscCall(assemble(step, state, values.data(), matrix));
  const int m = size();
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    // Particles and walls act at the node itself.
    std::vector<double> block(static_cast<size_t>(m) * m, 0.0);
    const double* s = &state[static_cast<size_t>(i) * m];
    for (int k = 0; k < dimension_; ++k) {
      block[(1 + k) * m + 1 + k] += step.response[i];
      block[(m - 1) * m + 1 + k] +=
          step.response[i] * (2 * s[1 + k] - step.old_velocity[3 * static_cast<size_t>(i) + k]);
    }
    block[m * m - 1] += step.heat_coefficient[i];
    constrain(step, 1, &i, block.data());
    const int index = constraints_.of_node()[i];
    for (int k = 0; index >= 0 && k < constraints_.constraints()[index].count; ++k) block[(1 + k) * (m + 1)] = 1;
    if (fixed_temperature_[i]) block[m * m - 1] = 1;
    PetscCall(MatSetValuesBlockedLocal(matrix, 1, &i, 1, &i, block.data(), ADD_VALUES));
  }
  PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

/// What acts at the nodes: particles (the energy of their load is in its last place; the response takes its work at the
/// new velocity) and the heat of walls. Owned nodes only.
void GasSystem::nodes(const GasStep& step, const std::vector<double>& state, double* residual) const {
  const int m = size();
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    const double* s = &state[static_cast<size_t>(i) * m];
    double* r = residual + static_cast<size_t>(i) * m;
    for (int k = 0; k < dimension_; ++k) {
      const double more = step.response[i] * (s[1 + k] - step.old_velocity[3 * static_cast<size_t>(i) + k]);
      r[1 + k] += more - step.force[static_cast<size_t>(i) * m + 1 + k];
      r[m - 1] += more * s[1 + k];
    }
    r[m - 1] -= step.force[static_cast<size_t>(i) * m + m - 1] + step.heat[i] - step.heat_coefficient[i] * s[m - 1];
  }
}

std::vector<double> GasSystem::totals(const std::vector<double>& conserved) const {
  const size_t m = size();
  std::vector<double> sum(m, 0.0);
  for (int i = 0; i < mesh_.owned_nodes; ++i)
    for (size_t k = 0; k < m; ++k) sum[k] += weights_[i] * conserved[i * m + k];
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(m), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return sum;
}

}  // namespace silt
