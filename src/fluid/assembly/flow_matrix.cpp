// The Jacobian of FlowSystem: storage and insertion.
#include <algorithm>

#include "fluid/assembly/flow_system.hpp"

namespace silt {

MatHandle FlowSystem::create_matrix() const {
  MatHandle matrix;
  Handle<ISLocalToGlobalMapping, ISLocalToGlobalMappingDestroy> mapping;
  const int points = layout_.size / block_;
  std::vector<PetscInt> blocks(points);
  for (int i = 0; i < points; ++i) blocks[i] = global_[static_cast<size_t>(i) * block_] / block_;
  SILT_PETSC(
      ISLocalToGlobalMappingCreate(PETSC_COMM_WORLD, block_, points, blocks.data(), PETSC_COPY_VALUES, mapping.out()));
  const auto shape_as = [&](Mat m, MatType type) {
    SILT_PETSC(MatSetSizes(m, owned_rows_, owned_rows_, PETSC_DETERMINE, PETSC_DETERMINE));
    SILT_PETSC(MatSetBlockSize(m, block_));
    SILT_PETSC(MatSetType(m, type));
    SILT_PETSC(MatSetLocalToGlobalMapping(m, mapping, mapping));
  };
  MatHandle pattern;
  SILT_PETSC(MatCreate(PETSC_COMM_WORLD, pattern.out()));
  shape_as(pattern, MATPREALLOCATOR);
  SILT_PETSC(MatSetUp(pattern));
  const std::vector<double> zero(static_cast<size_t>(kernel_.rows) * kernel_.rows, 0.0);
  for (int c = 0; c < mesh_.cells; ++c) SILT_PETSC(insert_cell(pattern, c, zero.data()));
  for (int i = 0; i < layout_.size; ++i)
    if (owned_[i]) SILT_PETSC(MatSetValue(pattern, global_[i], global_[i], 0.0, ADD_VALUES));
  SILT_PETSC(MatAssemblyBegin(pattern, MAT_FINAL_ASSEMBLY));
  SILT_PETSC(MatAssemblyEnd(pattern, MAT_FINAL_ASSEMBLY));

  SILT_PETSC(MatCreate(PETSC_COMM_WORLD, matrix.out()));
  shape_as(matrix, equal_order() ? MATBAIJ : MATAIJ);
  SILT_PETSC(MatPreallocatorPreallocate(pattern, PETSC_TRUE, matrix));
  SILT_PETSC(MatSetOption(matrix, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_TRUE));
  if (!entries_) entries_ = std::make_unique<CellEntries>(matrix, cell_points());

  if (boundary_.closed()) {
    VecHandle constant = create_vector();
    SILT_PETSC(VecSet(constant, 0));
    for (int i = 0; i < mesh_.owned_nodes; ++i)
      SILT_PETSC(VecSetValue(constant, global_[pressure_place(i)], 1.0, INSERT_VALUES));
    SILT_PETSC(VecAssemblyBegin(constant));
    SILT_PETSC(VecAssemblyEnd(constant));
    SILT_PETSC(VecNormalize(constant, nullptr));
    Handle<MatNullSpace, MatNullSpaceDestroy> space;
    Vec vector = constant;
    SILT_PETSC(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, 1, &vector, space.out()));
    SILT_PETSC(MatSetNullSpace(matrix, space));
    SILT_PETSC(MatSetTransposeNullSpace(matrix, space));
  }
  return matrix;
}

CellEntries::Points FlowSystem::cell_points() const {
  const int nv = space_.nodes_per_cell, np = mesh_.nodes_per_cell;
  CellEntries::Points points;
  points.cells = mesh_.cells;
  points.width.assign(nv, equal_order() ? block_ : dimension_);
  if (!equal_order()) points.width.resize(nv + np, 1);
  points.points = static_cast<int>(points.width.size());
  points.row.reserve(static_cast<size_t>(points.points) * mesh_.cells);
  for (int c = 0; c < mesh_.cells; ++c) {
    const int* v = &space_.cell_nodes[static_cast<size_t>(c) * nv];
    for (int a = 0; a < nv; ++a) points.row.push_back(global_[velocity_place(v[a], 0)]);
    if (equal_order()) continue;
    const int* n = &mesh_.cell_nodes[static_cast<size_t>(c) * np];
    for (int a = 0; a < np; ++a) points.row.push_back(global_[pressure_place(n[a])]);
  }
  return points;
}

PetscErrorCode FlowSystem::insert_cell(Mat matrix, int cell, const double* values) const {
  PetscFunctionBeginUser;
  PetscInt places[27 * 3 + 8];
  if (equal_order()) {
    const int n = mesh_.nodes_per_cell;
    for (int a = 0; a < n; ++a) places[a] = mesh_.cell_nodes[static_cast<size_t>(cell) * n + a];
    PetscCall(MatSetValuesBlockedLocal(matrix, n, places, n, places, values, ADD_VALUES));
  } else {
    cell_places(cell, places);
    PetscCall(MatSetValuesLocal(matrix, kernel_.rows, places, kernel_.rows, places, values, ADD_VALUES));
  }
  PetscFunctionReturn(0);
}

void FlowSystem::constrain(int cell, double* matrix) const {
  const int rows = kernel_.rows, n = space_.nodes_per_cell, d = dimension_;
  const int* v = &space_.cell_nodes[static_cast<size_t>(cell) * n];
  for (int a = 0; a < n; ++a) {
    const int index = constraints_.of_node()[v[a]];
    if (index < 0) continue;
    const auto& c = constraints_.constraints()[index];
    const int first = equal_order() ? a * (d + 1) : a * d;
    if (c.count < d) {
      for (int k = 0; k < rows; ++k) {
        Vec3 row = Vec3::Zero();
        for (int i = 0; i < d; ++i) row[i] = matrix[(first + i) * rows + k];
        for (int i = 0; i < d; ++i) matrix[(first + i) * rows + k] = c.frame[i].dot(row);
      }
      for (int k = 0; k < rows; ++k) {
        Vec3 column = Vec3::Zero();
        for (int i = 0; i < d; ++i) column[i] = matrix[k * rows + first + i];
        for (int i = 0; i < d; ++i) matrix[k * rows + first + i] = c.frame[i].dot(column);
      }
    }
    for (int i = 0; i < c.count; ++i)
      for (int k = 0; k < rows; ++k) matrix[(first + i) * rows + k] = matrix[k * rows + first + i] = 0;
  }
}

PetscErrorCode FlowSystem::jacobian(const StepFields& fields, Vec x, Mat matrix) const {
  PetscFunctionBeginUser;
  std::vector<double> state;
  PetscCall(local_state(x, state));
  const FlowData d = data(fields, state.data());
  const size_t rows = kernel_.rows, size = rows * rows;
  std::vector<double> residual(kernel_.lanes * rows), values(kernel_.lanes * size);
  PetscCall(MatZeroEntries(matrix));
  std::vector<double> elsewhere;  // cells that also have rows of other ranks
  std::vector<int> elsewhere_cells;
  {
    CellEntries::Arrays arrays(matrix);
    const auto add = [&](int cell, double* cell_values) {
      constrain(cell, cell_values);
      if (entries_->add(arrays, cell, cell_values)) return;
      elsewhere_cells.push_back(cell);
      elsewhere.insert(elsewhere.end(), cell_values, cell_values + size);
    };
    for (int first = 0; first < mesh_.cells; first += kernel_.lanes) {
      const int count = std::min(kernel_.lanes, mesh_.cells - first);
      for (int l = 0; l < count; ++l) entries_->prefetch(arrays, first + l);
      kernel_.evaluate(d, first, count, residual.data(), values.data());
      for (int l = 0; l < count; ++l) add(first + l, &values[l * size]);
    }
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
      if (fixed_facet_[f]) continue;
      std::fill_n(values.begin(), size, 0.0);
      facets_.add(d, f, facet_term(fields, f), residual.data(), values.data());
      add(mesh_.facets[f].cell, values.data());
    }
  }
  for (size_t k = 0; k < elsewhere_cells.size(); ++k)
    PetscCall(insert_cell(matrix, elsewhere_cells[k], &elsewhere[k * size]));
  for (int place = 0; place < layout_.size; ++place)
    if (owned_[place] && fixed_[place]) PetscCall(MatSetValue(matrix, global_[place], global_[place], 1.0, ADD_VALUES));
  if (equal_order())
    for (int i = 0; i < mesh_.owned_nodes; ++i) {
      // The response is a multiple of the unit matrix, so it is the same in every frame.
      if (fields.nodal_response[i] == 0) continue;
      for (int c = 0; c < dimension_; ++c) {
        const int place = velocity_place(i, c);
        if (!fixed_[place])
          PetscCall(MatSetValue(matrix, global_[place], global_[place], fields.nodal_response[i], ADD_VALUES));
      }
    }
  PetscCall(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(0);
}

}  // namespace silt
