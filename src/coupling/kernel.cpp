#include "coupling/kernel.hpp"

#include <algorithm>

namespace silt {
namespace {

template <int C>
void scatter(const Mesh& mesh, const std::vector<int>& cell, const std::vector<double>& weight, const double* q,
             double* b) {
  const int n = mesh.nodes_per_cell;
  for (std::size_t p = 0; p < cell.size(); ++p) {
    const int* node = &mesh.cell_nodes[static_cast<std::size_t>(cell[p]) * n];
    const double* w = &weight[p * n];
    for (int a = 0; a < n; ++a) {
      double* target = b + static_cast<std::size_t>(C) * node[a];
      for (int c = 0; c < C; ++c) target[c] += w[a] * q[C * p + c];
    }
  }
}

template <int C>
void gather(const Mesh& mesh, const std::vector<int>& cell, const std::vector<double>& weight, const double* f,
            double* v) {
  const int n = mesh.nodes_per_cell;
  for (std::size_t p = 0; p < cell.size(); ++p) {
    const int* node = &mesh.cell_nodes[static_cast<std::size_t>(cell[p]) * n];
    const double* w = &weight[p * n];
    double sum[C] = {};
    for (int a = 0; a < n; ++a) {
      const double* source = f + static_cast<std::size_t>(C) * node[a];
      for (int c = 0; c < C; ++c) sum[c] += w[a] * source[c];
    }
    for (int c = 0; c < C; ++c) v[C * p + c] = sum[c];
  }
}

}  // namespace

void Kernel::resize(int count) {
  cell_.resize(count);
  weight_.resize(static_cast<std::size_t>(count) * mesh_.nodes_per_cell);
}

void Kernel::place(int p, int cell, const double* xi) {
  double N[8], dN[8][3];
  shape(mesh_.cell, xi, N, dN);
  cell_[p] = cell;
  std::copy(N, N + mesh_.nodes_per_cell, &weight_[static_cast<std::size_t>(p) * mesh_.nodes_per_cell]);
}

void Kernel::deposit(std::span<const double> quantities, std::span<double> nodal, int components) const {
  std::fill(nodal.begin(), nodal.end(), 0.0);
  const double* q = quantities.data();
  double* b = nodal.data();
  switch (components) {
    case 1:
      scatter<1>(mesh_, cell_, weight_, q, b);
      break;
    case 2:
      scatter<2>(mesh_, cell_, weight_, q, b);
      break;
    case 3:
      scatter<3>(mesh_, cell_, weight_, q, b);
      break;
    case 4:
      scatter<4>(mesh_, cell_, weight_, q, b);
      break;
    case 5:
      scatter<5>(mesh_, cell_, weight_, q, b);
      break;
    case 6:
      scatter<6>(mesh_, cell_, weight_, q, b);
      break;
    default:
      throw std::logic_error("Kernel::deposit takes 1 to 6 components");
  }
  mesh_.sum_shared(b, components);
}

void Kernel::sample(std::span<const double> nodal, std::span<double> values, int components) const {
  const double* f = nodal.data();
  double* v = values.data();
  switch (components) {
    case 1:
      gather<1>(mesh_, cell_, weight_, f, v);
      break;
    case 2:
      gather<2>(mesh_, cell_, weight_, f, v);
      break;
    case 3:
      gather<3>(mesh_, cell_, weight_, f, v);
      break;
    case 4:
      gather<4>(mesh_, cell_, weight_, f, v);
      break;
    case 5:
      gather<5>(mesh_, cell_, weight_, f, v);
      break;
    case 6:
      gather<6>(mesh_, cell_, weight_, f, v);
      break;
    case 9:
      gather<9>(mesh_, cell_, weight_, f, v);
      break;
    default:
      throw std::logic_error("Kernel::sample takes 1 to 6 components, or 9");
  }
}

}  // namespace silt
