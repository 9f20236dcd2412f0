#pragma once
// Included only by the translation units that instantiate it for one instruction set each, like flow_kernel.hpp.
#include "fluid/assembly/flow_batch.hpp"
#include "fluid/transport/transport_data.hpp"

namespace silt {

template <Cell C, int W>
void assemble_transport(const TransportData& d, int first, int count, double* matrix, double* right) {
  using E = FlowElement<C, 1>;
  using V = Lanes<W>;
  constexpr int dim = E::dim, n = E::NP;
  const FlowTable& t = *d.table;
  V x[n][dim] = {}, mass[n] = {}, known[n] = {}, diffusivity[n] = {}, reaction[n] = {}, load[n] = {}, h = {},
    added = {};
  for (int l = 0; l < W; ++l) {
    const long cell = first + (l < count ? l : count - 1);
    h[l] = d.cell_size[cell];
    if (d.cell_diffusivity) added[l] = d.cell_diffusivity[cell];
    for (int a = 0; a < n; ++a) {
      const int node = d.nodes[cell * n + a];
      mass[a][l] = d.mass[node];
      known[a][l] = d.known[node];
      diffusivity[a][l] = d.diffusivity[node];
      reaction[a][l] = d.reaction[node];
      load[a][l] = d.load[node];
      for (int i = 0; i < dim; ++i) x[a][i][l] = d.coordinates[3 * (cell * n + a) + i];
    }
  }
  V K[n][n] = {}, r[n] = {};
  FlowPoint<E, V> at(t, x);
  for (int q = 0; q < t.points; ++q) {
    at.move(t, q, x);
    double carried[dim][W];
    for (int l = 0; l < W; ++l) {
      const long cell = first + (l < count ? l : count - 1);
      for (int i = 0; i < dim; ++i) carried[i][l] = d.carried * d.flux[3 * (cell * t.points + q) + i];
    }
    V flux[dim];
    for (int i = 0; i < dim; ++i) __builtin_memcpy(&flux[i], carried[i], sizeof(V));
    V k = {}, D = added, s = {}, f = {};
    for (int a = 0; a < n; ++a) {
      k += known[a] * t.M[q][a];
      D += diffusivity[a] * t.M[q][a];
      s += reaction[a] * t.M[q][a];
      f += load[a] * t.M[q][a];
    }
    V speed2 = {}, along[n];
    for (int i = 0; i < dim; ++i) speed2 += flux[i] * flux[i];
    for (int a = 0; a < n; ++a) {
      along[a] = flux[0] * at.gM[a][0];
      for (int i = 1; i < dim; ++i) along[a] += flux[i] * at.gM[a][i];
    }
    const V convection = 2.0 / h, diffusion = 12.0 * D / (h * h);
    const V inverse2 = speed2 * convection * convection + diffusion * diffusion + s * s;
    V tau = {};
    for (int l = 0; l < W; ++l) tau[l] = inverse2[l] > 0 ? d.supg / __builtin_sqrt(inverse2[l]) : 0;
    for (int a = 0; a < n; ++a) {
      const V N = at.volume * t.M[q][a], weight = at.volume * tau * along[a], carry = at.volume * along[a];
      r[a] -= N * k + weight * (k - f);
      // - int grad N_a.F (T - T_a): constants are kept whatever the flux (E3).
      K[a][a] += carry;
      for (int b = 0; b < n; ++b) {
        V gradients = at.gM[a][0] * at.gM[b][0];
        for (int i = 1; i < dim; ++i) gradients += at.gM[a][i] * at.gM[b][i];
        K[a][b] += N * mass[b] * t.M[q][b] + at.volume * D * gradients - carry * t.M[q][b] +
                   weight * ((mass[b] + s) * t.M[q][b] + along[b]);
      }
    }
  }
  for (int a = 0; a < n; ++a)
    for (int l = 0; l < W; ++l) {
      right[l * n + a] = r[a][l];
      for (int b = 0; b < n; ++b) matrix[(l * n + a) * n + b] = K[a][b][l];
    }
}

template <int W>
TransportKernel transport_kernel_of(Cell cell) {
  switch (cell) {
    case Cell::triangle:
      return {W, &assemble_transport<Cell::triangle, W>};
    case Cell::quadrilateral:
      return {W, &assemble_transport<Cell::quadrilateral, W>};
    case Cell::tetrahedron:
      return {W, &assemble_transport<Cell::tetrahedron, W>};
    default:
      return {W, &assemble_transport<Cell::hexahedron, W>};
  }
}

TransportKernel transport_kernel_sse2(Cell cell);
TransportKernel transport_kernel_avx2(Cell cell);
TransportKernel transport_kernel_avx512(Cell cell);

}  // namespace silt
