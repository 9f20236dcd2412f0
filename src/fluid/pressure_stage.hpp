#pragma once
#include <memory>
#include <vector>

#include "base/nodal_matrix.hpp"
#include "fluid/assembly/flow_system.hpp"
#include "fluid/pressure_correction/cell_loops.hpp"
#include "fluid/single_precision_blocks.hpp"

namespace silt {

/// Levels of fill of the incomplete factors: the long rows of hexahedra need none.
int fill_levels(Cell cell);

/// Preconditioner of the equal-order monolithic flow in two stages, for steps of a moderate Courant number: a local one
/// (additive Schwarz with ILU) that smooths, then a correction of the pressure as the pressure correction makes it,
///   S q = r_p / scale,  u = -B J_up q,  S = int (alpha k + tau_p) grad.grad of (F6), B the inverse of the lumped
///   inertia,
/// by one cycle of GAMG (prefix `fluid_stage_`). What the local stage leaves is the global part of the pressure, so the
/// iterations do not grow with the mesh. A PETSc shell preconditioner.
class PressureStage {
 public:
  explicit PressureStage(const FlowSystem& system);
  ~PressureStage();
  PressureStage(const PressureStage&) = delete;
  PressureStage& operator=(const PressureStage&) = delete;

  /// Makes `pc` (PCSHELL) call this object; `local` is the first stage, owned here. The options of the local stage
  /// have `prefix`.
  void attach(PC pc, const char* prefix);
  /// The step whose Jacobian is preconditioned; decides whether the second stage is of use, and renews it when the
  /// step has changed. Collective.
  void prepare(const StepFields& fields);
  /// The next prepare() makes the pressure operator anew, whatever it was made from, and the next Jacobian is factored.
  void renew() {
    rate_ = 0;
    factored_ = false;
  }
  /// Whether the factors of an earlier Jacobian, if there are any, serve for the next one too.
  void keep_factors(bool keep) { keep_ = keep; }
  bool factored() const { return factored_; }
  /// Whether the local stage is an ILU in single precision: on one rank, in space, with no option of PETSc for it.
  bool single_precision() const { return single_; }

 private:
  static PetscErrorCode set_up(PC pc);
  static PetscErrorCode apply(PC pc, Vec r, Vec x);
  void assemble(const StepFields& fields, double rate);
  /// Copies what the second stage needs of the Jacobian, on one rank: its pressure rows and its pressure columns, a
  /// seventh of the numbers in half the bytes (a preconditioner needs no more digits).
  void copy_parts(Mat matrix);
  /// Factors the Jacobian for the local stage; in double precision where single does not do.
  PetscErrorCode factor(PC pc);
  PetscErrorCode apply_local(Vec r, Vec x);
  /// right_ = (r - J x) of the pressure rows over the scale; -B J_up q into the velocities of correction_ with q in its
  /// pressures.
  PetscErrorCode pressure_rest(Mat matrix, Vec r, Vec x);
  PetscErrorCode velocity_answer(Mat matrix);

  const FlowSystem& system_;
  const Mesh& mesh_;
  int block_;
  NodalGraph graph_;
  CellLoops loops_;
  NodalMatrix matrix_;
  std::vector<char> fixed_;              ///< [nodes] on a pressure boundary, where q = 0
  std::vector<double> inverse_inertia_;  ///< [owned nodes] B
  MatHandle petsc_;
  KspHandle cycle_;
  Handle<PC, PCDestroy> local_;
  BlockIlu ilu_;
  VecHandle rest_, correction_, image_, right_, answer_;
  std::vector<int> row_start_, column_;                  ///< pattern of the Jacobian's blocks, on one rank
  std::vector<float> pressure_rows_, pressure_columns_;  ///< [blocks][dim + 1], [blocks][dim]
  double rate_ = 0, scale_ = 1;
  bool active_ = false, keep_ = false, factored_ = false;
  bool single_ = false, regular_ = false;  ///< the local stage may be ilu_; its factors exist
};

}  // namespace silt
