#pragma once
#include <vector>

#include "base/petsc.hpp"

namespace silt {

/// Where the entries of the cells' matrices stand in the arrays of a PETSc matrix (AIJ or BAIJ on one rank or several),
/// found once: adding a cell is then a sum into known places instead of searches for columns.
///
/// The unknowns of a cell are given as points of consecutive rows: a node with all its unknowns, or (Taylor-Hood) the
/// velocity of a node and the pressure of a vertex. The rows of a point share their columns, so one place serves a pair
/// of points. Valid for every matrix with the pattern and the distribution of the one it was made from.
class CellEntries {
 public:
  struct Points {
    int cells = 0, points = 0;  ///< points of a cell
    std::vector<int> width;     ///< [points] rows of a point
    std::vector<PetscInt> row;  ///< [cells][points] its first global row
  };
  CellEntries(Mat matrix, Points points);

  /// The arrays of a matrix, held while cells are added.
  class Arrays {
   public:
    explicit Arrays(Mat matrix);
    ~Arrays();
    Arrays(const Arrays&) = delete;
    Arrays& operator=(const Arrays&) = delete;

   private:
    friend class CellEntries;
    Mat own_;  ///< rows and columns of this rank
    double* values_ = nullptr;
    bool blocked_;
  };
  /// Asks for the cell's blocks (BAIJ) ahead of add(): they are scattered over the matrix.
  void prefetch(const Arrays& to, int cell) const;
  /// Adds values [rows][rows] of the cell. False, with nothing done, where a row belongs to another rank.
  bool add(Arrays& to, int cell, const double* values) const;

 private:
  template <int size>
  void add_blocks(double* to, const int* entry, const double* values) const;
  void add_rows(double* to, int cell, const int* entry, const double* values) const;

  Points points_;
  int rows_ = 0;
  PetscInt first_ = 0;
  bool blocked_ = false;
  std::vector<char> remote_;  ///< [cells]
  std::vector<int> entry_;    ///< [cells][points][points] block (BAIJ) or place in the row (AIJ)
  std::vector<int> start_;    ///< of each local row (AIJ)
};

}  // namespace silt
