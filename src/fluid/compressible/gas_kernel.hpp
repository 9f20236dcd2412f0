// The element loop, for one number (double) or for a pack of lanes, one cell a lane. In the units that are compiled for
// one instruction set only packs are used, so that no code for a newer machine can replace another's.
#pragma once
#include "fluid/assembly/flow_table.hpp"
#include "fluid/assembly/inverse.hpp"
#include "fluid/compressible/gas.hpp"

namespace silt {

/// What a cell of the compressible equations reads, gathered; in the units of GasLaw. Compressible.md names the terms.
template <Cell C, class V = double>
struct GasCell {
  static constexpr int dim = cell_dimension(C), nodes = cell_nodes(C), size = dim + 2, rows = nodes * size;
  V x[nodes][dim];
  GasState<V, dim> state[nodes];
  V alpha[nodes], alpha_rate[nodes];
  V known[nodes][size];   ///< history of the rate of change
  V source[nodes][size];  ///< given, per volume: mass, momentum (which does work), heat
  double rate = 0;        ///< factor of U^{n+1} in the rate of change
  double gravity[3] = {};
  bool axisymmetric = false;  ///< y is the distance from the axis
  bool porous = true;         ///< false: alpha is 1 everywhere and at rest
  bool turbulent = false;
  bool lumped = false;                      ///< mass at the nodes
  V eddy_viscosity{}, eddy_conductivity{};  ///< of the turbulence in the cell; C17
};

/// One quadrature point of a cell: shape gradients, volume (times radius).
template <Cell C, class V = double>
struct GasPoint {
  static constexpr int dim = cell_dimension(C), nodes = cell_nodes(C);
  V g[nodes][dim], volume, radius;

  void map(const GasCell<C, V>& cell, const double (*dM)[3], const double* M, double weight) {
    V J[dim][dim] = {}, inverse[dim][dim];
    radius = V{};
    for (int a = 0; a < nodes; ++a) {
      radius += M[a] * cell.x[a][1];
      for (int i = 0; i < dim; ++i)
        for (int d = 0; d < dim; ++d) J[i][d] += cell.x[a][i] * dM[a][d];
    }
    volume = invert(J, inverse) * weight;
    if (cell.axisymmetric) volume *= radius;
    for (int a = 0; a < nodes; ++a)
      for (int j = 0; j < dim; ++j) {
        g[a][j] = inverse[0][j] * dM[a][0];
        for (int d = 1; d < dim; ++d) g[a][j] += inverse[d][j] * dM[a][d];
      }
  }
};

/// Nodal conserved quantities, fluxes and rates of change less the sources, times the void fraction.
template <Cell C, class V = double>
struct GasNodes {
  static constexpr int dim = cell_dimension(C), nodes = cell_nodes(C), size = dim + 2;
  V U[nodes][size], F[nodes][dim][size], rate[nodes][size];

  GasNodes(const GasCell<C, V>& cell, const GasLaw& gas) {
    for (int a = 0; a < nodes; ++a) {
      cell.state[a].conserved(gas, U[a]);
      for (int i = 0; i < dim; ++i) {
        double n[3] = {};
        n[i] = 1;
        cell.state[a].flux(gas, n, F[a][i]);
        for (V& f : F[a][i]) f *= cell.alpha[a];
      }
      for (int k = 0; k < size; ++k) {
        U[a][k] *= cell.alpha[a];
        rate[a][k] = cell.rate * U[a][k] + cell.known[a][k] - cell.source[a][k];
      }
      for (int i = 0; i < dim; ++i) {
        rate[a][1 + i] -= cell.gravity[i] * U[a][0];
        rate[a][dim + 1] -= cell.gravity[i] * U[a][1 + i] + cell.source[a][1 + i] * cell.state[a].u[i];
      }
    }
  }
};

/// The conservative residual at a point without viscous terms (C6): rate + div F + 1/r terms - sources.
template <Cell C, class V>
void strong_residual(const GasCell<C, V>& cell, const GasNodes<C, V>& at, const GasPoint<C, V>& point, const double* M,
                     V (&R)[cell_dimension(C) + 2]) {
  constexpr int dim = GasCell<C>::dim, nodes = GasCell<C>::nodes, size = dim + 2;
  V p{}, alpha_rate{}, slope[dim] = {};
  for (V& r : R) r = V{};
  for (int a = 0; a < nodes; ++a) {
    p += M[a] * cell.state[a].p;
    alpha_rate += M[a] * cell.alpha_rate[a];
    for (int i = 0; i < dim; ++i) slope[i] += point.g[a][i] * cell.alpha[a];
    for (int k = 0; k < size; ++k) {
      R[k] += M[a] * at.rate[a][k];
      for (int i = 0; i < dim; ++i) R[k] += point.g[a][i] * at.F[a][i][k];
      if (cell.axisymmetric) {
        V radial = at.F[a][1][k];
        if (k == 2) radial -= cell.alpha[a] * cell.state[a].p;
        R[k] += M[a] * radial / point.radius;
      }
    }
  }
  for (int i = 0; i < dim; ++i) R[1 + i] -= p * slope[i];
  R[dim + 1] += p * alpha_rate;
}

/// Residual [rows] and, when not null, Jacobian [rows][rows] of a cell.
template <Cell C, class V>
void gas_cell(const GasCell<C, V>& cell, const GasLaw& gas, const FlowTable& table, const V* carried, V capturing,
              const V* normal, V* residual, V* matrix) {
  constexpr int dim = GasCell<C>::dim, nodes = GasCell<C>::nodes, size = dim + 2, rows = nodes * size;
  const bool viscous = gas.viscosity > 0 || cell.turbulent;
  const GasNodes<C, V> at(cell, gas);
  const auto P = [&](int i, int k, int l) { return carried[(i * size + k) * size + l]; };
  for (int k = 0; k < rows; ++k) residual[k] = V{};
  // Jacobian of the terms linear in nodal U and F, as weights of their slopes: [a][b] of size x size each.
  V mass[nodes][nodes] = {}, spread[nodes][nodes] = {}, testU[nodes][nodes][dim] = {}, ofF[nodes][nodes][dim] = {},
    testF[nodes][nodes][dim][dim] = {}, testR[nodes][nodes][dim] = {};
  if (matrix)
    for (int k = 0; k < rows * rows; ++k) matrix[k] = V{};
  const auto K = [&](int a, int k, int b, int l) -> V& { return matrix[(a * size + k) * rows + b * size + l]; };
  GasPoint<C, V> point;
  for (int q = 0; q < table.points; ++q) {
    const double* M = table.M[q];
    point.map(cell, table.dM[q], M, table.weight[q]);
    const V w = point.volume;
    V R[size];
    strong_residual<C, V>(cell, at, point, M, R);
    // State at the point.
    V p{}, T{}, u[dim] = {}, gu[dim][dim] = {}, gT[dim] = {}, alpha{}, alpha_rate{}, slope[dim] = {};
    V rate[size] = {}, F[dim][size] = {}, gU[dim][size] = {};
    for (int a = 0; a < nodes; ++a) {
      const auto& s = cell.state[a];
      p += M[a] * s.p, T += M[a] * s.T, alpha += M[a] * cell.alpha[a], alpha_rate += M[a] * cell.alpha_rate[a];
      for (int i = 0; i < dim; ++i) {
        u[i] += M[a] * s.u[i];
        gT[i] += point.g[a][i] * s.T;
        slope[i] += point.g[a][i] * cell.alpha[a];
        for (int j = 0; j < dim; ++j) gu[i][j] += point.g[a][j] * s.u[i];
        for (int k = 0; k < size; ++k) {
          F[i][k] += M[a] * at.F[a][i][k];
          gU[i][k] += point.g[a][i] * at.U[a][k];
        }
      }
      for (int k = 0; k < size; ++k) rate[k] += M[a] * at.rate[a][k];
    }
    // What captures discontinuities: nu grad U - n (n.grad U).
    for (int k = 0; k < size; ++k) {
      V across{};
      for (int i = 0; i < dim; ++i) across += normal[i] * gU[i][k];
      for (int i = 0; i < dim; ++i) gU[i][k] = capturing * gU[i][k] - normal[i] * across;
    }
    // Viscous stress and heat flux; the stress tau is counted over mu.
    V mu{}, conductivity{}, stiff{}, hoop{}, tau_hoop{}, tau[dim][dim] = {}, flux[dim][size] = {};
    if (viscous) {
      const V molecular = gas.mu(T);
      mu = alpha * (molecular + cell.eddy_viscosity);
      conductivity = alpha * (molecular * (gas.cp() / gas.prandtl) + cell.eddy_conductivity);
      stiff = alpha * gas.mu_slope(T);
      if (cell.axisymmetric) hoop = u[1] / point.radius;
      V divergence = hoop;
      for (int i = 0; i < dim; ++i) divergence += gu[i][i];
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) {
          tau[i][j] = gu[i][j] + gu[j][i];
          if (i == j) tau[i][j] -= 2.0 / 3 * divergence;
        }
      tau_hoop = 2.0 * hoop - 2.0 / 3 * divergence;
      for (int j = 0; j < dim; ++j) {
        for (int i = 0; i < dim; ++i) {
          flux[j][1 + i] = mu * tau[i][j];
          flux[j][dim + 1] += mu * u[i] * tau[i][j];
        }
        flux[j][dim + 1] += conductivity * gT[j];
      }
    }
    for (int a = 0; a < nodes; ++a) {
      V* r = residual + a * size;
      for (int k = 0; k < size; ++k) {
        V sum = M[a] * (cell.lumped ? at.rate[a][k] : rate[k]);
        for (int i = 0; i < dim; ++i) sum += point.g[a][i] * (flux[i][k] - F[i][k] + gU[i][k]);
        for (int i = 0; i < dim; ++i)
          for (int l = 0; l < size; ++l) sum += point.g[a][i] * P(i, k, l) * R[l];
        r[k] += w * sum;
      }
      for (int i = 0; i < dim; ++i) r[1 + i] -= w * M[a] * p * slope[i];
      r[dim + 1] += w * M[a] * p * alpha_rate;
      if (cell.axisymmetric) r[2] -= w * M[a] * (alpha * p - mu * tau_hoop) / point.radius;
    }
    if (!matrix) continue;
    for (int a = 0; a < nodes; ++a)
      for (int b = 0; b < nodes; ++b) {
        V gradients{};
        for (int i = 0; i < dim; ++i) gradients += point.g[a][i] * point.g[b][i];
        if (!cell.lumped)
          mass[a][b] += w * M[a] * M[b];
        else if (a == b)
          mass[a][a] += w * M[a];
        V one{}, other{};
        for (int i = 0; i < dim; ++i) one += normal[i] * point.g[a][i], other += normal[i] * point.g[b][i];
        spread[a][b] += w * (capturing * gradients - one * other);
        for (int i = 0; i < dim; ++i) {
          ofF[a][b][i] -= w * point.g[a][i] * M[b];
          testU[a][b][i] += w * point.g[a][i] * M[b];
          for (int j = 0; j < dim; ++j) testF[a][b][i][j] += w * point.g[a][i] * point.g[b][j];
          if (cell.axisymmetric) testR[a][b][i] += w * point.g[a][i] * M[b] / point.radius;
          // What the carried test function sees of -p grad alpha + ... in the momentum and energy rows.
          for (int l = 0; cell.porous && l < size; ++l) {
            V sum = P(i, l, dim + 1) * alpha_rate;
            for (int j = 0; j < dim; ++j) sum -= P(i, l, 1 + j) * slope[j];
            K(a, l, b, 0) += w * point.g[a][i] * M[b] * sum;
          }
        }
        for (int i = 0; cell.porous && i < dim; ++i) K(a, 1 + i, b, 0) -= w * M[a] * M[b] * slope[i];
        if (cell.porous) K(a, dim + 1, b, 0) += w * M[a] * M[b] * alpha_rate;
        if (cell.axisymmetric) K(a, 2, b, 0) -= w * M[a] * M[b] * alpha / point.radius;
        if (!viscous) continue;
        const V* ga = point.g[a];
        const V* gb = point.g[b];
        const V along = gradients;
        for (int j = 0; j < dim; ++j) {  // derivative with respect to u_j of node b
          V hoop_b{};
          if (cell.axisymmetric && j == 1) hoop_b = M[b] / point.radius;
          const V div_b = gb[j] + hoop_b;
          V work{};
          for (int i = 0; i < dim; ++i) {
            // sum_k ga_k d tau_ik
            V d = ga[j] * gb[i] - 2.0 / 3 * ga[i] * div_b;
            if (i == j) d += along;
            K(a, 1 + i, b, 1 + j) += w * mu * d;
            work += u[i] * d;
          }
          V carry{};
          for (int k = 0; k < dim; ++k) carry += ga[k] * tau[j][k];
          K(a, dim + 1, b, 1 + j) += w * mu * (work + M[b] * carry);
          if (cell.axisymmetric) K(a, 2, b, 1 + j) += w * M[a] * mu * (2.0 * hoop_b - 2.0 / 3 * div_b) / point.radius;
        }
        for (int i = 0; i < dim; ++i) {
          V stress{};
          for (int k = 0; k < dim; ++k) stress += ga[k] * tau[i][k];
          K(a, 1 + i, b, dim + 1) += w * stiff * M[b] * stress;
          K(a, dim + 1, b, dim + 1) += w * stiff * M[b] * u[i] * stress;
          K(a, dim + 1, b, dim + 1) += w * stiff * (gas.cp() / gas.prandtl * M[b]) * ga[i] * gT[i];
        }
        K(a, dim + 1, b, dim + 1) += w * conductivity * along;
        if (cell.axisymmetric) K(a, 2, b, dim + 1) += w * M[a] * stiff * M[b] * tau_hoop / point.radius;
      }
  }
  if (!matrix) return;
  for (int b = 0; b < nodes; ++b) {
    V A0[size][size], A[dim][size][size], B[size][size];  // slopes of U, F and the rate
    conserved_slope(gas, cell.state[b], A0);
    for (int i = 0; i < dim; ++i) flux_slope(gas, cell.state[b], i, A[i]);
    for (int k = 0; k < size; ++k)
      for (int l = 0; l < size; ++l) {
        A0[k][l] *= cell.alpha[b];
        for (int i = 0; i < dim; ++i) A[i][k][l] *= cell.alpha[b];
      }
    for (int l = 0; l < size; ++l) {
      for (int k = 0; k < size; ++k) B[k][l] = cell.rate * A0[k][l];
      for (int i = 0; i < dim; ++i) {
        B[1 + i][l] -= cell.gravity[i] * A0[0][l];
        B[dim + 1][l] -= cell.gravity[i] * A0[1 + i][l];
      }
    }
    for (int i = 0; i < dim; ++i) B[dim + 1][1 + i] -= cell.source[b][1 + i];
    for (int a = 0; a < nodes; ++a) {
      V X[dim][size][size];
      for (int i = 0; i < dim; ++i)
        for (int k = 0; k < size; ++k)
          for (int l = 0; l < size; ++l) {
            V sum = testU[a][b][i] * B[k][l];
            for (int j = 0; j < dim; ++j) sum += testF[a][b][i][j] * A[j][k][l];
            if (cell.axisymmetric) {
              V radial = A[1][k][l];
              if (k == 2 && l == 0) radial -= cell.alpha[b];
              sum += testR[a][b][i] * radial;
            }
            X[i][k][l] = sum;
          }
      for (int k = 0; k < size; ++k)
        for (int l = 0; l < size; ++l) {
          V sum = mass[a][b] * B[k][l] + spread[a][b] * A0[k][l];
          for (int i = 0; i < dim; ++i) {
            sum += ofF[a][b][i] * A[i][k][l];
            for (int m = 0; m < size; ++m) sum += P(i, k, m) * X[i][m][l];
          }
          K(a, k, b, l) += sum;
        }
    }
  }
}

}  // namespace silt
