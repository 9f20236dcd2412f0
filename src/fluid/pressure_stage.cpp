#include "fluid/pressure_stage.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>

#include "base/solver_defaults.hpp"

namespace silt {
namespace {

/// The pressure operator and the factors are made anew when the rate of the step has changed by this factor, the
/// factors also when the scale of the continuity rows has.
constexpr double changed = 1.2;
/// Largest Courant number for which the lumped inertia stands for the momentum rows.
constexpr double largest_courant = 20;

/// Whether the user gave an option that begins with `start`.
bool any_option_given(const std::string& start) {
  char* all;
  SILT_PETSC(PetscOptionsGetAll(nullptr, &all));
  std::istringstream words(all);
  SILT_PETSC(PetscFree(all));
  for (std::string word; words >> word;)
    if (word.starts_with(start) && solver_option_given(word)) return true;
  return false;
}

/// [rows] r - A x of the last component of the blocks of a node, [blocks][block] their last rows.
template <int block>
void rest_of_last(const std::vector<int>& row_start, const int* column, const float* last_rows, const double* r,
                  const double* x, double* rest) {
  for (std::size_t i = 0; i + 1 < row_start.size(); ++i) {
    double sum[block] = {}, total = 0;
    for (int k = row_start[i]; k < row_start[i + 1]; ++k) {
      const float* row = last_rows + static_cast<std::size_t>(k) * block;
      const double* at = x + static_cast<std::size_t>(column[k]) * block;
      for (int c = 0; c < block; ++c) sum[c] += static_cast<double>(row[c]) * at[c];
    }
    for (int c = 0; c < block; ++c) total += sum[c];
    rest[i] = r[i * block + block - 1] - total;
  }
}

/// [rows][block] -b_i A q in all but the last component, [blocks][block - 1] the last columns of A's blocks.
template <int block>
void answer_of_last(const std::vector<int>& row_start, const int* column, const float* last_columns, const double* b,
                    const double* q, double* answer) {
  for (std::size_t i = 0; i + 1 < row_start.size(); ++i) {
    double sum[block - 1] = {};
    for (int k = row_start[i]; k < row_start[i + 1]; ++k) {
      const float* entry = last_columns + static_cast<std::size_t>(k) * (block - 1);
      const double at = q[column[k]];
      for (int c = 0; c + 1 < block; ++c) sum[c] += static_cast<double>(entry[c]) * at;
    }
    for (int c = 0; c + 1 < block; ++c) answer[i * block + c] = -b[i] * sum[c];
  }
}

}  // namespace

int fill_levels(Cell cell) { return cell == Cell::hexahedron ? 0 : 1; }

PressureStage::PressureStage(const FlowSystem& system)
    : system_(system),
      mesh_(system.space().mesh),
      block_(mesh_.dimension + 1),
      graph_(mesh_),
      loops_(graph_),
      matrix_(graph_),
      fixed_(mesh_.nodes, 0),
      inverse_inertia_(mesh_.owned_nodes, 0.0),
      petsc_(matrix_.create_petsc()),
      ilu_(fill_levels(mesh_.cell)) {
  const auto& outlet = system.boundary().pressure_boundary();
  for (int i = 0; i < mesh_.nodes; ++i) fixed_[i] = outlet[i] >= 0;
  rest_ = system.create_vector();
  correction_ = system.create_vector();
  image_ = system.create_vector();
  SILT_PETSC(MatCreateVecs(petsc_, answer_.out(), right_.out()));
}

PressureStage::~PressureStage() = default;

void PressureStage::attach(PC pc, const char* prefix) {
  SILT_PETSC(PCShellSetContext(pc, this));
  SILT_PETSC(PCShellSetSetUp(pc, set_up));
  SILT_PETSC(PCShellSetApply(pc, apply));
  SILT_PETSC(PCShellSetName(pc, "local stage and pressure stage"));
  SILT_PETSC(PCCreate(PETSC_COMM_WORLD, local_.out()));
  SILT_PETSC(PCSetOptionsPrefix(local_, prefix));
  SILT_PETSC(PCSetType(local_, mpi_size() > 1 ? PCASM : PCBJACOBI));  // the same on one rank, without a copy
  SILT_PETSC(PCSetFromOptions(local_));
  const std::string options = std::string("-") + prefix;
  single_ = mpi_size() == 1 && mesh_.dimension == 3 && !any_option_given(options + "sub_") &&
            !any_option_given(options + "pc_");
}

void PressureStage::prepare(const StepFields& fields) {
  double speed = 0, size = infinity;
  for (double u : fields.velocity_old) speed = std::max(speed, std::abs(u));
  for (double u : fields.prescribed_velocity) speed = std::max(speed, std::abs(u));
  for (double h : system_.cell_size()) size = std::min(size, h);
  speed = mpi_max(speed), size = mpi_min(size);
  const FlowParameters& k = fields.parameters;
  const double rate = k.time_coefficient;
  const double spread = k.viscosity / std::max(k.density, 1e-300) / (size * size);
  const bool before = active_;
  active_ = rate * largest_courant > speed / size + spread;
  const bool rescaled = std::max(scale_, k.continuity_scale) > changed * std::min(scale_, k.continuity_scale);
  if (rescaled || active_ != before) factored_ = false;
  scale_ = k.continuity_scale;
  if (!active_) return;
  if (rate_ == 0 || rate > changed * rate_ || rate_ > changed * rate) assemble(fields, rate);
}

void PressureStage::assemble(const StepFields& fields, double rate) {
  const FlowParameters& k = fields.parameters;
  const std::size_t padded = loops_.padded_cells();
  std::vector<double> values(6 * padded), coefficient(padded);
  const CellCoefficients cell{values.data(),
                              values.data() + padded,
                              values.data() + 2 * padded,
                              values.data() + 3 * padded,
                              values.data() + 4 * padded,
                              {},
                              {},
                              values.data() + 5 * padded};
  std::vector<double> eddy;
  if (!fields.eddy_viscosity.empty()) {
    eddy = fields.eddy_viscosity;
    eddy.resize(padded, eddy.empty() ? 0.0 : eddy.back());
  }
  loops_.coefficients(
      {k.density, k.viscosity, rate, k.model_a, fields.velocity_old.data(), fields.alpha.data(), fields.response.data(),
       eddy.empty() ? nullptr : eddy.data(), fields.following.empty() ? nullptr : fields.following.data()},
      cell);
  for (std::size_t c = 0; c < padded; ++c)
    coefficient[c] = (cell.void_fraction[c] + cell.following[c]) * cell.mobility[c] + k.pspg * cell.stabilisation[c];
  matrix_.zero();
  loops_.diffusion(coefficient.data(), matrix_.values.data());
  for (int i = 0; i < mesh_.nodes; ++i)
    for (int e = graph_.row_start[i]; e < graph_.row_start[i + 1]; ++e)
      if (e != graph_.diagonal[i] && (fixed_[i] || fixed_[graph_.column[e]])) matrix_.values[e] = 0;
  matrix_.fill_petsc(petsc_);
  SILT_PETSC(MatSetOption(petsc_, MAT_SYMMETRIC, PETSC_TRUE));
  if (system_.boundary().closed()) {
    Handle<MatNullSpace, MatNullSpaceDestroy> constants;
    SILT_PETSC(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_TRUE, 0, nullptr, constants.out()));
    SILT_PETSC(MatSetNullSpace(petsc_, constants));
  }
  for (int i = 0; i < mesh_.owned_nodes; ++i)
    inverse_inertia_[i] = 1 / (system_.lumped_mass()[i] * (fields.alpha[i] * k.density * rate + fields.response[i]));

  SILT_PETSC(KSPCreate(PETSC_COMM_WORLD, cycle_.out()));
  SILT_PETSC(KSPSetOptionsPrefix(cycle_, "fluid_stage_"));
  SILT_PETSC(KSPSetType(cycle_, KSPPREONLY));
  SILT_PETSC(KSPSetOperators(cycle_, petsc_, petsc_));
  PC pc;
  SILT_PETSC(KSPGetPC(cycle_, &pc));
  SILT_PETSC(PCSetType(pc, PCGAMG));
  SILT_PETSC(KSPSetFromOptions(cycle_));
  srand48(1);  // of the eigenvalue estimates: one set-up must not depend on those before
  SILT_PETSC(KSPSetUp(cycle_));
  rate_ = rate;
  factored_ = false;
}

void PressureStage::copy_parts(Mat matrix) {
  if (mpi_size() > 1) return;
  PetscInt rows;
  const PetscInt *start, *column;
  PetscBool done;
  SILT_PETSC(MatGetRowIJ(matrix, 0, PETSC_FALSE, PETSC_TRUE, &rows, &start, &column, &done));
  if (row_start_.empty()) {
    row_start_.assign(start, start + rows + 1);
    column_.assign(column, column + start[rows]);
    pressure_rows_.resize(column_.size() * block_);
    pressure_columns_.resize(column_.size() * (block_ - 1));
  }
  SILT_PETSC(MatRestoreRowIJ(matrix, 0, PETSC_FALSE, PETSC_TRUE, &rows, &start, &column, &done));
  double* values;
  SILT_PETSC(MatSeqBAIJGetArray(matrix, &values));
  const int last = block_ - 1;
  const double* block = values;  // stored by columns
  for (std::size_t k = 0; k < column_.size(); ++k, block += static_cast<std::ptrdiff_t>(block_) * block_) {
    for (int c = 0; c < block_; ++c) pressure_rows_[k * block_ + c] = static_cast<float>(block[c * block_ + last]);
    for (int c = 0; c < last; ++c) pressure_columns_[k * last + c] = static_cast<float>(block[last * block_ + c]);
  }
  SILT_PETSC(MatSeqBAIJRestoreArray(matrix, &values));
}

PetscErrorCode PressureStage::set_up(PC pc) {
  PetscFunctionBeginUser;
  void* context;
  PetscCall(PCShellGetContext(pc, &context));
  auto& self = *static_cast<PressureStage*>(context);
  const bool keep = self.keep_ && self.factored_;
  PetscCall(PCSetReusePreconditioner(self.local_, keep ? PETSC_TRUE : PETSC_FALSE));
  if (keep) PetscFunctionReturn(0);
  PetscCall(self.factor(pc));
  self.factored_ = true;
  PetscFunctionReturn(0);
}

PetscErrorCode PressureStage::factor(PC pc) {
  PetscFunctionBeginUser;
  Mat matrix;
  PetscCall(PCGetOperators(pc, nullptr, &matrix));
  regular_ = single_ && ilu_.factor(matrix);
  if (!regular_) {
    PetscCall(PCSetOperators(local_, matrix, matrix));
    PetscCall(PCSetUp(local_));
    PetscCall(PCSetUpOnBlocks(local_));
  }
  if (active_) copy_parts(matrix);
  PetscFunctionReturn(0);
}

PetscErrorCode PressureStage::apply_local(Vec r, Vec x) {
  PetscFunctionBeginUser;
  if (!regular_) {
    PetscCall(PCApply(local_, r, x));
    PetscFunctionReturn(0);
  }
  const double* from;
  double* to;
  PetscCall(VecGetArrayRead(r, &from));
  PetscCall(VecGetArrayWrite(x, &to));
  ilu_.solve(from, to);
  PetscCall(VecRestoreArrayWrite(x, &to));
  PetscCall(VecRestoreArrayRead(r, &from));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureStage::pressure_rest(Mat matrix, Vec r, Vec x) {
  PetscFunctionBeginUser;
  const int block = block_, last = block - 1, owned = mesh_.owned_nodes;
  const double *from, *state;
  double* to;
  if (row_start_.empty()) {
    PetscCall(MatMult(matrix, x, rest_));
    PetscCall(VecAYPX(rest_, -1, r));
    PetscCall(VecGetArrayRead(rest_, &from));
    PetscCall(VecGetArrayWrite(right_, &to));
    for (int i = 0; i < owned; ++i) to[i] = fixed_[i] ? 0 : from[i * block + last] / scale_;
    PetscCall(VecRestoreArrayWrite(right_, &to));
    PetscCall(VecRestoreArrayRead(rest_, &from));
    PetscFunctionReturn(0);
  }
  PetscCall(VecGetArrayRead(r, &from));
  PetscCall(VecGetArrayRead(x, &state));
  PetscCall(VecGetArrayWrite(right_, &to));
  (block == 4 ? rest_of_last<4> : rest_of_last<3>)(row_start_, column_.data(), pressure_rows_.data(), from, state, to);
  for (int i = 0; i < owned; ++i) to[i] = fixed_[i] ? 0 : to[i] / scale_;
  PetscCall(VecRestoreArrayWrite(right_, &to));
  PetscCall(VecRestoreArrayRead(x, &state));
  PetscCall(VecRestoreArrayRead(r, &from));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureStage::velocity_answer(Mat matrix) {
  PetscFunctionBeginUser;
  const int block = block_, last = block - 1, owned = mesh_.owned_nodes;
  const double* from;
  double* to;
  PetscCall(VecSet(correction_, 0));
  PetscCall(VecGetArrayRead(answer_, &from));
  PetscCall(VecGetArray(correction_, &to));
  for (int i = 0; i < owned; ++i) to[i * block + last] = from[i];
  if (!row_start_.empty())
    (block == 4 ? answer_of_last<4> : answer_of_last<3>)(row_start_, column_.data(), pressure_columns_.data(),
                                                         inverse_inertia_.data(), from, to);
  PetscCall(VecRestoreArray(correction_, &to));
  PetscCall(VecRestoreArrayRead(answer_, &from));
  if (!row_start_.empty()) PetscFunctionReturn(0);
  PetscCall(MatMult(matrix, correction_, image_));
  PetscCall(VecGetArrayRead(image_, &from));
  PetscCall(VecGetArray(correction_, &to));
  for (int i = 0; i < owned; ++i)
    for (int c = 0; c < last; ++c) to[i * block + c] = -inverse_inertia_[i] * from[i * block + c];
  PetscCall(VecRestoreArray(correction_, &to));
  PetscCall(VecRestoreArrayRead(image_, &from));
  PetscFunctionReturn(0);
}

PetscErrorCode PressureStage::apply(PC pc, Vec r, Vec x) {
  PetscFunctionBeginUser;
  void* context;
  PetscCall(PCShellGetContext(pc, &context));
  auto& self = *static_cast<PressureStage*>(context);
  PetscCall(self.apply_local(r, x));
  if (!self.active_) PetscFunctionReturn(0);
  Mat matrix;
  PetscCall(PCGetOperators(pc, nullptr, &matrix));
  PetscCall(self.pressure_rest(matrix, r, x));
  PetscCall(KSPSolve(self.cycle_, self.right_, self.answer_));
  PetscCall(self.velocity_answer(matrix));
  PetscCall(VecAXPY(x, 1, self.correction_));
  PetscFunctionReturn(0);
}

}  // namespace silt
