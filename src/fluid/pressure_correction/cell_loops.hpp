#pragma once
#include <array>
#include <memory>
#include <vector>

#include "base/mesh.hpp"
#include "base/nodal_matrix.hpp"
#include "fluid/pressure_correction/cell_loop_arguments.hpp"

namespace silt {

/// The element loops of the pressure correction over one mesh, for the widest vectors this processor has.
///
/// `lanes` cells are treated at once; the mesh is kept in that order (connectivity and corner coordinates of a batch
/// side by side). All loops add this rank's contribution only: sum_shared is the caller's.
class CellLoops {
 public:
  /// `width`: 2, 4 or 8 cells at once (for tests); 0: the widest this processor runs well.
  explicit CellLoops(const NodalGraph& graph, int width = 0);

  int lanes() const { return table_->lanes; }
  /// Entries of a cell array: the number of local cells rounded up to whole batches of any width.
  std::size_t padded_cells() const { return size_.size(); }
  /// [padded_cells] m, shortest edge of each cell.
  const std::vector<double>& size() const { return size_; }

  /// Per-cell coefficients of the step from nodal fields.
  void coefficients(const CoefficientTerms& in, const CellCoefficients& out) const {
    table_->coefficients(mesh_, in, out);
  }
  /// Fills force and balance; void_fraction, pressure_share and drag as coefficients() left them.
  void cell_forces(const ForceTerms& in, const CellCoefficients& out) const { table_->cell_forces(mesh_, in, out); }
  /// Velocity matrix (added to `values` of a NodalMatrix on this graph) and right side [nodes][3].
  void momentum(const MomentumTerms& in, double* values, double* right) const {
    (in.void_fraction ? table_->momentum_porous : table_->momentum)(mesh_, in, values, right);
  }
  /// [nodes][4]: int N tau (grad p + s), and int N tau.
  void projection(const ContinuityTerms& in, double* sums) const { table_->projection(mesh_, in, sums); }
  /// [nodes][2]: int grad N.(U - tau (grad p + s - pi)), and int N div U.
  void continuity(const ContinuityTerms& in, double* sums) const { table_->continuity(mesh_, in, sums); }
  /// Adds int c grad N_a . grad N_b, c [padded_cells].
  void diffusion(const double* coefficient, double* values) const { table_->diffusion(mesh_, coefficient, values); }
  /// [nodes]: what a fall of the pressure by 1 Pa/m adds to the right side of momentum() in its direction.
  void drive(const MomentumTerms& in, double* sums) const { table_->drive(mesh_, in, sums); }
  /// [nodes][3]: (1/nv) int_e c grad p summed over the cells of each node, c [padded cells]; null: 1.
  void mean_gradient(const double* p, const double* c, double* sums) const { table_->mean_gradient(mesh_, p, c, sums); }

 private:
  const CellLoopTable* table_;
  CellBatches mesh_{};
  ReferenceCell reference_{};
  std::vector<int> nodes_;
  struct Free {
    void operator()(double* p) const;
  };
  std::unique_ptr<double[], Free> coordinates_;
  std::vector<double> size_;
};

}  // namespace silt
