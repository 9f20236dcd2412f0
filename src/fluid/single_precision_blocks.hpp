#pragma once
#include <cstddef>
#include <vector>

#include "base/petsc.hpp"

namespace silt {

/// Copies in single precision of a sequential matrix of 4 x 4 blocks (BAIJ; velocity and pressure of a node in space):
/// what is done with them is bound by the memory's bandwidth, and costs half.
namespace single_precision {

using Four = float __attribute__((vector_size(16)));
/// A column of a block; as PETSc does, a block stores its columns one after the other.
struct Column {
  Four value;
};
constexpr int block_size = 4;

}  // namespace single_precision

/// The matrix, for products: rounded to single precision, added up in double.
class BlockProduct {
 public:
  /// Takes the values of `matrix`, whose pattern stays as it was at the first call. Says whether they fit.
  bool copy(Mat matrix);
  /// y = A x.
  void multiply(const double* x, double* y) const;

 private:
  std::vector<int> row_start_, column_;
  std::vector<single_precision::Column> values_;  ///< [blocks][4]
};

/// Incomplete factors with fill up to a level, ILU(k), the rows in the order of Cuthill and McKee reversed, as PETSc's:
/// the numbers of a mesh file's nodes may be any, and with them the fill would grow.
class BlockIlu {
 public:
  /// `levels` of fill: 0 the pattern of the matrix.
  explicit BlockIlu(int levels) : levels_(levels) {}
  /// Factors `matrix`, whose pattern stays as it was at the first call. Says whether its values fit and every pivot
  /// block could be inverted; if not, there are no factors.
  bool factor(Mat matrix);
  /// x = (L U)^-1 r, r of any size.
  void solve(const double* r, double* x);
  /// Blocks of both factors, the diagonal ones once.
  std::size_t blocks() const { return lower_column_.size() + upper_column_.size() + work_.size(); }

 private:
  /// The factors' pattern; false where a diagonal block is missing.
  bool take_pattern(Mat matrix, const int* start, const int* column, int rows);

  int levels_;
  std::vector<int> order_, place_;  ///< [rows] row of the matrix at a place of the factors, and the place of a row

  /// Blocks left of the diagonal, row by row; those right of it with the last row first, the order of their use.
  std::vector<int> lower_start_, lower_column_;  ///< [rows + 1], [blocks]
  std::vector<int> upper_start_, upper_count_, upper_column_;
  std::vector<single_precision::Column> lower_, upper_, inverse_;  ///< [blocks][4], inverse_ [rows][4]
  std::vector<single_precision::Column> work_;                     ///< [rows]
};

}  // namespace silt
