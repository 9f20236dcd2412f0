// Included by one unit for each instruction set.
#pragma once
#include "base/dual.hpp"
#include "fluid/compressible/gas_kernel.hpp"
#include "fluid/compressible/gas_loop.hpp"

namespace silt {

template <Cell C, int W>
void evaluate_gas(const GasData& data, int first, int count, double* residual, double* matrix) {
  using V = Lanes<W>;
  constexpr int dim = cell_dimension(C), nodes = cell_nodes(C), size = dim + 2, rows = nodes * size;
  constexpr int each = dim * size * size;
  GasCell<C, V> cell;
  V carried[each], viscosity, normal[dim];
  for (int l = 0; l < W; ++l) {
    const long c = first + (l < count ? l : count - 1);
    for (int k = 0; k < each; ++k) carried[k][l] = data.carried[each * c + k];
    viscosity[l] = data.viscosity[c];
    for (int d = 0; d < dim; ++d) normal[d][l] = data.normal[dim * c + d];
    if (data.eddy_viscosity) {
      cell.eddy_viscosity[l] = data.eddy_viscosity[c];
      cell.eddy_conductivity[l] = data.eddy_conductivity[c];
    }
    for (int a = 0; a < nodes; ++a) {
      const long i = data.cell_nodes[c * nodes + a];
      const double* s = data.state + i * size;
      for (int d = 0; d < dim; ++d) cell.x[a][d][l] = data.coordinates[3 * (c * nodes + a) + d];
      cell.state[a].p[l] = s[0];
      for (int d = 0; d < dim; ++d) cell.state[a].u[d][l] = s[1 + d];
      cell.state[a].T[l] = s[size - 1];
      cell.alpha[a][l] = data.alpha[i];
      cell.alpha_rate[a][l] = data.alpha_rate[i];
      for (int k = 0; k < size; ++k) {
        cell.known[a][k][l] = data.known[i * size + k];
        cell.source[a][k][l] = data.source[i * size + k];
      }
    }
  }
  cell.rate = data.rate;
  for (int d = 0; d < 3; ++d) cell.gravity[d] = data.gravity[d];
  cell.axisymmetric = data.axisymmetric;
  cell.porous = data.porous;
  cell.turbulent = data.eddy_viscosity != nullptr;
  cell.lumped = data.lumped;
  V R[rows], K[rows * rows];
  gas_cell<C, V>(cell, data.law, *data.table, carried, viscosity, normal, R, matrix ? K : nullptr);
  for (int r = 0; r < rows; ++r)
    for (int l = 0; l < W; ++l) residual[static_cast<long>(l) * rows + r] = R[r][l];
  if (matrix)
    for (int l = 0; l < W; ++l)
      for (int k = 0; k < rows * rows; ++k) matrix[static_cast<long>(l) * rows * rows + k] = K[k][l];
}

template <int W>
GasLoop gas_loop_of(Cell cell) {
  switch (cell) {
    case Cell::triangle:
      return {W, &evaluate_gas<Cell::triangle, W>};
    case Cell::quadrilateral:
      return {W, &evaluate_gas<Cell::quadrilateral, W>};
    case Cell::tetrahedron:
      return {W, &evaluate_gas<Cell::tetrahedron, W>};
    default:
      return {W, &evaluate_gas<Cell::hexahedron, W>};
  }
}

GasLoop gas_loop_sse2(Cell cell);
GasLoop gas_loop_avx2(Cell cell);
GasLoop gas_loop_avx512(Cell cell);

}  // namespace silt
