#include "base/nodal_matrix.hpp"

#include <algorithm>

namespace silt {
namespace {

template <int C>
void multiply(const NodalGraph& graph, const double* values, const double* x, double* y) {
  const int rows = graph.mesh.nodes;
  const int *start = graph.row_start.data(), *column = graph.column.data();
  for (int i = 0; i < rows; ++i) {
    double sum[C] = {};
    for (int k = start[i]; k < start[i + 1]; ++k) {
      const double a = values[k];
      const double* z = x + static_cast<size_t>(C) * column[k];
      for (int c = 0; c < C; ++c) sum[c] += a * z[c];
    }
    for (int c = 0; c < C; ++c) y[static_cast<size_t>(C) * i + c] = sum[c];
  }
}

}  // namespace

NodalGraph::NodalGraph(const Mesh& m) : mesh(m) {
  const int n = mesh.nodes_per_cell;
  // Cells around each node, then the sorted distinct nodes of those cells.
  std::vector<int> first(mesh.nodes + 1, 0), around(mesh.cell_nodes.size());
  for (int v : mesh.cell_nodes) ++first[v + 1];
  for (int v = 0; v < mesh.nodes; ++v) first[v + 1] += first[v];
  std::vector<int> next(first.begin(), first.end() - 1);
  for (size_t k = 0; k < mesh.cell_nodes.size(); ++k) around[next[mesh.cell_nodes[k]]++] = static_cast<int>(k / n);
  row_start.assign(1, 0);
  std::vector<int> row;
  for (int v = 0; v < mesh.nodes; ++v) {
    row.assign(1, v);
    for (int k = first[v]; k < first[v + 1]; ++k)
      row.insert(row.end(), &mesh.cell_nodes[static_cast<size_t>(around[k]) * n],
                 &mesh.cell_nodes[static_cast<size_t>(around[k]) * n] + n);
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    column.insert(column.end(), row.begin(), row.end());
    row_start.push_back(static_cast<int>(column.size()));
  }
  const auto place = [this](int i, int j) {
    return static_cast<int>(std::lower_bound(column.begin() + row_start[i], column.begin() + row_start[i + 1], j) -
                            column.begin());
  };
  diagonal.resize(mesh.nodes);
  for (int v = 0; v < mesh.nodes; ++v) diagonal[v] = place(v, v);
  cell_entry.resize(mesh.cell_nodes.size() * n);
  for (int c = 0; c < mesh.cells; ++c) {
    const int* v = &mesh.cell_nodes[static_cast<size_t>(c) * n];
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) cell_entry[(static_cast<size_t>(c) * n + a) * n + b] = place(v[a], v[b]);
  }
}

void NodalMatrix::zero() { std::fill(values.begin(), values.end(), 0.0); }

void NodalMatrix::apply(const double* x, double* y, int components) const {
  switch (components) {
    case 1:
      multiply<1>(graph, values.data(), x, y);
      break;
    case 2:
      multiply<2>(graph, values.data(), x, y);
      break;
    case 3:
      multiply<3>(graph, values.data(), x, y);
      break;
    case 4:
      multiply<4>(graph, values.data(), x, y);
      break;
    case 5:
      multiply<5>(graph, values.data(), x, y);
      break;
    case 6:
      multiply<6>(graph, values.data(), x, y);
      break;
    case 7:
      multiply<7>(graph, values.data(), x, y);
      break;
    case 8:
      multiply<8>(graph, values.data(), x, y);
      break;
    default:
      throw std::logic_error("NodalMatrix::apply takes 1 to 8 components");
  }
  graph.mesh.sum_shared(y, components);
}

std::vector<double> NodalMatrix::diagonal() const {
  std::vector<double> result(graph.mesh.nodes);
  for (int i = 0; i < graph.mesh.nodes; ++i) result[i] = values[graph.diagonal[i]];
  graph.mesh.sum_shared(result.data(), 1);
  return result;
}

MatHandle NodalMatrix::create_petsc() const {
  const Mesh& mesh = graph.mesh;
  std::vector<PetscInt> rows, columns;
  rows.reserve(graph.column.size());
  columns.reserve(graph.column.size());
  for (int i = 0; i < mesh.nodes; ++i)
    for (int k = graph.row_start[i]; k < graph.row_start[i + 1]; ++k) {
      rows.push_back(static_cast<PetscInt>(mesh.node_global[i]));
      columns.push_back(static_cast<PetscInt>(mesh.node_global[graph.column[k]]));
    }
  MatHandle matrix;
  SILT_PETSC(MatCreate(PETSC_COMM_WORLD, matrix.out()));
  SILT_PETSC(MatSetSizes(matrix, mesh.owned_nodes, mesh.owned_nodes, PETSC_DETERMINE, PETSC_DETERMINE));
  SILT_PETSC(MatSetType(matrix, MATAIJ));
  SILT_PETSC(MatSetPreallocationCOO(matrix, static_cast<PetscCount>(rows.size()), rows.data(), columns.data()));
  return matrix;
}

void NodalMatrix::fill_petsc(Mat matrix) const { SILT_PETSC(MatSetValuesCOO(matrix, values.data(), INSERT_VALUES)); }

std::vector<double> lumped_mass(const Mesh& mesh) {
  std::vector<double> mass(mesh.nodes, 0.0);
  const Quadrature rule = quadrature(mesh.cell, 3);
  const int n = mesh.nodes_per_cell;
  for (int c = 0; c < mesh.cells; ++c) {
    const double* x = &mesh.cell_coordinates[3 * static_cast<size_t>(c) * n];
    for (int q = 0; q < rule.points; ++q) {
      double N[8], dN[8][3];
      shape(mesh.cell, rule.point[q].data(), N, dN);
      Mat3 J = Mat3::Zero();
      for (int a = 0; a < n; ++a) J += vec3(x + 3 * a) * vec3(dN[a]).transpose();
      if (mesh.dimension == 2) J(2, 2) = 1;
      const double w = rule.weight[q] * J.determinant();
      for (int a = 0; a < n; ++a) mass[mesh.cell_nodes[static_cast<size_t>(c) * n + a]] += w * N[a];
    }
  }
  mesh.sum_shared(mass.data(), 1);
  return mass;
}

std::vector<double> shortest_edges(const Mesh& mesh) {
  std::vector<double> result(mesh.cells, infinity);
  const bool simplex = mesh.cell == Cell::triangle || mesh.cell == Cell::tetrahedron;
  const int n = mesh.nodes_per_cell;
  for (int c = 0; c < mesh.cells; ++c) {
    const double* x = &mesh.cell_coordinates[3 * static_cast<size_t>(c) * n];
    for (int a = 0; a < n; ++a)
      for (int b = a + 1; b < n; ++b)  // tensor cells: the numbers of an edge's ends differ in one bit
        if (simplex || ((a ^ b) & ((a ^ b) - 1)) == 0)
          result[c] = std::min(result[c], (vec3(x + 3 * a) - vec3(x + 3 * b)).norm());
  }
  return result;
}

void add_stiffness(NodalMatrix& matrix, double factor) {
  const Mesh& mesh = matrix.graph.mesh;
  const Quadrature rule = quadrature(mesh.cell, 2);
  const int n = mesh.nodes_per_cell;
  for (int c = 0; c < mesh.cells; ++c) {
    const double* x = &mesh.cell_coordinates[3 * static_cast<size_t>(c) * n];
    const int* entry = &matrix.graph.cell_entry[static_cast<size_t>(c) * n * n];
    for (int q = 0; q < rule.points; ++q) {
      double N[8], dN[8][3];
      shape(mesh.cell, rule.point[q].data(), N, dN);
      Mat3 J = Mat3::Zero();
      for (int a = 0; a < n; ++a) J += vec3(x + 3 * a) * vec3(dN[a]).transpose();
      if (mesh.dimension == 2) J(2, 2) = 1;
      const Mat3 inverse = J.inverse();
      const double w = factor * rule.weight[q] * J.determinant();
      Vec3 gradient[8];
      for (int a = 0; a < n; ++a) gradient[a] = inverse.transpose() * vec3(dN[a]);
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) matrix.values[entry[a * n + b]] += w * gradient[a].dot(gradient[b]);
    }
  }
}

}  // namespace silt
