// A batch of cells treated at once, one lane a cell: their shape functions, geometry, gathers and scatters. Part of
// cell_loop_kernels.hpp, with internal linkage for the same reason.
#pragma once
#include "fluid/pressure_correction/cell_loop_arguments.hpp"

namespace silt {
namespace {

constexpr int W = SILT_LANES;
typedef double Lanes __attribute__((vector_size(8 * W)));

inline Lanes load(const double* p) {
  Lanes r = {};
  for (int l = 0; l < W; ++l) r[l] = p[l];
  return r;
}
inline void store(double* p, Lanes v) {
  for (int l = 0; l < W; ++l) p[l] = v[l];
}
inline Lanes square_root(Lanes x) {
  Lanes r = {};
  for (int l = 0; l < W; ++l) r[l] = __builtin_sqrt(x[l]);
  return r;
}
inline Lanes constant(double x) { return Lanes{} + x; }

/// Sizes of the four cells, by the value of enum Cell.
template <int kind>
struct Shape {
  static constexpr int D = kind < 2 ? 2 : 3;
  static constexpr int nodes = kind == 0 ? 3 : kind == 3 ? 8 : 4;
  static constexpr int points = nodes;
  static constexpr bool simplex = kind == 0 || kind == 2;
};

/// Corner coordinates of a batch, and shape gradients at one quadrature point.
template <int kind>
struct Geometry {
  static constexpr int D = Shape<kind>::D, nodes = Shape<kind>::nodes;
  Lanes x[nodes][D];
  Lanes gradient[nodes][D];
  Lanes volume;  ///< weight times Jacobian

  Geometry(const CellBatches& mesh, int batch) {
    const double* p = mesh.coordinates + static_cast<long>(batch) * nodes * D * W;
    for (int a = 0; a < nodes; ++a)
      for (int d = 0; d < D; ++d, p += W) x[a][d] = load(p);
  }

  void at(const ReferenceCell& reference, int q) {
    if (Shape<kind>::simplex && q > 0) return;  // the gradients and the weights of a simplex rule are constant
    Lanes J[D][D] = {};
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < D; ++i)
        for (int d = 0; d < D; ++d) J[i][d] += x[a][i] * reference.gradient[q][a][d];
    Lanes inverse[D][D], determinant;
    if constexpr (D == 3) {
      const Lanes c00 = J[1][1] * J[2][2] - J[1][2] * J[2][1], c01 = J[1][2] * J[2][0] - J[1][0] * J[2][2],
                  c02 = J[1][0] * J[2][1] - J[1][1] * J[2][0];
      determinant = J[0][0] * c00 + J[0][1] * c01 + J[0][2] * c02;
      const Lanes r = 1.0 / determinant;
      inverse[0][0] = c00 * r, inverse[1][0] = c01 * r, inverse[2][0] = c02 * r;
      inverse[0][1] = (J[0][2] * J[2][1] - J[0][1] * J[2][2]) * r;
      inverse[1][1] = (J[0][0] * J[2][2] - J[0][2] * J[2][0]) * r;
      inverse[2][1] = (J[0][1] * J[2][0] - J[0][0] * J[2][1]) * r;
      inverse[0][2] = (J[0][1] * J[1][2] - J[0][2] * J[1][1]) * r;
      inverse[1][2] = (J[0][2] * J[1][0] - J[0][0] * J[1][2]) * r;
      inverse[2][2] = (J[0][0] * J[1][1] - J[0][1] * J[1][0]) * r;
    } else {
      determinant = J[0][0] * J[1][1] - J[0][1] * J[1][0];
      const Lanes r = 1.0 / determinant;
      inverse[0][0] = J[1][1] * r, inverse[0][1] = -J[0][1] * r;
      inverse[1][0] = -J[1][0] * r, inverse[1][1] = J[0][0] * r;
    }
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < D; ++i) {
        gradient[a][i] = reference.gradient[q][a][0] * inverse[0][i];
        for (int d = 1; d < D; ++d) gradient[a][i] += reference.gradient[q][a][d] * inverse[d][i];
      }
    volume = determinant * reference.weight[q];
  }
};

/// C of the `stride` values of every node of the batch.
template <int nodes, int C>
inline void gather(Lanes (&out)[nodes][C], const double* field, int stride, const int* node) {
  for (int a = 0; a < nodes; ++a)
    for (int c = 0; c < C; ++c) {
      Lanes v = {};
      for (int l = 0; l < W; ++l) v[l] = field[static_cast<long>(stride) * node[a * W + l] + c];
      out[a][c] = v;
    }
}

template <int nodes, int C>
inline void scatter(const Lanes (&in)[nodes][C], double* field, int stride, const int* node, int lanes) {
  for (int a = 0; a < nodes; ++a)
    for (int l = 0; l < lanes; ++l) {
      double* p = field + static_cast<long>(stride) * node[a * W + l];
      for (int c = 0; c < C; ++c) p[c] += in[a][c][l];
    }
}

template <int nodes>
inline void scatter_matrix(const Lanes (&in)[nodes][nodes], double* values, const int* entry, int lanes) {
  for (int l = 0; l < lanes; ++l, entry += nodes * nodes)
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b) values[entry[a * nodes + b]] += in[a][b][l];
}

template <int kind>
inline const int* batch_nodes(const CellBatches& mesh, int batch) {
  return mesh.nodes + static_cast<long>(batch) * Shape<kind>::nodes * W;
}
inline int lanes_of(const CellBatches& mesh, int batch) {
  const int left = mesh.cells - batch * W;
  return left < W ? left : W;
}

}  // namespace
}  // namespace silt
