#include "app/field_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/petsc.hpp"

namespace silt {
namespace {

constexpr int node_key = 6, cell_key = 3;

/// Brings the upper sides of periodic directions to the lower ones.
Vec3 within_period(const Mesh& mesh, Vec3 x) {
  for (int d = 0; d < 3; ++d)
    if (mesh.periodic[d]) {
      const double length = mesh.upper[d] - mesh.lower[d];
      x[d] -= length * std::floor((x[d] - mesh.lower[d] + 1e-6 * mesh.smallest_edge) / length);
    }
  return x;
}

/// [nodes][6]: place, and mean direction to the cells around, which tells apart the two sides of a slit.
std::vector<double> node_keys(const Mesh& mesh) {
  std::vector<double> around(4 * static_cast<std::size_t>(mesh.nodes), 0.0), keys;
  for (int c = 0; c < mesh.cells; ++c) {
    const Vec3 centre = mesh.centre(c);
    for (int a = 0; a < mesh.nodes_per_cell; ++a) {
      const std::size_t corner = static_cast<std::size_t>(c) * mesh.nodes_per_cell + a;
      double* sum = &around[4 * static_cast<std::size_t>(mesh.cell_nodes[corner])];
      for (int d = 0; d < 3; ++d) sum[d] += centre[d] - mesh.cell_coordinates[3 * corner + d];
      sum[3] += 1;
    }
  }
  mesh.sum_shared(around.data(), 4);
  for (std::size_t i = 0; i < static_cast<std::size_t>(mesh.nodes); ++i) {
    const Vec3 x = within_period(mesh, vec3(&mesh.node_coordinates[3 * i]));
    keys.insert(keys.end(), {x[0], x[1], x[2]});
    for (int d = 0; d < 3; ++d) keys.push_back(around[4 * i + d] / std::max(around[4 * i + 3], 1.0));
  }
  return keys;
}

std::vector<double> cell_keys(const Mesh& mesh) {
  std::vector<double> keys;
  for (int c = 0; c < mesh.cells; ++c) {
    const Vec3 x = within_period(mesh, mesh.centre(c));
    keys.insert(keys.end(), {x[0], x[1], x[2]});
  }
  return keys;
}

/// Finds keys among those of a file: along a line that no mesh is aligned with few lie close to each other.
class KeyIndex {
 public:
  KeyIndex(const std::vector<double>& keys, int width, double tolerance)
      : keys_(keys), width_(width), tolerance_(tolerance) {
    for (std::size_t row = 0; row * width < keys.size(); ++row)
      order_.push_back({along(&keys[row * width]), static_cast<long long>(row)});
    std::sort(order_.begin(), order_.end());
  }
  /// Row of the file, -1 when it is not there. `guess` is tried first.
  long long find(const double* key, long long guess) const {
    if (guess >= 0 && guess < static_cast<long long>(order_.size()) && same(key, guess)) return guess;
    const double s = along(key), slack = 4 * tolerance_;
    for (auto at = std::lower_bound(order_.begin(), order_.end(), std::pair{s - slack, -1LL});
         at != order_.end() && at->first <= s + slack; ++at)
      if (same(key, at->second)) return at->second;
    return -1;
  }

 private:
  static double along(const double* key) { return 0.5411961 * key[0] + 0.6532814815 * key[1] + 0.5307 * key[2]; }
  bool same(const double* key, long long row) const {
    for (int c = 0; c < width_; ++c)
      if (std::abs(key[c] - keys_[row * width_ + c]) > tolerance_) return false;
    return true;
  }
  const std::vector<double>& keys_;
  int width_;
  double tolerance_;
  std::vector<std::pair<double, long long>> order_;
};

/// Rows of the file for every local node or cell.
std::vector<long long> rows_of(const Mesh& mesh, const std::vector<double>& mine, int width, const std::string& name,
                               const CheckpointReader& from, const std::vector<long long>& guess) {
  if (from.components(name) != width) from.refuse(fmt::format("is damaged: {} has another shape", name));
  const std::vector<double> theirs = from.numbers(name);
  const KeyIndex index(theirs, width, 1e-6 * mesh.smallest_edge);
  std::vector<long long> rows(mine.size() / width);
  bool missing = false;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    rows[k] = index.find(&mine[k * width], guess[k]);
    missing = missing || rows[k] < 0;
  }
  if (mpi_any(missing)) from.refuse("was written on another mesh");
  return rows;
}

}  // namespace

void save_fields(const Mesh& mesh, const std::string& prefix, const std::vector<Fluid::StateArray>& arrays,
                 CheckpointWriter& to) {
  const auto owned = static_cast<std::size_t>(mesh.owned_nodes);
  auto keys = node_keys(mesh);
  keys.resize(node_key * owned);
  to.add(prefix + "_nodes", node_key, std::move(keys));
  to.add(prefix + "_cells", cell_key, cell_keys(mesh));
  for (const auto& array : arrays) {
    const auto first = array.values->begin();
    const auto width = static_cast<std::size_t>(array.components);
    const std::size_t count = array.on_cells ? static_cast<std::size_t>(mesh.cells) : owned;
    to.add(prefix + "_" + array.name, array.components,
           std::vector<double>(first, first + static_cast<std::ptrdiff_t>(count * width)));
  }
}

void load_fields(const Mesh& mesh, const std::string& prefix, const std::vector<Fluid::StateArray>& arrays,
                 const CheckpointReader& from) {
  if (!from.has(prefix + "_nodes") || from.rows(prefix + "_nodes") != mesh.total_nodes ||
      from.rows(prefix + "_cells") != mesh.total_cells)
    from.refuse("was written on another mesh");
  long long cell_count = mesh.cells, first_cell = 0;
  MPI_Exscan(&cell_count, &first_cell, 1, MPI_LONG_LONG, MPI_SUM, PETSC_COMM_WORLD);
  if (mpi_rank() == 0) first_cell = 0;
  std::vector<long long> cell_guess(mesh.cells);
  for (int c = 0; c < mesh.cells; ++c) cell_guess[c] = first_cell + c;
  const auto nodes = rows_of(mesh, node_keys(mesh), node_key, prefix + "_nodes", from, mesh.node_global);
  const auto cells = rows_of(mesh, cell_keys(mesh), cell_key, prefix + "_cells", from, cell_guess);
  for (const auto& array : arrays) {
    const std::string name = prefix + "_" + array.name;
    if (!from.has(name))
      from.refuse(fmt::format("has no {}: it was written with another scheme or other equations", name));
    const auto width = static_cast<std::size_t>(array.components);
    if (from.components(name) != array.components)
      from.refuse(fmt::format("was written with another scheme: {} has {} components", name, from.components(name)));
    const auto& rows = array.on_cells ? cells : nodes;
    const auto all = from.numbers(name);
    array.values->resize(rows.size() * width);
    for (std::size_t k = 0; k < rows.size(); ++k)
      std::copy_n(&all[static_cast<std::size_t>(rows[k]) * width], width,
                  array.values->begin() + static_cast<long>(k * width));
  }
}

}  // namespace silt
