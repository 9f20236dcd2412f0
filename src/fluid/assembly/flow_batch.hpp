#pragma once
// The parts of a cell loop that gather and interpolate, one cell a lane. As flow_kernel.hpp: everything here depends on
// the lane type.
#include "fluid/assembly/flow_data.hpp"
#include "fluid/assembly/flow_table.hpp"
#include "fluid/assembly/inverse.hpp"
#include "fluid/equations/volume_averaged_navier_stokes.hpp"

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
  static constexpr bool simplex = C == Cell::triangle || C == Cell::tetrahedron;
  static constexpr bool equal_order = order == 1;
  static constexpr bool linear = simplex && equal_order;  ///< the gradients of all functions are constant in a cell
  static constexpr int velocity_row(int a, int i) { return order == 1 ? a * (dim + 1) + i : a * dim + i; }
  static constexpr int pressure_row(int a) { return order == 1 ? a * (dim + 1) + dim : NV * dim + a; }
};

/// The k-th number of each lane's record.
template <class V>
V gathered(const double* const* record, int k) {
  constexpr int W = sizeof(V) / sizeof(double);
  const double* const* r = record;
  if constexpr (W == 2)
    return V{r[0][k], r[1][k]};
  else if constexpr (W == 4)
    return V{r[0][k], r[1][k], r[2][k], r[3][k]};
  else
    return V{r[0][k], r[1][k], r[2][k], r[3][k], r[4][k], r[5][k], r[6][k], r[7][k]};
}

template <int W>
struct LaneIndices {
  typedef long type __attribute__((vector_size(W * sizeof(long))));
};

/// Swaps the lanes of W vectors that differ in one bit of their number: log2(W) such stages transpose a square.
template <int stage, class V>
void exchange_lanes(V* v) {
  constexpr int W = sizeof(V) / sizeof(double);
  using Index = typename LaneIndices<W>::type;
  Index low{}, high{};
  for (int l = 0; l < W; ++l) {
    low[l] = l & stage ? W + l - stage : l;
    high[l] = l & stage ? W + l : l + stage;
  }
  for (int i = 0; i < W; ++i)
    if (!(i & stage)) {
      const V a = v[i], b = v[i + stage];
      v[i] = __builtin_shuffle(a, b, low);
      v[i + stage] = __builtin_shuffle(a, b, high);
    }
}

/// out[lane][count] = in[count], one lane a row.
template <class V>
void store_by_lane(const V* in, int count, double* out) {
  constexpr int W = sizeof(V) / sizeof(double);
  int k = 0;
  for (; k + W <= count; k += W) {
    V square[W];
    for (int i = 0; i < W; ++i) square[i] = in[k + i];
    exchange_lanes<1>(square);
    if constexpr (W > 2) exchange_lanes<2>(square);
    if constexpr (W > 4) exchange_lanes<4>(square);
    for (int l = 0; l < W; ++l) __builtin_memcpy(out + static_cast<long>(l) * count + k, &square[l], sizeof(V));
  }
  for (; k < count; ++k)
    for (int l = 0; l < W; ++l) out[static_cast<long>(l) * count + k] = in[k][l];
}

/// What a batch of cells knows: nodal values, one cell a lane.
template <class E, class V>
struct FlowBatch {
  static constexpr int dim = E::dim, NP = E::NP, NV = E::NV, W = sizeof(V) / sizeof(double);
  V x[NP][dim], u[NV][dim], p[NP], alpha[NV], history[NV][dim], old[NV][dim], body[NV][dim];
  V rate[NP], load[NP][dim], response[NP], following[NP], lent_share[NP], lent_pressure[NP], viscosity, h;
  const bool forced, loaded;

  /// Cells first to first + count - 1; further lanes repeat the last.
  FlowBatch(const FlowData& d, int first, int count) : forced(d.forced), loaded(d.loaded) {
    const double* record[W];
    long cell[W];
    for (int l = 0; l < W; ++l) {
      cell[l] = first + (l < count ? l : count - 1);
      h[l] = d.cell_size[cell[l]];
      viscosity[l] = d.parameters.viscosity + (d.eddy_viscosity ? d.eddy_viscosity[cell[l]] : 0);
      record[l] = d.coordinates + 3 * NP * cell[l];
    }
    for (int a = 0; a < NP; ++a)
      for (int i = 0; i < dim; ++i) x[a][i] = gathered<V>(record, 3 * a + i);
    for (int a = 0; a < NV; ++a) {
      for (int l = 0; l < W; ++l)
        record[l] = d.node_values + static_cast<long>(FlowData::node_stride) * d.velocity_nodes[cell[l] * NV + a];
      alpha[a] = gathered<V>(record, 3);
      for (int i = 0; i < dim; ++i) {
        u[a][i] = gathered<V>(record, i);
        history[a][i] = gathered<V>(record, 4 + i);
        if (forced) body[a][i] = gathered<V>(record, 8 + i);
        if (loaded) old[a][i] = gathered<V>(record, 12 + i);
      }
    }
    for (int a = 0; a < NP; ++a) {
      for (int l = 0; l < W; ++l)
        record[l] = d.vertex_values + static_cast<long>(FlowData::vertex_stride) * d.vertices[cell[l] * NP + a];
      p[a] = gathered<V>(record, 0);
      rate[a] = gathered<V>(record, 1);
      if (!loaded) continue;
      response[a] = gathered<V>(record, 2);
      following[a] = gathered<V>(record, 3);
      lent_share[a] = gathered<V>(record, 8);
      lent_pressure[a] = gathered<V>(record, 9);
      for (int i = 0; i < dim; ++i) load[a][i] = gathered<V>(record, 4 + i);
    }
  }
};

/// Gradients of the shape functions in space, and the determinant of the cell's map.
template <class E, class V>
struct FlowPoint {
  static constexpr int dim = E::dim, NP = E::NP, NV = E::NV;
  V volume, determinant, inverse[dim][dim], gM[NP][dim];
  V quadratic[E::equal_order ? 1 : NV][dim];
  auto gN(int a) const -> const V (&)[dim] {
    if constexpr (E::equal_order)
      return gM[a];
    else
      return quadratic[a];
  }

  /// To point q; points are visited in order, and a simplex has one map for all.
  void move(const FlowTable& t, int q, const V (&x)[NP][dim]) {
    if (!E::simplex || q == 0) map(t, q, x);
    volume = determinant * t.weight[q];
    if constexpr (!E::equal_order)
      for (int a = 0; a < NV; ++a)
        for (int j = 0; j < dim; ++j) {
          quadratic[a][j] = inverse[0][j] * t.dN[q][a][0];
          for (int d = 1; d < dim; ++d) quadratic[a][j] += inverse[d][j] * t.dN[q][a][d];
        }
  }

  void map(const FlowTable& t, int q, const V (&x)[NP][dim]) {
    V J[dim][dim];  // J[i][d] = d x_i / d xi_d
    for (int i = 0; i < dim; ++i)
      for (int d = 0; d < dim; ++d) {
        J[i][d] = x[0][i] * t.dM[q][0][d];
        for (int a = 1; a < NP; ++a) J[i][d] += x[a][i] * t.dM[q][a][d];
      }
    determinant = invert(J, inverse);
    for (int a = 0; a < NP; ++a)
      for (int j = 0; j < dim; ++j) {
        gM[a][j] = inverse[0][j] * t.dM[q][a][0];
        for (int d = 1; d < dim; ++d) gM[a][j] += inverse[d][j] * t.dM[q][a][d];
      }
  }
};

/// Gradients of state and coefficients at a point; the same at every point of a linear element.
template <class E, class V>
void interpolate_gradients(const FlowBatch<E, V>& b, const FlowPoint<E, V>& at, FlowState<V, E::dim>& s,
                           FlowCoefficients<V, E::dim>& k) {
  constexpr int dim = E::dim;
  s.flux_divergence = V{};
  for (int i = 0; i < dim; ++i) {
    k.grad_alpha[i] = s.pressure_gradient[i] = V{};
    for (int j = 0; j < dim; ++j) s.velocity_gradient[i][j] = V{};
  }
  for (int a = 0; a < E::NV; ++a) {
    const auto& g = at.gN(a);
    V along = b.u[a][0] * g[0];
    for (int i = 1; i < dim; ++i) along += b.u[a][i] * g[i];
    s.flux_divergence += b.alpha[a] * along;
    for (int i = 0; i < dim; ++i) {
      k.grad_alpha[i] += b.alpha[a] * g[i];
      for (int j = 0; j < dim; ++j) s.velocity_gradient[i][j] += b.u[a][i] * g[j];
    }
  }
  for (int a = 0; a < E::NP; ++a)
    for (int i = 0; i < dim; ++i) s.pressure_gradient[i] += b.p[a] * at.gM[a][i];
}

/// Values of state and coefficients at a point.
template <class E, class V>
void interpolate_values(const FlowBatch<E, V>& b, const FlowPoint<E, V>& at, const FlowTable& t, int q,
                        FlowState<V, E::dim>& s, FlowCoefficients<V, E::dim>& k) {
  constexpr int dim = E::dim;
  s.pressure = k.alpha = k.alpha_rate = k.response = k.following = V{};
  for (int i = 0; i < dim; ++i)
    s.velocity[i] = k.history[i] = k.velocity_old[i] = k.body[i] = k.load[i] = k.returned[i] = V{};
  for (int a = 0; a < E::NV; ++a) {
    const double N = t.N[q][a];
    k.alpha += b.alpha[a] * N;
    for (int i = 0; i < dim; ++i) {
      s.velocity[i] += b.u[a][i] * N;
      k.history[i] += b.history[a][i] * N;
    }
    if (b.forced)
      for (int i = 0; i < dim; ++i) k.body[i] += b.body[a][i] * N;
    if (b.loaded)
      for (int i = 0; i < dim; ++i) k.velocity_old[i] += b.old[a][i] * N;
  }
  V lent{};
  for (int a = 0; a < E::NP; ++a) {
    const double M = t.M[q][a];
    s.pressure += b.p[a] * M;
    k.alpha_rate += b.rate[a] * M;
    if (!b.loaded) continue;
    k.response += b.response[a] * M;
    k.following += b.following[a] * M;
    lent += b.lent_share[a] * M;
    for (int i = 0; i < dim; ++i) {
      k.load[i] += b.load[a][i] * M;
      k.returned[i] += b.lent_pressure[a] * at.gM[a][i];
    }
  }
  if (b.loaded)
    for (int i = 0; i < dim; ++i) k.returned[i] *= lent;
}

/// visit(q, point, state, coefficients) at the points of a batch, in order.
template <class E, class V, class Visit>
void at_points(const FlowData& data, const FlowBatch<E, V>& b, const Visit& visit) {
  const FlowTable& t = *data.table;
  FlowPoint<E, V> at;
  FlowState<V, E::dim> s;
  FlowCoefficients<V, E::dim> k;
  k.h = b.h;
  k.viscosity = b.viscosity;
  for (int q = 0; q < t.points; ++q) {
    at.move(t, q, b.x);
    if (!E::linear || q == 0) interpolate_gradients<E, V>(b, at, s, k);
    interpolate_values<E, V>(b, at, t, q, s, k);
    visit(q, at, s, k);
  }
}

}  // namespace silt
