#include <catch2/catch.hpp>
#include <random>

#include "fluid/assembly/cell_entries.hpp"

using namespace silt;

namespace {

/// A chain of cells, three points each, over all ranks: `own` points of a rank, cells that share their last point with
/// the first of the next, the last cell of a rank that of the next rank.
struct Chain {
  static constexpr int own = 6;
  CellEntries::Points points;
  int rows = 0;  ///< of a cell

  explicit Chain(std::vector<int> width) {
    points.points = 3;
    points.cells = own / 2;
    points.width = std::move(width);
    const int total = own * mpi_size(), pair = points.width[0] + points.width[1];
    for (int w : points.width) rows += w;
    for (int c = 0; c < points.cells; ++c)
      for (int a = 0; a < 3; ++a) {
        const int point = (own * mpi_rank() + 2 * c + a) % total;
        points.row.push_back(point / 2 * pair + (point % 2 ? points.width[0] : 0));
      }
  }
  int owned_rows() const { return own / 2 * (points.width[0] + points.width[1]); }
};

}  // namespace

TEST_CASE("Cells added in place give the matrix that PETSc's insertion gives", "[monolithic][mpi]") {
  // Taylor-Hood like points of two widths in AIJ, and nodes with all their unknowns in BAIJ.
  const bool blocked = GENERATE(false, true);
  const Chain chain(blocked ? std::vector<int>{3, 3, 3} : std::vector<int>{2, 1, 2});
  const int rows = chain.rows, n = chain.points.points;
  std::mt19937 random(7 + mpi_rank());
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<std::vector<double>> values(chain.points.cells, std::vector<double>(rows * rows));
  std::vector<std::vector<PetscInt>> places(chain.points.cells);
  for (int c = 0; c < chain.points.cells; ++c) {
    for (double& v : values[c]) v = uniform(random);
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < chain.points.width[a]; ++i) places[c].push_back(chain.points.row[c * n + a] + i);
  }
  MatHandle matrix[2];
  for (MatHandle& m : matrix) {
    SILT_PETSC(MatCreate(PETSC_COMM_WORLD, m.out()));
    SILT_PETSC(MatSetSizes(m, chain.owned_rows(), chain.owned_rows(), PETSC_DETERMINE, PETSC_DETERMINE));
    if (blocked) SILT_PETSC(MatSetBlockSize(m, 3));
    SILT_PETSC(MatSetType(m, blocked ? MATBAIJ : MATAIJ));
    SILT_PETSC(MatSetUp(m));
    SILT_PETSC(MatSetOption(m, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE));
    for (int c = 0; c < chain.points.cells; ++c)
      SILT_PETSC(MatSetValues(m, rows, places[c].data(), rows, places[c].data(), values[c].data(), ADD_VALUES));
    SILT_PETSC(MatAssemblyBegin(m, MAT_FINAL_ASSEMBLY));
    SILT_PETSC(MatAssemblyEnd(m, MAT_FINAL_ASSEMBLY));
  }
  SILT_PETSC(MatZeroEntries(matrix[1]));
  const CellEntries entries(matrix[1], chain.points);
  std::vector<int> elsewhere;
  {
    CellEntries::Arrays arrays(matrix[1]);
    for (int c = 0; c < chain.points.cells; ++c)
      if (!entries.add(arrays, c, values[c].data())) elsewhere.push_back(c);
  }
  // On several ranks the last cell of each has rows of the next rank, and is left to PETSc.
  CHECK(elsewhere.size() == (mpi_size() > 1 ? 1 : 0));
  for (int c : elsewhere)
    SILT_PETSC(MatSetValues(matrix[1], rows, places[c].data(), rows, places[c].data(), values[c].data(), ADD_VALUES));
  SILT_PETSC(MatAssemblyBegin(matrix[1], MAT_FINAL_ASSEMBLY));
  SILT_PETSC(MatAssemblyEnd(matrix[1], MAT_FINAL_ASSEMBLY));
  double whole, difference;
  SILT_PETSC(MatNorm(matrix[0], NORM_FROBENIUS, &whole));
  SILT_PETSC(MatAXPY(matrix[1], -1, matrix[0], SAME_NONZERO_PATTERN));
  SILT_PETSC(MatNorm(matrix[1], NORM_FROBENIUS, &difference));
  CHECK(whole > 1);
  CHECK(difference < 1e-14 * whole);
}
