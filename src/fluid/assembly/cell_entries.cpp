#include "fluid/assembly/cell_entries.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace silt {
namespace {

bool blocked(Mat matrix) {
  MatType type;
  SILT_PETSC(MatGetType(matrix, &type));
  for (const char* plain : {MATSEQAIJ, MATMPIAIJ})
    if (!std::strcmp(type, plain)) return false;
  for (const char* block : {MATSEQBAIJ, MATMPIBAIJ})
    if (!std::strcmp(type, block)) return true;
  throw std::logic_error("CellEntries takes AIJ and BAIJ matrices");
}

/// Rows and columns of this rank, a sequential matrix.
Mat own_part(Mat matrix) {
  Mat own = matrix;
  SILT_PETSC(MatGetDiagonalBlock(matrix, &own));
  return own;
}

/// Row starts and columns (of blocks for BAIJ) of a sequential matrix.
struct Pattern {
  Mat matrix;
  PetscBool by_block;
  PetscInt rows = 0;
  const PetscInt *start = nullptr, *column = nullptr;
  Pattern(Mat m, bool b) : matrix(m), by_block(b ? PETSC_TRUE : PETSC_FALSE) {
    PetscBool done;
    SILT_PETSC(MatGetRowIJ(matrix, 0, PETSC_FALSE, by_block, &rows, &start, &column, &done));
  }
  ~Pattern() {
    PetscBool done;
    MatRestoreRowIJ(matrix, 0, PETSC_FALSE, by_block, &rows, &start, &column, &done);
  }
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;
  int place(PetscInt row, PetscInt wanted) const {
    const PetscInt *from = column + start[row], *to = column + start[row + 1], *at = std::lower_bound(from, to, wanted);
    if (at == to || *at != wanted) throw std::logic_error("CellEntries: an entry is missing in the matrix");
    return static_cast<int>(at - column);
  }
};

}  // namespace

CellEntries::CellEntries(Mat matrix, Points points) : points_(std::move(points)), blocked_(blocked(matrix)) {
  for (int w : points_.width) rows_ += w;
  PetscInt end, block = 1;
  SILT_PETSC(MatGetOwnershipRange(matrix, &first_, &end));
  if (blocked_) SILT_PETSC(MatGetBlockSize(matrix, &block));
  const Pattern own(own_part(matrix), blocked_);
  if (!blocked_) start_.assign(own.start, own.start + own.rows + 1);
  const size_t n = points_.points;
  remote_.assign(points_.cells, 0);
  entry_.assign(n * n * points_.cells, 0);
  for (int c = 0; c < points_.cells; ++c) {
    const PetscInt* row = &points_.row[c * n];
    remote_[c] = std::any_of(row, row + n, [&](PetscInt r) { return r < first_ || r >= end; });
    if (remote_[c]) continue;
    for (size_t a = 0; a < n; ++a)
      for (size_t b = 0; b < n; ++b) {
        const PetscInt local = (row[a] - first_) / block;
        entry_[(c * n + a) * n + b] = own.place(local, (row[b] - first_) / block) - (blocked_ ? 0 : own.start[local]);
      }
  }
}

CellEntries::Arrays::Arrays(Mat matrix) : own_(own_part(matrix)), blocked_(blocked(matrix)) {
  if (blocked_)
    SILT_PETSC(MatSeqBAIJGetArray(own_, &values_));
  else
    SILT_PETSC(MatSeqAIJGetArray(own_, &values_));
}

CellEntries::Arrays::~Arrays() {
  if (blocked_)
    MatSeqBAIJRestoreArray(own_, &values_);
  else
    MatSeqAIJRestoreArray(own_, &values_);
}

template <int size>
void CellEntries::add_blocks(double* to, const int* entry, const double* values) const {
  const int n = points_.points, rows = n * size;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b, ++entry) {
      double* block = to + static_cast<size_t>(*entry) * (size * size);  // stored by columns
      const double* from = values + static_cast<size_t>(a) * size * rows + b * size;
      for (int c = 0; c < size; ++c)
        for (int r = 0; r < size; ++r) block[c * size + r] += from[r * rows + c];
    }
}

void CellEntries::add_rows(double* to, int cell, const int* entry, const double* values) const {
  const int n = points_.points;
  const int* width = points_.width.data();
  const PetscInt* row = &points_.row[static_cast<size_t>(cell) * n];
  for (int a = 0; a < n; ++a, entry += n)
    for (int i = 0; i < width[a]; ++i) {
      double* line = to + start_[row[a] - first_ + i];
      for (int b = 0; b < n; ++b)
        for (int c = 0; c < width[b]; ++c) line[entry[b] + c] += *values++;
    }
}

void CellEntries::prefetch(const Arrays& to, int cell) const {
  if (!blocked_ || remote_[cell]) return;
  const size_t pairs = static_cast<size_t>(points_.points) * points_.points, width = points_.width[0];
  constexpr size_t line = 64 / sizeof(double);
  const int* entry = &entry_[cell * pairs];
  for (size_t k = 0; k < pairs; ++k)
    for (size_t at = 0; at < width * width; at += line)
      __builtin_prefetch(to.values_ + static_cast<size_t>(entry[k]) * (width * width) + at, 1);
}

bool CellEntries::add(Arrays& to, int cell, const double* values) const {
  if (remote_[cell]) return false;
  const int* entry = &entry_[static_cast<size_t>(cell) * points_.points * points_.points];
  if (!blocked_)
    add_rows(to.values_, cell, entry, values);
  else if (points_.width[0] == 4)
    add_blocks<4>(to.values_, entry, values);
  else
    add_blocks<3>(to.values_, entry, values);
  return true;
}

}  // namespace silt
