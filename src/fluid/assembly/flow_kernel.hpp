#pragma once
// Included only by the translation units that instantiate it for one instruction set each; everything here depends on
// the lane type, so no code compiled for a newer machine can replace another's.
#include "fluid/assembly/linear_jacobian.hpp"

namespace silt {

/// out[row] += gradients of the test functions times what stands against them in r (already times the volume).
template <class E, class V>
void test_gradients(const V (&w)[E::NV], const FlowPoint<E, V>& at, const FlowResidual<V, E::dim>& r, V* out) {
  constexpr int dim = E::dim;
  for (int a = 0; a < E::NV; ++a) {
    const auto& g = at.gN(a);
    const V pressure = w[a] * r.pressure_stress;
    for (int i = 0; i < dim; ++i) {
      V sum = g[i] * pressure;
      for (int j = 0; j < dim; ++j) sum += g[j] * r.stress[i][j];
      out[E::velocity_row(a, i)] += sum;
    }
  }
  for (int a = 0; a < E::NP; ++a) {
    V sum = at.gM[a][0] * r.flux[0];
    for (int j = 1; j < dim; ++j) sum += at.gM[a][j] * r.flux[j];
    out[E::pressure_row(a)] += sum;
  }
}

/// out[row] += values of the test functions times what stands against them in r (already times the volume); what all
/// functions of a linear element have alike goes to the rows behind them (flow_term).
template <class E, class V>
void test_values(const FlowTable& t, int q, const FlowResidual<V, E::dim>& r, V* out) {
  for (int m = 0; m < E::velocity_terms; ++m) {
    const auto [a, N] = flow_term<E>(t.N[q], q, m);
    for (int i = 0; i < E::dim; ++i) out[E::velocity_row(a, i)] += r.momentum[i] * N;
  }
  for (int m = 0; m < E::vertex_terms; ++m) {
    const auto [a, M] = flow_term<E>(t.M[q], q, m);
    out[E::pressure_row(a)] += r.continuity * M;
  }
}

/// matrix[row][column] += derivative of the rows at one point.
template <class E, class V>
void add_jacobian(const FlowBatch<E, V>& b, const V (&w)[E::NV], const FlowPoint<E, V>& at, const FlowTable& t, int q,
                  const FlowState<V, E::dim>& s, const FlowCoefficients<V, E::dim>& k, const FlowParameters& parameters,
                  V* matrix) {
  constexpr int dim = E::dim, rows = E::rows;
  using Point = LinearisedNavierStokes<dim, V>;
  const Point point(s, k, parameters);
  typename Point::Column column[E::NV];
  for (int n = 0; n < E::NV; ++n) column[n] = point.column(V{} + t.N[q][n], at.gN(n), b.alpha[n]);
  // Of the pressure functions as unknowns: their value, what the strong residual has of them, and the share of it that
  // is tested as it stands (not by parts).
  V pressure_share[E::NP][dim], pressure_lent[E::NP][dim], pressure_value[E::NP];
  for (int n = 0; n < E::NP; ++n) {
    pressure_value[n] = at.volume * t.M[q][n];
    for (int i = 0; i < dim; ++i) {
      pressure_lent[n][i] = point.lent * at.gM[n][i];
      pressure_share[n][i] = point.share * at.gM[n][i] + pressure_lent[n][i];
    }
  }
  V gradient[dim];
  for (int a = 0; a < E::NV; ++a) {
    for (int i = 0; i < dim; ++i) gradient[i] = at.volume * at.gN(a)[i];
    const auto test = point.velocity_test(at.volume * t.N[q][a], gradient);
    V* row = matrix + E::velocity_row(a, 0) * rows;
    for (int n = 0; n < E::NV; ++n) point.add(test, column[n], row + E::velocity_row(n, 0), rows);
    for (int n = 0; n < E::NP; ++n)
      for (int i = 0; i < dim; ++i)
        row[i * rows + E::pressure_row(n)] += test.stream * pressure_share[n][i] + test.shape * pressure_lent[n][i] -
                                              w[a] * at.gN(a)[i] * pressure_value[n];
  }
  for (int a = 0; a < E::NP; ++a) {
    for (int i = 0; i < dim; ++i) gradient[i] = at.volume * at.gM[a][i];
    const auto test = point.pressure_test(pressure_value[a] * parameters.continuity_scale, gradient);
    V* row = matrix + E::pressure_row(a) * rows;
    for (int n = 0; n < E::NV; ++n) point.add(test, column[n], row + E::velocity_row(n, 0));
    for (int n = 0; n < E::NP; ++n) {
      V sum = test.stabilised[0] * pressure_share[n][0];
      for (int j = 1; j < dim; ++j) sum += test.stabilised[j] * pressure_share[n][j];
      row[E::pressure_row(n)] += sum;
    }
  }
}

/// R [rows], with one node more for a linear element (test_values). Inlined to the last call: sums kept in memory
/// between calls would cost more than the arithmetic.
template <class E, class V>
[[gnu::flatten]] void evaluate_residual(const FlowData& data, const FlowBatch<E, V>& b, const V (&w)[E::NV], V* R) {
  constexpr int dim = E::dim;
  const FlowTable& t = *data.table;
  double mean[dim];
  bool driven = false;
  for (int i = 0; i < dim; ++i) driven |= (mean[i] = data.parameters.mean_gradient[i]) != 0;
  FlowResidual<V, dim> sum{};  // over the points of a linear element
  at_points<E, V>(data, b, [&](int q, const FlowPoint<E, V>& at, const auto& s, const auto& k) {
    FlowResidual<V, dim> value;
    VolumeAveragedNavierStokes<dim>::residual(s, k, data.parameters, value);
    for (int i = 0; i < dim; ++i) {
      value.momentum[i] *= at.volume;
      value.flux[i] *= at.volume;
      for (int j = 0; j < dim; ++j) value.stress[i][j] *= at.volume;
    }
    value.pressure_stress *= at.volume;
    value.continuity *= at.volume;
    test_values<E, V>(t, q, value, R);
    if (driven)
      for (int a = 0; a < E::NV; ++a)
        for (int i = 0; i < dim; ++i) R[E::velocity_row(a, i)] -= w[a] * at.volume * (t.N[q][a] * mean[i]);
    if constexpr (!E::linear) {
      test_gradients<E, V>(w, at, value, R);
    } else {
      for (int i = 0; i < dim; ++i) {
        sum.flux[i] += value.flux[i];
        for (int j = 0; j < dim; ++j) sum.stress[i][j] += value.stress[i][j];
      }
      sum.pressure_stress += value.pressure_stress;
      if (q < t.points - 1) return;
      test_gradients<E, V>(w, at, sum, R);
      for (int row = 0; row < E::rows; ++row) R[row] += R[E::rows + row % (dim + 1)];
    }
  });
}

template <class E, class V>
void evaluate_matrix(const FlowData& data, const FlowBatch<E, V>& b, const V (&w)[E::NV], V (&K)[E::rows * E::rows]) {
  if constexpr (E::linear) {
    LinearJacobian<E, V>(data, b, w, K);
  } else {
    for (V& k : K) k = V{};
    at_points<E, V>(data, b, [&](int q, const FlowPoint<E, V>& at, const auto& s, const auto& k) {
      add_jacobian<E, V>(b, w, at, *data.table, q, s, k, data.parameters, K);
    });
  }
}

template <Cell C, int order, int W>
void evaluate_flow(const FlowData& data, int first, int count, double* residual, double* matrix) {
  using E = FlowElement<C, order>;
  using V = Lanes<W>;
  constexpr int rows = E::rows;
  const FlowBatch<E, V> b(data, first, count);
  V w[E::NV];
  for (int a = 0; a < E::NV; ++a) w[a] = data.parameters.model_a ? b.alpha[a] : b.alpha[a] * 0.0 + 1.0;
  if (matrix) {
    V K[rows * rows];
    evaluate_matrix<E, V>(data, b, w, K);
    store_by_lane(K, rows * rows, matrix);
  } else {
    V R[rows + (E::linear ? E::dim + 1 : 0)] = {};
    evaluate_residual<E, V>(data, b, w, R);
    store_by_lane(R, rows, residual);
  }
}

template <Cell C, int order, int W>
void evaluate_flux(const FlowData& data, int first, int count, double* flux) {
  using E = FlowElement<C, order>;
  using V = Lanes<W>;
  constexpr int dim = E::dim;
  const FlowBatch<E, V> b(data, first, count);
  const FlowTable& t = *data.table;
  at_points<E, V>(data, b, [&](int q, const FlowPoint<E, V>&, const auto& s, const auto& k) {
    FlowResidual<V, dim> r;
    VolumeAveragedNavierStokes<dim>::residual(s, k, data.parameters, r);
    for (int i = 0; i < dim; ++i) {
      V carried = r.flux[i] * (-1.0 / data.parameters.continuity_scale);
      for (int a = 0; a < E::NV; ++a) carried += b.alpha[a] * b.u[a][i] * t.N[q][a];
      for (int l = 0; l < W; ++l) flux[3 * (static_cast<long>(l) * t.points + q) + i] = carried[l];
    }
  });
}

template <Cell C, int order, int W>
FlowKernel flow_kernel_for() {
  return {W, FlowElement<C, order>::rows, &evaluate_flow<C, order, W>, &evaluate_flux<C, order, W>};
}

template <int W>
FlowKernel flow_kernel_of(Cell cell, int order) {
  switch (cell) {
    case Cell::triangle:
      return order == 1 ? flow_kernel_for<Cell::triangle, 1, W>() : flow_kernel_for<Cell::triangle, 2, W>();
    case Cell::quadrilateral:
      return order == 1 ? flow_kernel_for<Cell::quadrilateral, 1, W>() : flow_kernel_for<Cell::quadrilateral, 2, W>();
    case Cell::tetrahedron:
      return order == 1 ? flow_kernel_for<Cell::tetrahedron, 1, W>() : flow_kernel_for<Cell::tetrahedron, 2, W>();
    default:
      return order == 1 ? flow_kernel_for<Cell::hexahedron, 1, W>() : flow_kernel_for<Cell::hexahedron, 2, W>();
  }
}

FlowKernel flow_kernel_sse2(Cell cell, int order);
FlowKernel flow_kernel_avx2(Cell cell, int order);
FlowKernel flow_kernel_avx512(Cell cell, int order);

}  // namespace silt
