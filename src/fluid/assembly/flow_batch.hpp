#pragma once
// The parts of a cell loop that gather and interpolate, one cell a lane. As flow_kernel.hpp: everything here depends on
// the lane type.
#include <utility>

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
  /// Terms of a value at a point (flow_term).
  static constexpr int velocity_terms = linear ? 2 : NV, vertex_terms = linear ? 2 : NP;
  static constexpr int velocity_row(int a, int i) { return order == 1 ? a * (dim + 1) + i : a * dim + i; }
  static constexpr int pressure_row(int a) { return order == 1 ? a * (dim + 1) + dim : NV * dim + a; }
};

/// The k-th number of each lane's record.
template <class V>
[[gnu::always_inline]] inline V gathered(const double* const* record, int k) {
  constexpr int W = sizeof(V) / sizeof(double);
  const double* const* r = record;
  if constexpr (W == 2)
    return V{r[0][k], r[1][k]};
  else if constexpr (W == 4)
    return V{r[0][k], r[1][k], r[2][k], r[3][k]};
  else
    return V{r[0][k], r[1][k], r[2][k], r[3][k], r[4][k], r[5][k], r[6][k], r[7][k]};
}

/// Of two vectors whose numbers differ by `stage`: the first, or (`high`) the second, after the exchange of lanes.
template <int stage, bool high, class V, std::size_t... lane>
[[gnu::always_inline]] inline V exchanged(const V& a, const V& b, std::index_sequence<lane...>) {
  return __builtin_shufflevector(
      a, b, (lane & stage ? sizeof...(lane) + lane - (high ? 0 : stage) : lane + (high ? stage : 0))...);
}

/// Swaps the lanes of W vectors that differ in one bit of their number: log2(W) such stages transpose a square.
template <int stage, class V>
[[gnu::always_inline]] inline void exchange_lanes(V* v) {
  constexpr int W = sizeof(V) / sizeof(double);
  const std::make_index_sequence<W> lanes;
  for (int i = 0; i < W; ++i)
    if (!(i & stage)) {
      const V a = v[i], b = v[i + stage];
      v[i] = exchanged<stage, false>(a, b, lanes);
      v[i + stage] = exchanged<stage, true>(a, b, lanes);
    }
}

/// Makes the lanes of W vectors its rows.
template <class V>
[[gnu::always_inline]] inline void transpose(V* square) {
  constexpr int W = sizeof(V) / sizeof(double);
  exchange_lanes<1>(square);
  if constexpr (W > 2) exchange_lanes<2>(square);
  if constexpr (W > 4) exchange_lanes<4>(square);
}

/// A lane type anywhere in memory (as a copy of bytes it would pass through memory once more).
template <class V>
struct Unaligned {
  typedef V type __attribute__((aligned(sizeof(double)), may_alias));
};

/// out[k] = the k-th numbers of the lanes' records, k < count. Whole squares are read by rows: a third of the work.
template <int count, class V>
[[gnu::always_inline]] inline void gather(const double* const* record, V (&out)[count]) {
  using Row = typename Unaligned<V>::type;
  constexpr int W = sizeof(V) / sizeof(double), whole = count - count % W;
  for (int k = 0; k < whole; k += W) {
    V square[W];
#pragma GCC unroll 8
    for (int l = 0; l < W; ++l) square[l] = *reinterpret_cast<const Row*>(record[l] + k);
    transpose(square);
    for (int i = 0; i < W; ++i) out[k + i] = square[i];
  }
  for (int k = whole; k < count; ++k) out[k] = gathered<V>(record, k);
}

/// out[lane][count] = in[count], one lane a row.
template <class V>
[[gnu::always_inline]] inline void store_by_lane(const V* in, int count, double* out) {
  using Row = typename Unaligned<V>::type;
  constexpr int W = sizeof(V) / sizeof(double);
  int k = 0;
  for (; k + W <= count; k += W) {
    V square[W];
    for (int i = 0; i < W; ++i) square[i] = in[k + i];
    transpose(square);
#pragma GCC unroll 8
    for (int l = 0; l < W; ++l) *reinterpret_cast<Row*>(out + static_cast<long>(l) * count + k) = square[l];
  }
  for (; k < count; ++k)
    for (int l = 0; l < W; ++l) out[static_cast<long>(l) * count + k] = in[k][l];
}

/// A node and its weight in a value at a point.
struct FlowTerm {
  int node;
  double weight;
};
/// The k-th term of a value at point q, where the functions are `shape`. Point q of a linear element is the one nearest
/// to its node q, and the other nodes count alike: two terms, the sum over all nodes (kept behind them) and node q.
template <class E>
[[gnu::always_inline]] inline FlowTerm flow_term(const double* shape, int q, int k) {
  if constexpr (E::linear) {
    const double other = shape[q == 0];
    return k == 0 ? FlowTerm{E::NV, other} : FlowTerm{q, shape[q] - other};
  } else {
    return {k, shape[k]};
  }
}

/// What a batch of cells knows: nodal values, one cell a lane; of a linear element also their sums, behind them.
template <class E, class V>
struct FlowBatch {
  static constexpr int dim = E::dim, NP = E::NP, NV = E::NV, W = sizeof(V) / sizeof(double);
  static constexpr int velocities = NV + E::linear, vertices = NP + E::linear;
  V x[NP][dim], u[velocities][dim], p[vertices], alpha[velocities], history[velocities][dim], old[velocities][dim],
      body[velocities][dim];
  V rate[vertices], load[vertices][dim], response[vertices], following[vertices], lent_share[vertices],
      lent_pressure[vertices], viscosity, h;
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
    V place[3 * NP];
    gather(record, place);
    for (int a = 0; a < NP; ++a)
      for (int i = 0; i < dim; ++i) x[a][i] = place[3 * a + i];
    for (int a = 0; a < NV; ++a) {
      for (int l = 0; l < W; ++l)
        record[l] = d.node_values + static_cast<long>(FlowData::node_stride) * d.velocity_nodes[cell[l] * NV + a];
      V value[8];
      gather(record, value);
      alpha[a] = value[3];
      for (int i = 0; i < dim; ++i) {
        u[a][i] = value[i];
        history[a][i] = value[4 + i];
        if (forced) body[a][i] = gathered<V>(record, 8 + i);
        if (loaded) old[a][i] = gathered<V>(record, 12 + i);
      }
    }
    for (int a = 0; a < NP; ++a) {
      for (int l = 0; l < W; ++l)
        record[l] = d.vertex_values + static_cast<long>(FlowData::vertex_stride) * d.vertices[cell[l] * NP + a];
      if (!loaded) {
        p[a] = gathered<V>(record, 0);
        rate[a] = gathered<V>(record, 1);
        continue;
      }
      V value[10];
      gather(record, value);
      p[a] = value[0];
      rate[a] = value[1];
      response[a] = value[2];
      following[a] = value[3];
      for (int i = 0; i < dim; ++i) load[a][i] = value[4 + i];
      lent_share[a] = value[8];
      lent_pressure[a] = value[9];
    }
    if constexpr (E::linear) add_sums();
  }

 private:
  static void add_sum(V* values) {
    values[NV] = values[0];
    for (int a = 1; a < NV; ++a) values[NV] += values[a];
  }
  static void add_sum(V (*values)[dim]) {
    for (int i = 0; i < dim; ++i) {
      values[NV][i] = values[0][i];
      for (int a = 1; a < NV; ++a) values[NV][i] += values[a][i];
    }
  }
  void add_sums() {
    for (V* values : {p, alpha, rate}) add_sum(values);
    for (auto* values : {u, history}) add_sum(values);
    if (forced) add_sum(body);
    if (!loaded) return;
    for (V* values : {response, following, lent_share}) add_sum(values);
    for (auto* values : {old, load}) add_sum(values);
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

  FlowPoint(const FlowTable& t, const V (&x)[NP][dim]) {
    if constexpr (E::simplex) map(t, 0, x);  // one for all points
  }

  void move(const FlowTable& t, int q, const V (&x)[NP][dim]) {
    if constexpr (!E::simplex) map(t, q, x);
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
  s.pressure = k.alpha = k.alpha_rate = V{};
  for (int i = 0; i < dim; ++i) s.velocity[i] = k.history[i] = V{};
  for (int m = 0; m < E::velocity_terms; ++m) {
    const auto [a, N] = flow_term<E>(t.N[q], q, m);
    k.alpha += b.alpha[a] * N;
    for (int i = 0; i < dim; ++i) {
      s.velocity[i] += b.u[a][i] * N;
      k.history[i] += b.history[a][i] * N;
    }
  }
  for (int m = 0; m < E::vertex_terms; ++m) {
    const auto [a, M] = flow_term<E>(t.M[q], q, m);
    s.pressure += b.p[a] * M;
    k.alpha_rate += b.rate[a] * M;
  }
  if (b.forced) {
    for (int i = 0; i < dim; ++i) k.body[i] = V{};
    for (int m = 0; m < E::velocity_terms; ++m) {
      const auto [a, N] = flow_term<E>(t.N[q], q, m);
      for (int i = 0; i < dim; ++i) k.body[i] += b.body[a][i] * N;
    }
  }
  if (!b.loaded) return;
  V lent{};
  k.response = k.following = V{};
  for (int i = 0; i < dim; ++i) k.velocity_old[i] = k.load[i] = k.returned[i] = V{};
  for (int m = 0; m < E::velocity_terms; ++m) {
    const auto [a, N] = flow_term<E>(t.N[q], q, m);
    for (int i = 0; i < dim; ++i) k.velocity_old[i] += b.old[a][i] * N;
  }
  for (int m = 0; m < E::vertex_terms; ++m) {
    const auto [a, M] = flow_term<E>(t.M[q], q, m);
    k.response += b.response[a] * M;
    k.following += b.following[a] * M;
    lent += b.lent_share[a] * M;
    for (int i = 0; i < dim; ++i) k.load[i] += b.load[a][i] * M;
  }
  for (int a = 0; a < E::NP; ++a)
    for (int i = 0; i < dim; ++i) k.returned[i] += b.lent_pressure[a] * at.gM[a][i];
  for (int i = 0; i < dim; ++i) k.returned[i] *= lent;
}

/// visit(q, point, state, coefficients) at the points of a batch, in order.
template <class E, class V, class Visit>
void at_points(const FlowData& data, const FlowBatch<E, V>& b, const Visit& visit) {
  const FlowTable& t = *data.table;
  FlowPoint<E, V> at(t, b.x);
  FlowState<V, E::dim> s;
  FlowCoefficients<V, E::dim> k{};
  k.loaded = b.loaded;
  k.h = b.h;
  k.viscosity = b.viscosity;
  if constexpr (E::linear) interpolate_gradients<E, V>(b, at, s, k);
  for (int q = 0; q < t.points; ++q) {
    at.move(t, q, b.x);
    if constexpr (!E::linear) interpolate_gradients<E, V>(b, at, s, k);
    interpolate_values<E, V>(b, at, t, q, s, k);
    visit(q, at, s, k);
  }
}

}  // namespace silt
