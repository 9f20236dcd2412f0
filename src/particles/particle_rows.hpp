#pragma once
#include <cstddef>
#include <vector>

namespace silt {

/// Rows of doubles that belong to particles (contact memories), kept while particles are reordered or migrate.
struct ParticleRows {
  explicit ParticleRows(int row_width) : width(row_width) {}
  int width;                    ///< doubles a row
  std::vector<int> start{0};    ///< [particles + 1]
  std::vector<double> entries;  ///< [rows][width]

  int rows(int p) const { return start[p + 1] - start[p]; }
  const double* row(int k) const { return entries.data() + static_cast<std::size_t>(k) * width; }
  double* row(int k) { return entries.data() + static_cast<std::size_t>(k) * width; }

  void clear() {
    start.assign(1, 0);
    entries.clear();
  }
  /// Forgets all, and gives its room back (an empty list assigned would keep it).
  void release() {
    std::vector<int>(1, 0).swap(start);
    std::vector<double>().swap(entries);
  }
  /// Gives the next particle `count` rows, copied from `from`.
  void append(const double* from, int count) {
    entries.insert(entries.end(), from, from + static_cast<std::size_t>(count) * width);
    start.push_back(start.back() + count);
  }
  /// New particle k gets the rows of old particle order[k].
  void reorder(const std::vector<int>& order) {
    if (entries.empty()) return start.assign(order.size() + 1, 0);
    ParticleRows sorted(width);
    sorted.start.reserve(order.size() + 1);
    sorted.entries.reserve(entries.size());
    for (const int p : order) sorted.append(row(start[p]), rows(p));
    start.swap(sorted.start);
    entries.swap(sorted.entries);
  }
};

}  // namespace silt
