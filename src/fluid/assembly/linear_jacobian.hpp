#pragma once
// As flow_kernel.hpp: everything here depends on the lane type.
#include <algorithm>

#include "fluid/assembly/flow_batch.hpp"
#include "fluid/equations/linearised_navier_stokes.hpp"

namespace silt {

/// The derivative of the rows of linear cells. Gradients are the same at every point, and a function has one value at
/// its own point and another at the others (flow_term), so the points are summed before the nodes are paired: a third
/// of the work of add_jacobian, and each entry is written once.
template <class E, class V>
struct LinearJacobian {
  static constexpr int dim = E::dim, n = E::NV, rows = E::rows;
  using Point = LinearisedNavierStokes<dim, V>;

  LinearJacobian(const FlowData& data, const FlowBatch<E, V>& batch, const V (&share)[n], V* out)
      : b(batch), t(*data.table), w(share), matrix(out), other(t.N[0][1]), extra(t.N[0][0] - t.N[0][1]) {
    at_points<E, V>(data, b, [&](int q, const FlowPoint<E, V>& here, const auto& s, const auto& k) {
      for (int a = 0; a < n && q == 0; ++a) std::copy_n(here.gM[a], dim, gradient[a]);
      point[q] = Point(s, k, data.parameters);
      volume[q] = here.volume;
      for (int m = 0; m < n; ++m) {
        const auto column = point[q].column(V{} + t.N[q][m], here.gM[m], b.alpha[m]);
        galerkin[m][q] = column.galerkin;
        strong[m][q] = column.strong;
      }
    });
    for (int a = 0; a < n; ++a) {
      value[a] = V{};  // int N_a
      for (int q = 0; q < n; ++q) value[a] += volume[q] * t.N[q][a];
    }
    for (int a = 0; a < n; ++a) velocity_rows(a);
    pressure_rows(data.parameters.continuity_scale);
  }

 private:
  static V dot(const V (&x)[dim], const V (&y)[dim]) {
    V sum = x[0] * y[0];
    for (int i = 1; i < dim; ++i) sum += x[i] * y[i];
    return sum;
  }

  void velocity_rows(int a) {
    V shape[n], stream[n], by_shape[n][dim][dim];
    V all_by_shape[dim][dim] = {}, by_gradient[dim] = {}, bulk[dim] = {}, viscous[dim] = {}, pressure = {};
    for (int q = 0; q < n; ++q) {
      V weighed[dim];
      for (int i = 0; i < dim; ++i) weighed[i] = volume[q] * gradient[a][i];
      const auto test = point[q].velocity_test(volume[q] * t.N[q][a], weighed);
      shape[q] = test.shape;
      stream[q] = test.stream;
      pressure += test.stream * (point[q].share + point[q].lent) + test.shape * point[q].lent;
      for (int i = 0; i < dim; ++i) {
        by_gradient[i] += test.by_gradient[i];
        bulk[i] += test.bulk[i];
        viscous[i] += test.viscous[i];
        for (int c = 0; c < dim; ++c) {
          by_shape[q][i][c] = test.by_shape[i][c];
          all_by_shape[i][c] += test.by_shape[i][c] * other;
        }
      }
    }
    for (int m = 0; m < n; ++m) {
      const auto& g = gradient[m];
      V diagonal = dot(viscous, g);
      for (int q = 0; q < n; ++q) diagonal += shape[q] * galerkin[m][q] + stream[q] * strong[m][q];
      const V weight = w[a] * value[m];
      for (int i = 0; i < dim; ++i) {
        V* row = matrix + E::velocity_row(a, i) * rows;
        for (int c = 0; c < dim; ++c) {
          V sum = all_by_shape[i][c] + by_shape[m][i][c] * extra + by_gradient[c] * g[i] + bulk[i] * b.alpha[m] * g[c];
          if (i == c) sum += diagonal;
          row[E::velocity_row(m, c)] = sum;
        }
        row[E::pressure_row(m)] = pressure * g[i] - weight * gradient[a][i];
      }
    }
  }

  void pressure_rows(double scale) {
    V from_strong[n] = {}, smeared[dim] = {}, from_pressure = {};
    for (int q = 0; q < n; ++q) {
      const V weight = point[q].pspg * volume[q];
      from_pressure += weight * (point[q].share + point[q].lent);
      for (int m = 0; m < n; ++m) from_strong[m] += weight * strong[m][q];
      for (int c = 0; c < dim; ++c) smeared[c] += weight * point[q].alpha_gradient[c];
    }
    for (int a = 0; a < n; ++a) {
      V by_shape[n][dim], all_by_shape[dim] = {};
      for (int q = 0; q < n; ++q) {
        V weighed[dim];
        for (int i = 0; i < dim; ++i) weighed[i] = volume[q] * gradient[a][i];
        const auto test = point[q].pressure_test(volume[q], weighed);
        for (int c = 0; c < dim; ++c) {
          by_shape[q][c] = test.by_shape[c];
          all_by_shape[c] += test.by_shape[c] * other;
        }
      }
      V* row = matrix + E::pressure_row(a) * rows;
      const V scaled = value[a] * scale;
      for (int m = 0; m < n; ++m) {
        const auto& g = gradient[m];
        const V along = dot(gradient[a], g), carried = scaled * b.alpha[m];
        for (int c = 0; c < dim; ++c)
          row[E::velocity_row(m, c)] = carried * g[c] + all_by_shape[c] + by_shape[m][c] * extra +
                                       gradient[a][c] * from_strong[m] - along * smeared[c];
        row[E::pressure_row(m)] = along * from_pressure;
      }
    }
  }

  const FlowBatch<E, V>& b;
  const FlowTable& t;
  const V (&w)[n];
  V* matrix;
  const double other, extra;  ///< a function at the points of other nodes, and what it has more at its own
  Point point[n];
  V gradient[n][dim];                                   ///< of the functions
  V volume[n], value[n], galerkin[n][n], strong[n][n];  ///< [node][point]
};

}  // namespace silt
