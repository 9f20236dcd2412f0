#pragma once
// Included only by the translation units that instantiate it for one instruction set each; everything here depends on
// the lane type, so no code compiled for a newer machine can replace another's.
#include "fluid/assembly/flow_data.hpp"
#include "fluid/assembly/flow_table.hpp"
#include "fluid/equations/linearised_navier_stokes.hpp"

namespace silt {

template <Cell C, int order>
struct FlowElement {
  static constexpr int dim = cell_dimension(C);
  static constexpr int NP = cell_nodes(C);
  static constexpr int NV = order == 1                 ? NP
                            : C == Cell::triangle      ? 6
                            : C == Cell::quadrilateral ? 9
                            : C == Cell::tetrahedron   ? 10
                                                       : 27;
  static constexpr int rows = NV * dim + NP;
  static constexpr int velocity_row(int a, int i) { return order == 1 ? a * (dim + 1) + i : a * dim + i; }
  static constexpr int pressure_row(int a) { return order == 1 ? a * (dim + 1) + dim : NV * dim + a; }
};

/// What a batch of cells knows: nodal values, one cell a lane.
template <class E, class V>
struct FlowBatch {
  static constexpr int dim = E::dim, NP = E::NP, NV = E::NV;
  V x[NP][dim], u[NV][dim], p[NP], alpha[NV], history[NV][dim], old[NV][dim], body[NV][dim];
  V rate[NP], load[NP][dim], response[NP], viscosity, h;

  void gather(const FlowData& d, int cell, int l) {
    const int* v = d.velocity_nodes + static_cast<long>(cell) * NV;
    const int* n = d.vertices + static_cast<long>(cell) * NP;
    const double* c = d.coordinates + 3L * cell * NP;
    h[l] = d.cell_size[cell];
    viscosity[l] = d.parameters.viscosity + (d.eddy_viscosity ? d.eddy_viscosity[cell] : 0);
    for (int a = 0; a < NP; ++a) {
      p[a][l] = d.state[d.layout.pressure_offset + static_cast<long>(d.layout.pressure_stride) * n[a]];
      rate[a][l] = d.alpha_rate[n[a]];
      response[a][l] = d.response[n[a]];
      for (int i = 0; i < dim; ++i) {
        x[a][i][l] = c[3 * a + i];
        load[a][i][l] = d.load[3L * n[a] + i];
      }
    }
    for (int a = 0; a < NV; ++a) {
      alpha[a][l] = d.alpha[v[a]];
      for (int i = 0; i < dim; ++i) {
        u[a][i][l] = d.state[static_cast<long>(d.layout.velocity_stride) * v[a] + i];
        history[a][i][l] = d.history[3L * v[a] + i];
        old[a][i][l] = d.velocity_old[3L * v[a] + i];
        body[a][i][l] = d.body[3L * v[a] + i];
      }
    }
  }
};

/// Gradients of the shape functions in space, and the determinant of the cell's map.
template <class E, class V>
struct FlowPoint {
  static constexpr int dim = E::dim, NP = E::NP, NV = E::NV;
  V volume, gN[NV][dim], gM[NP][dim];

  void map(const FlowTable& t, int q, const V (&x)[NP][dim]) {
    V J[dim][dim], inverse[dim][dim];  // J[i][d] = d x_i / d xi_d
    for (int i = 0; i < dim; ++i)
      for (int d = 0; d < dim; ++d) {
        J[i][d] = x[0][i] * t.dM[q][0][d];
        for (int a = 1; a < NP; ++a) J[i][d] += x[a][i] * t.dM[q][a][d];
      }
    V determinant;
    if constexpr (dim == 2) {
      determinant = J[0][0] * J[1][1] - J[0][1] * J[1][0];
      const V r = 1.0 / determinant;
      inverse[0][0] = J[1][1] * r;
      inverse[0][1] = -J[0][1] * r;
      inverse[1][0] = -J[1][0] * r;
      inverse[1][1] = J[0][0] * r;
    } else {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
          inverse[j][i] = J[i1][j1] * J[i2][j2] - J[i1][j2] * J[i2][j1];
        }
      determinant = J[0][0] * inverse[0][0] + J[0][1] * inverse[1][0] + J[0][2] * inverse[2][0];
      const V r = 1.0 / determinant;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) inverse[i][j] *= r;
    }
    volume = determinant * t.weight[q];
    for (int a = 0; a < NP; ++a)
      for (int j = 0; j < dim; ++j) {
        gM[a][j] = inverse[0][j] * t.dM[q][a][0];
        for (int d = 1; d < dim; ++d) gM[a][j] += inverse[d][j] * t.dM[q][a][d];
      }
    for (int a = 0; a < NV; ++a)
      for (int j = 0; j < dim; ++j) {
        gN[a][j] = inverse[0][j] * t.dN[q][a][0];
        for (int d = 1; d < dim; ++d) gN[a][j] += inverse[d][j] * t.dN[q][a][d];
      }
  }
};

/// State and coefficients interpolated to a point.
template <class E, class V>
void interpolate(const FlowBatch<E, V>& b, const FlowPoint<E, V>& at, const FlowTable& t, int q,
                 FlowState<V, E::dim>& s, FlowCoefficients<V, E::dim>& k) {
  constexpr int dim = E::dim;
  s = FlowState<V, dim>{};
  k = FlowCoefficients<V, dim>{};
  k.h = b.h;
  k.viscosity = b.viscosity;
  for (int a = 0; a < E::NV; ++a) {
    const double N = t.N[q][a];
    k.alpha += b.alpha[a] * N;
    for (int i = 0; i < dim; ++i) {
      s.velocity[i] += b.u[a][i] * N;
      k.history[i] += b.history[a][i] * N;
      k.velocity_old[i] += b.old[a][i] * N;
      k.body[i] += b.body[a][i] * N;
      k.grad_alpha[i] += b.alpha[a] * at.gN[a][i];
      s.flux_divergence += b.alpha[a] * b.u[a][i] * at.gN[a][i];
      for (int j = 0; j < dim; ++j) s.velocity_gradient[i][j] += b.u[a][i] * at.gN[a][j];
    }
  }
  for (int a = 0; a < E::NP; ++a) {
    const double M = t.M[q][a];
    s.pressure += b.p[a] * M;
    k.alpha_rate += b.rate[a] * M;
    k.response += b.response[a] * M;
    for (int i = 0; i < dim; ++i) {
      s.pressure_gradient[i] += b.p[a] * at.gM[a][i];
      k.load[i] += b.load[a][i] * M;
    }
  }
}

/// out[row] += test functions times integrand r.
template <class E, class V>
void test_with(const V (&w)[E::NV], const FlowPoint<E, V>& at, const FlowTable& t, int q,
               const FlowResidual<V, E::dim>& r, V* out) {
  constexpr int dim = E::dim;
  for (int a = 0; a < E::NV; ++a)
    for (int i = 0; i < dim; ++i) {
      V sum = r.momentum[i] * t.N[q][a] + w[a] * at.gN[a][i] * r.pressure_stress;
      for (int j = 0; j < dim; ++j) sum += at.gN[a][j] * r.stress[i][j];
      out[E::velocity_row(a, i)] += sum;
    }
  for (int a = 0; a < E::NP; ++a) {
    V sum = r.continuity * t.M[q][a];
    for (int j = 0; j < dim; ++j) sum += at.gM[a][j] * r.flux[j];
    out[E::pressure_row(a)] += sum;
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
  for (int n = 0; n < E::NV; ++n) column[n] = point.column(V{} + t.N[q][n], at.gN[n], b.alpha[n]);
  V pressure_share[E::NP][dim], pressure_value[E::NP];  // of the pressure functions as unknowns
  for (int n = 0; n < E::NP; ++n) {
    pressure_value[n] = at.volume * t.M[q][n];
    for (int i = 0; i < dim; ++i) pressure_share[n][i] = point.share * at.gM[n][i];
  }
  V gradient[dim];
  for (int a = 0; a < E::NV; ++a) {
    for (int i = 0; i < dim; ++i) gradient[i] = at.volume * at.gN[a][i];
    const auto test = point.velocity_test(at.volume * t.N[q][a], gradient);
    V* row = matrix + E::velocity_row(a, 0) * rows;
    for (int n = 0; n < E::NV; ++n) point.add(test, column[n], row + E::velocity_row(n, 0), rows);
    for (int n = 0; n < E::NP; ++n)
      for (int i = 0; i < dim; ++i)
        row[i * rows + E::pressure_row(n)] +=
            test.stream * pressure_share[n][i] - w[a] * at.gN[a][i] * pressure_value[n];
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

template <Cell C, int order, int W>
void evaluate_flow(const FlowData& data, int first, int count, double* residual, double* matrix) {
  using E = FlowElement<C, order>;
  using V = Lanes<W>;
  constexpr int dim = E::dim, rows = E::rows;
  FlowBatch<E, V> b;
  for (int l = 0; l < W; ++l) b.gather(data, first + (l < count ? l : count - 1), l);
  V w[E::NV];
  for (int a = 0; a < E::NV; ++a) w[a] = data.parameters.model_a ? b.alpha[a] : b.alpha[a] * 0.0 + 1.0;

  // Not through a function of the equations: a plain inline function compiled here must not serve other machines.
  double mean[dim];
  for (int i = 0; i < dim; ++i) mean[i] = data.parameters.mean_gradient[i];
  const FlowTable& t = *data.table;
  V R[rows] = {};
  V K[rows * rows];
  if (matrix)
    for (V& k : K) k = V{};
  for (int q = 0; q < t.points; ++q) {
    FlowPoint<E, V> at;
    at.map(t, q, b.x);
    FlowState<V, dim> s;
    FlowCoefficients<V, dim> k;
    interpolate<E, V>(b, at, t, q, s, k);
    if (matrix) {
      add_jacobian<E, V>(b, w, at, t, q, s, k, data.parameters, K);
      continue;
    }
    FlowResidual<V, dim> value;
    VolumeAveragedNavierStokes<dim>::residual(s, k, data.parameters, value);
    for (int i = 0; i < dim; ++i) {
      value.momentum[i] *= at.volume;
      value.flux[i] *= at.volume;
      for (int j = 0; j < dim; ++j) value.stress[i][j] *= at.volume;
    }
    value.pressure_stress *= at.volume;
    value.continuity *= at.volume;
    test_with<E, V>(w, at, t, q, value, R);
    for (int a = 0; a < E::NV; ++a)
      for (int i = 0; i < dim; ++i) R[E::velocity_row(a, i)] -= w[a] * at.volume * (t.N[q][a] * mean[i]);
  }
  if (matrix) {
    for (int k = 0; k < rows * rows; ++k)
      for (int l = 0; l < W; ++l) matrix[static_cast<long>(l) * rows * rows + k] = K[k][l];
    return;
  }
  for (int r = 0; r < rows; ++r)
    for (int l = 0; l < W; ++l) residual[static_cast<long>(l) * rows + r] = R[r][l];
}

template <Cell C, int order, int W>
void evaluate_flux(const FlowData& data, int first, int count, double* flux) {
  using E = FlowElement<C, order>;
  using V = Lanes<W>;
  constexpr int dim = E::dim;
  FlowBatch<E, V> b;
  for (int l = 0; l < W; ++l) b.gather(data, first + (l < count ? l : count - 1), l);
  const FlowTable& t = *data.table;
  for (int q = 0; q < t.points; ++q) {
    FlowPoint<E, V> at;
    at.map(t, q, b.x);
    FlowState<V, dim> s;
    FlowCoefficients<V, dim> k;
    interpolate<E, V>(b, at, t, q, s, k);
    FlowResidual<V, dim> r;
    VolumeAveragedNavierStokes<dim>::residual(s, k, data.parameters, r);
    for (int i = 0; i < dim; ++i) {
      V carried = r.flux[i] * (-1.0 / data.parameters.continuity_scale);
      for (int a = 0; a < E::NV; ++a) carried += b.alpha[a] * b.u[a][i] * t.N[q][a];
      for (int l = 0; l < W; ++l) flux[3 * (static_cast<long>(l) * t.points + q) + i] = carried[l];
    }
  }
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
