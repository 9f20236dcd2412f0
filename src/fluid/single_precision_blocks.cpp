#include "fluid/single_precision_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace silt {
namespace {

using single_precision::block_size;
using single_precision::Column;
using single_precision::Four;
using DoubleFour = double __attribute__((vector_size(32)));

/// Calls f(rows, row starts, columns, values) with the arrays of a sequential BAIJ matrix.
template <class F>
void with_arrays(Mat matrix, F f) {
  PetscInt rows;
  const PetscInt *start, *column;
  PetscBool done;
  double* values;
  SILT_PETSC(MatGetRowIJ(matrix, 0, PETSC_FALSE, PETSC_TRUE, &rows, &start, &column, &done));
  SILT_PETSC(MatSeqBAIJGetArray(matrix, &values));
  f(rows, start, column, static_cast<const double*>(values));
  SILT_PETSC(MatSeqBAIJRestoreArray(matrix, &values));
  SILT_PETSC(MatRestoreRowIJ(matrix, 0, PETSC_FALSE, PETSC_TRUE, &rows, &start, &column, &done));
}

void round_block(const double* from, Column* to) {
  for (int c = 0; c < block_size; ++c)
    for (int r = 0; r < block_size; ++r) to[c].value[r] = static_cast<float>(from[c * block_size + r]);
}

/// Largest magnitude among so many numbers; not finite where one of them is not.
double largest_of(const double* from, std::size_t count) {
  double largest = 0, rest = 0;
  for (std::size_t k = 0; k < count; ++k) {
    largest = std::max(largest, std::abs(from[k]));
    rest += 0 * from[k];
  }
  return largest + rest;
}

/// Whether a matrix with this largest entry keeps its digits, with room for sums of products and inverses.
bool fits(double largest) { return largest > 1e-15 && largest < 1e15; }

/// a x
inline Four times(const Column* a, const Four& x) {
  return (a[0].value * x[0] + a[1].value * x[1]) + (a[2].value * x[2] + a[3].value * x[3]);
}

/// The inverse by Gauss and Jordan with row pivots, in double precision; false where there is none in single.
bool invert(const Column* a, Column* inverse) {
  double m[block_size][2 * block_size] = {};
  for (int r = 0; r < block_size; ++r) {
    for (int c = 0; c < block_size; ++c) m[r][c] = a[c].value[r];
    m[r][block_size + r] = 1;
  }
  for (int k = 0; k < block_size; ++k) {
    int pivot = k;
    for (int r = k + 1; r < block_size; ++r)
      if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
    if (!(std::abs(m[pivot][k]) > 0)) return false;
    if (pivot != k) std::swap(m[pivot], m[k]);
    const double by = 1 / m[k][k];
    for (double& entry : m[k]) entry *= by;
    for (int r = 0; r < block_size; ++r) {
      const double factor = m[r][k];
      if (r == k || factor == 0) continue;
      for (int c = 0; c < 2 * block_size; ++c) m[r][c] -= factor * m[k][c];
    }
  }
  for (int c = 0; c < block_size; ++c)
    for (int r = 0; r < block_size; ++r) {
      const auto entry = static_cast<float>(m[r][block_size + c]);
      if (!std::isfinite(entry)) return false;
      inverse[c].value[r] = entry;
    }
  return true;
}

std::size_t at(int block) { return static_cast<std::size_t>(block) * block_size; }

}  // namespace

bool BlockProduct::copy(Mat matrix) {
  double largest = 0;
  with_arrays(matrix, [&](int rows, const int* start, const int* column, const double* values) {
    if (row_start_.empty()) {
      row_start_.assign(start, start + rows + 1);
      column_.assign(column, column + start[rows]);
      values_.resize(at(start[rows]));
    }
    constexpr std::size_t block = block_size * block_size;
    for (int k = 0; k < row_start_.back(); ++k) {
      round_block(values + k * block, &values_[at(k)]);
      const double here = largest_of(values + k * block, block);
      largest = std::isfinite(here) ? std::max(largest, here) : std::numeric_limits<double>::infinity();
    }
  });
  return fits(largest);
}

void BlockProduct::multiply(const double* x, double* y) const {
  const int rows = static_cast<int>(row_start_.size()) - 1;
  for (int i = 0; i < rows; ++i) {
    DoubleFour even = {}, odd = {};
    for (int k = row_start_[i]; k < row_start_[i + 1]; ++k) {
      const Column* a = &values_[at(k)];
      const double* from = x + at(column_[k]);
      even += __builtin_convertvector(a[0].value, DoubleFour) * from[0];
      odd += __builtin_convertvector(a[1].value, DoubleFour) * from[1];
      even += __builtin_convertvector(a[2].value, DoubleFour) * from[2];
      odd += __builtin_convertvector(a[3].value, DoubleFour) * from[3];
    }
    const DoubleFour sum = even + odd;
    for (int r = 0; r < block_size; ++r) y[at(i) + r] = sum[r];
  }
}

bool BlockIlu::take_pattern(Mat matrix, const int* start, const int* column, int rows) {
  IS order, same;
  const int* indices;
  SILT_PETSC(MatGetOrdering(matrix, MATORDERINGRCM, &order, &same));
  SILT_PETSC(ISGetIndices(order, &indices));
  order_.assign(indices, indices + rows);
  SILT_PETSC(ISRestoreIndices(order, &indices));
  SILT_PETSC(ISDestroy(&order));
  SILT_PETSC(ISDestroy(&same));
  place_.resize(rows);
  for (int i = 0; i < rows; ++i) place_[order_[i]] = i;

  // Row by row as the elimination goes: a block that arises from two of levels a and b has level a + b + 1.
  constexpr int none = std::numeric_limits<int>::max();
  const int end = rows;  // of the list of the row's columns, which also begins there
  std::vector<int> next(rows + 1), level(rows, none), count(rows), first(rows), right, right_level, own;
  lower_start_.assign(1, 0);
  lower_column_.clear();
  for (int i = 0; i < rows; ++i) {
    own.clear();
    for (int k = start[order_[i]]; k < start[order_[i] + 1]; ++k) own.push_back(place_[column[k]]);
    std::sort(own.begin(), own.end());
    int last = end;
    for (int k : own) {
      level[k] = 0;
      last = next[last] = k;
    }
    next[last] = end;
    if (level[i] == none) return false;
    for (int k = next[end]; k < i; k = next[k]) {
      lower_column_.push_back(k);
      int before = k;
      for (int u = first[k]; u < first[k] + count[k]; ++u) {
        const int j = right[u], arising = level[k] + right_level[u] + 1;
        if (arising > levels_) continue;
        if (level[j] == none) {
          while (next[before] < j) before = next[before];
          next[j] = std::exchange(next[before], j);
        }
        level[j] = std::min(level[j], arising);
      }
    }
    lower_start_.push_back(static_cast<int>(lower_column_.size()));
    first[i] = static_cast<int>(right.size());
    for (int k = next[end]; k != end; k = next[k]) {
      if (k > i) right.push_back(k), right_level.push_back(level[k]);
      level[k] = none;
    }
    count[i] = static_cast<int>(right.size()) - first[i];
  }
  upper_count_ = std::move(count);
  upper_start_.resize(rows);
  upper_column_.clear();
  for (int i = rows - 1; i >= 0; --i) {
    upper_start_[i] = static_cast<int>(upper_column_.size());
    upper_column_.insert(upper_column_.end(), right.begin() + first[i], right.begin() + first[i] + upper_count_[i]);
  }
  lower_.resize(at(lower_start_[rows]));
  upper_.resize(upper_column_.size() * block_size);
  inverse_.resize(at(rows));
  work_.resize(rows);
  return true;
}

bool BlockIlu::factor(Mat matrix) {
  bool regular = true;
  with_arrays(matrix, [&](int rows, const int* start, const int* column, const double* values) {
    regular = !work_.empty() || take_pattern(matrix, start, column, rows);
    std::vector<int> place(rows, -1);  // of a column in the row at hand
    std::vector<Column> row;
    double largest = 0;
    for (int i = 0; i < rows && regular; ++i) {
      const int below = lower_start_[i + 1] - lower_start_[i], size = below + 1 + upper_count_[i];
      const int begin = start[order_[i]], end = start[order_[i] + 1];
      const int *left = &lower_column_[lower_start_[i]], *right = upper_column_.data() + upper_start_[i];
      row.assign(at(size), Column{});
      for (int k = 0; k < below; ++k) place[left[k]] = k;
      place[i] = below;
      for (int k = 0; k < upper_count_[i]; ++k) place[right[k]] = below + 1 + k;
      for (int k = begin; k < end; ++k) round_block(values + at(k) * block_size, &row[at(place[place_[column[k]]])]);
      const double here = largest_of(values + at(begin) * block_size, at(end - begin) * block_size);
      largest = std::isfinite(here) ? std::max(largest, here) : std::numeric_limits<double>::infinity();
      for (int k = 0; k < below; ++k) {
        const int j = left[k];
        Column* l = &lower_[at(lower_start_[i] + k)];
        for (int c = 0; c < block_size; ++c) l[c].value = times(&row[at(k)], inverse_[at(j) + c].value);
        for (int u = upper_start_[j]; u < upper_start_[j] + upper_count_[j]; ++u) {
          const int to = place[upper_column_[u]];
          if (to < 0) continue;
          for (int c = 0; c < block_size; ++c) row[at(to) + c].value -= times(l, upper_[at(u) + c].value);
        }
      }
      regular = invert(&row[at(below)], &inverse_[at(i)]);
      std::copy(row.begin() + static_cast<std::ptrdiff_t>(at(below + 1)), row.end(),
                upper_.begin() + static_cast<std::ptrdiff_t>(at(upper_start_[i])));
      for (int k = 0; k < below; ++k) place[left[k]] = -1;
      place[i] = -1;
      for (int k = 0; k < upper_count_[i]; ++k) place[right[k]] = -1;
    }
    regular = regular && fits(largest);
  });
  return regular;
}

void BlockIlu::solve(const double* r, double* x) {
  const int rows = static_cast<int>(work_.size());
  // Residuals at the end of an iteration may be smaller than any number of single precision.
  const double size = largest_of(r, at(rows)), scale = size > 0 ? 1 / size : 0;
  for (int i = 0; i < rows; ++i) {
    const double* from = r + at(order_[i]);
    Four sum = {static_cast<float>(scale * from[0]), static_cast<float>(scale * from[1]),
                static_cast<float>(scale * from[2]), static_cast<float>(scale * from[3])};
    for (int k = lower_start_[i]; k < lower_start_[i + 1]; ++k)
      sum -= times(&lower_[at(k)], work_[lower_column_[k]].value);
    work_[i].value = sum;
  }
  for (int i = rows - 1; i >= 0; --i) {
    Four sum = work_[i].value;
    for (int k = upper_start_[i]; k < upper_start_[i] + upper_count_[i]; ++k)
      sum -= times(&upper_[at(k)], work_[upper_column_[k]].value);
    sum = times(&inverse_[at(i)], sum);
    work_[i].value = sum;
    double* to = x + at(order_[i]);
    for (int c = 0; c < block_size; ++c) to[c] = size * sum[c];
  }
}

}  // namespace silt
