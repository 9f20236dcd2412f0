#pragma once
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "fluid/compressible/gas_kernel.hpp"

namespace silt {

/// What is held fixed while Newton iterates: the test function's part that is carried along (A_i tau), and the
/// viscosity that captures discontinuities. [cells]
struct GasFrozen {
  std::vector<double> carried;  ///< [cells][dim][size][size]
  std::vector<double> viscosity;
  std::vector<double> normal;       ///< [cells][dim] n; along n the viscosity is less by |n|^2: viscosity I - n n
  std::vector<double> first_order;  ///< its bound
  bool lumped = false;              ///< mass at the nodes

  /// Makes the step one of first order, whose solution has no new extrema: no streamline terms, mass at the nodes,
  /// `factor` times the first-order viscosity everywhere.
  void make_first_order(double factor) {
    std::fill(carried.begin(), carried.end(), 0.0);
    for (size_t c = 0; c < viscosity.size(); ++c) viscosity[c] = factor * first_order[c];
    std::fill(normal.begin(), normal.end(), 0.0);
    lumped = true;
  }
};

/// Factors of the shock capturing.
struct CapturingFactors {
  double capturing = 1;  ///< of the residual-based viscosity; 0: none
  double sensor = 1;     ///< of the viscosity on strong expansions; 0: none
  double shocks = 0;     ///< of the viscosity on strong compressions; 0: none
};

/// Finds what is held fixed during a step from the state at its start (compressible.md, C13 to C16): `carried`
/// [dim][size][size] = A_i tau, and returns the capturing viscosity, m times the unit of speed, what it lacks along the
/// normal of a shock (GasFrozen::normal), and its bound, that of a first-order upwind scheme. cell.rate and cell.known
/// give the rate of change in the residual; `step_rate` is the factor of U^{n+1} in the coming step.
template <Cell C>
double freeze_cell(const GasCell<C>& cell, const GasLaw& gas, const FlowTable& table, const CapturingFactors& factors,
                   double step_rate, double* carried, double* normal, double& first_order) {
  constexpr int dim = GasCell<C>::dim, nodes = GasCell<C>::nodes, size = dim + 2;
  using Matrix = Eigen::Matrix<double, size, size, Eigen::RowMajor>;
  const GasNodes<C> at(cell, gas);
  // Means over the cell: state and gradients by averaging the points (the centroid's on simplices).
  GasState<double, dim> mean{};
  double g[nodes][dim] = {}, total = 0, speed_gradient = 0, radius = 0, residual2 = 0, gradient2 = 0;
  for (int a = 0; a < nodes; ++a) {
    mean.p += cell.state[a].p / nodes;
    mean.T += cell.state[a].T / nodes;
    for (int i = 0; i < dim; ++i) mean.u[i] += cell.state[a].u[i] / nodes;
  }
  const double rho = mean.density(), k = mean.kinetic(), sound = std::sqrt(gas.gamma * mean.T);
  const auto entropy_norm = [&](const double* V) {
    const double drho = V[0];
    double du2 = 0, work = 0;
    for (int i = 0; i < dim; ++i) {
      const double du = (V[1 + i] - mean.u[i] * V[0]) / rho;
      du2 += du * du;
      work += mean.u[i] * V[1 + i];
    }
    const double dp = (gas.gamma - 1) * (V[dim + 1] - work + k * V[0]), dT = (dp - mean.T * drho) / rho;
    return rho * (drho * drho / (rho * rho) + gas.cv() * dT * dT / (mean.T * mean.T) + du2 / mean.T);
  };
  GasPoint<C> point;
  for (int q = 0; q < table.points; ++q) {
    point.map(cell, table.dM[q], table.M[q], table.weight[q]);
    const double w = table.weight[q];
    total += w;
    radius += w * point.radius;
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < dim; ++i) g[a][i] += w * point.g[a][i];
    double R[size];
    strong_residual<C, double>(cell, at, point, table.M[q], R);
    residual2 += w * entropy_norm(R);
    for (int i = 0; i < dim; ++i) {
      double V[size] = {};
      for (int a = 0; a < nodes; ++a)
        for (int l = 0; l < size; ++l) V[l] += point.g[a][i] * at.U[a][l];
      gradient2 += w * entropy_norm(V);
    }
  }
  radius /= total;
  for (auto& row : g)
    for (double& v : row) v /= total;

  // tau^-1 = 2 c0 I + sum_a |A.grad N_a| + 4 nu sum_a |grad N_a|^2 I                                        (C14)
  double squares = 0;
  for (const auto& row : g)
    for (double v : row) squares += v * v;
  const double mu = gas.mu(mean.T), conductivity = mu * gas.cp() / gas.prandtl + cell.eddy_conductivity;
  const double nu = std::max(4.0 / 3 * (mu + cell.eddy_viscosity), conductivity / gas.cv()) / rho;
  Matrix inverse = (2 * step_rate + 4 * nu * squares) * Matrix::Identity();
  for (int a = 0; a < nodes; ++a) {
    double n[3] = {}, length = 0;
    for (int i = 0; i < dim; ++i) length += g[a][i] * g[a][i];
    length = std::sqrt(length);
    if (length == 0) continue;
    for (int i = 0; i < dim; ++i) n[i] = g[a][i] / length;
    for (int l = 0; l < size; ++l) {
      double z[size] = {}, out[size];
      z[l] = 1;
      absolute_flux<double, dim>(gas, mean, n, z, 0.05, out);
      for (int m = 0; m < size; ++m) inverse(m, l) += length * out[m];
    }
  }
  const Matrix tau = inverse.inverse();
  Matrix slope;
  double A[size][size];
  conserved_slope(gas, mean, A);
  for (int m = 0; m < size; ++m)
    for (int l = 0; l < size; ++l) slope(m, l) = A[m][l];
  const Matrix back = slope.inverse() * tau;  // d(p, u, T)/d(conserved) tau
  for (int i = 0; i < dim; ++i) {
    flux_slope(gas, mean, i, A);
    for (int m = 0; m < size; ++m)
      for (int l = 0; l < size; ++l) slope(m, l) = A[m][l];
    const Matrix result = slope * back;
    for (int m = 0; m < size; ++m)
      for (int l = 0; l < size; ++l) carried[(i * size + m) * size + l] = result(m, l);
  }

  // Element length along the density gradient.
  double j[dim] = {}, steep = 0, density[nodes];
  for (int a = 0; a < nodes; ++a) {
    density[a] = cell.state[a].density();
    for (int i = 0; i < dim; ++i) j[i] += g[a][i] * density[a];
  }
  for (double v : j) steep += v * v;
  steep = std::sqrt(steep);
  double h = 2 / std::sqrt(squares * 2 / nodes);
  if (steep * h > 1e-10 * rho) {
    for (int a = 0; a < nodes; ++a) {
      double along = 0;
      for (int i = 0; i < dim; ++i) along += j[i] / steep * g[a][i];
      speed_gradient += std::abs(along);
    }
    h = 2 / speed_gradient;
  }
  first_order = 0.5 * h * (std::sqrt(2 * k) + sound);  // (C16)
  double viscosity = factors.capturing * 0.5 * h * std::sqrt(residual2 / (gradient2 + 1e-12 * total / (h * h)));  // C15
  // The residual lacks the viscous terms: what they leave in it is of the size of the gas's own viscosity.
  viscosity = std::min(std::max(viscosity - nu, 0.0), first_order);

  double divergence = cell.axisymmetric ? mean.u[1] / radius : 0;
  double low[2] = {1e300, 1e300}, high[2] = {0, 0};
  for (int a = 0; a < nodes; ++a) {
    for (int i = 0; i < dim; ++i) divergence += g[a][i] * cell.state[a].u[i];
    low[0] = std::min(low[0], cell.state[a].p), high[0] = std::max(high[0], cell.state[a].p);
    low[1] = std::min(low[1], density[a]), high[1] = std::max(high[1], density[a]);
  }
  const double change[2] = {(high[0] - low[0]) / (high[0] + low[0]), (high[1] - low[1]) / (high[1] + low[1])};
  const double ratio = std::max(change[0], change[1]);
  const auto ramp = [](double x) { return x <= 0 ? 0.0 : x >= 1 ? 1.0 : x * x * (3 - 2 * x); };

  // Layers that only shear are no shocks: where pressure and density hardly change within a cell, only a compression
  // that outweighs the vorticity is captured (C15a).
  double vorticity2 = 0;
  for (int i = 0; i < dim; ++i)
    for (int l = 0; l < i; ++l) {
      double turning = 0;
      for (int a = 0; a < nodes; ++a) turning += g[a][l] * cell.state[a].u[i] - g[a][i] * cell.state[a].u[l];
      vorticity2 += turning * turning;
    }
  const double least = 1e-3 * sound / h, compression = std::min(divergence, 0.0);
  const double ducros = compression * compression / (divergence * divergence + vorticity2 + least * least);
  viscosity *=
      std::max({ramp((change[0] - 0.002) / 0.008), ramp((change[1] - 0.05) / 0.1), ramp((ducros - 0.1) / 0.4)});

  // First-order viscosity on strong expansions (nozzle lips), where nothing else keeps the pressure positive.
  const double share =
      divergence > 0 ? factors.sensor * ramp((ratio - 0.4) / 0.4) : factors.shocks * ramp((ratio - 0.1) / 0.3);
  const double along = std::min(viscosity, first_order);
  viscosity = std::min(std::max(viscosity, first_order * share), first_order);
  // Of a shock's only the part within its plane is wanted: it is what keeps shocks along mesh lines from buckling, and
  // along the normal it would make them thick.
  const bool shock = divergence <= 0 && steep * h > 1e-10 * rho;
  for (int i = 0; i < dim; ++i) normal[i] = shock ? std::sqrt(viscosity - along) * j[i] / steep : 0.0;
  return viscosity;
}

}  // namespace silt
