#include "fluid/pressure_correction/cell_loops.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>

namespace silt {
namespace {

const CellLoopTable* choose(Cell cell, int width) {
  const int kind = static_cast<int>(cell);
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  const bool middle = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (wide && (width == 0 || width == 8)) return cell_loops_avx512(kind);
  if (middle && (width == 0 || width == 4)) return cell_loops_avx2(kind);
  return cell_loops_baseline(kind);
}

}  // namespace

void CellLoops::Free::operator()(double* p) const { std::free(p); }

CellLoops::CellLoops(const NodalGraph& graph, int width) : table_(choose(graph.mesh.cell, width)) {
  const Mesh& mesh = graph.mesh;
  const int nv = mesh.nodes_per_cell, D = mesh.dimension, W = table_->lanes;
  const int batches = (mesh.cells + W - 1) / W;

  const bool simplex = mesh.cell == Cell::triangle || mesh.cell == Cell::tetrahedron;
  const auto rule = quadrature(mesh.cell, simplex ? 2 : 3);
  for (int q = 0; q < rule.points; ++q) {
    shape(mesh.cell, rule.point[q].data(), reference_.shape[q], reference_.gradient[q]);
    reference_.weight[q] = rule.weight[q];
  }

  nodes_.resize(static_cast<std::size_t>(batches) * nv * W);
  const std::size_t bytes = std::max<std::size_t>(64, sizeof(double) * nodes_.size() * D);
  coordinates_.reset(static_cast<double*>(std::aligned_alloc(64, (bytes + 63) / 64 * 64)));
  if (!coordinates_) throw std::bad_alloc();
  for (int k = 0; k < batches; ++k)
    for (int l = 0; l < W; ++l) {
      const std::size_t cell = std::min(k * W + l, mesh.cells - 1);
      for (int a = 0; a < nv; ++a) {
        const std::size_t at = static_cast<std::size_t>(k) * nv + a;
        nodes_[at * W + l] = mesh.cell_nodes[cell * nv + a];
        for (int d = 0; d < D; ++d) coordinates_[(at * D + d) * W + l] = mesh.cell_coordinates[(cell * nv + a) * 3 + d];
      }
    }

  size_.assign((mesh.cells + 7) / 8 * 8, 1.0);
  for (int c = 0; c < mesh.cells; ++c) {
    const double* x = &mesh.cell_coordinates[static_cast<std::size_t>(c) * nv * 3];
    double least = infinity;
    for (int a = 0; a < nv; ++a)
      for (int b = 0; b < a; ++b) {
        const bool edge = simplex || ((a ^ b) & ((a ^ b) - 1)) == 0;  // tensor cells: one bit apart
        if (edge) least = std::min(least, (vec3(x + 3 * a) - vec3(x + 3 * b)).norm());
      }
    size_[c] = least;
  }
  for (std::size_t c = mesh.cells; c < size_.size(); ++c) size_[c] = size_[mesh.cells - 1];

  mesh_ = {mesh.cells, batches, nodes_.data(), coordinates_.get(), size_.data(), graph.cell_entry.data(), &reference_};
}

}  // namespace silt
