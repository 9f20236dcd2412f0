#include "coupling/filter.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace silt {
namespace {

constexpr int most_passes = 2000;

bool is_simplex(Cell cell) { return cell == Cell::triangle || cell == Cell::tetrahedron; }

Mat3 jacobian_at(const Mesh& mesh, int cell, const double* xi, double (*dN)[3]) {
  double N[8];
  shape(mesh.cell, xi, N, dN);
  Mat3 jacobian = Mat3::Zero();
  const double* X = &mesh.cell_coordinates[3 * static_cast<std::size_t>(mesh.nodes_per_cell) * cell];
  for (int a = 0; a < mesh.nodes_per_cell; ++a) jacobian += vec3(X + 3 * a) * vec3(dN[a]).transpose();
  if (mesh.dimension == 2) jacobian(2, 2) = 1;
  return jacobian;
}

/// int grad N_a . D grad N_b over a cell, integrated at the corners: on boxes that couples only the ends of edges, so
/// all couplings are negative whatever the cell's proportions. On other cells positive couplings are left out; symmetry
/// and zero row sums stay.
void cell_matrix(const Mesh& mesh, int cell, const Mat3& diffusivity, double matrix[8][8]) {
  const int n = mesh.nodes_per_cell;
  const bool simplex = is_simplex(mesh.cell);
  for (int a = 0; a < n; ++a) std::fill(matrix[a], matrix[a] + n, 0.0);
  const double volume_of_reference = simplex ? (mesh.dimension == 2 ? 1.0 / 2 : 1.0 / 6) : 1.0;
  const int points = simplex ? 1 : n;
  for (int q = 0; q < points; ++q) {
    const double xi[3] = {static_cast<double>(q & 1), static_cast<double>(q >> 1 & 1), static_cast<double>(q >> 2)};
    double dN[8][3];
    const Mat3 jacobian = jacobian_at(mesh, cell, xi, dN);
    const Mat3 inverse = jacobian.inverse();
    const double weight = std::max(jacobian.determinant(), 0.0) * volume_of_reference / points;
    Vec3 gradient[8];
    for (int a = 0; a < n; ++a) gradient[a] = inverse.transpose() * vec3(dN[a]);
    for (int a = 0; a < n; ++a) {
      const Vec3 flux = weight * (diffusivity * gradient[a]);
      for (int b = 0; b < n; ++b) matrix[a][b] += flux.dot(gradient[b]);
    }
  }
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < a; ++b) {
      const double coupling = std::min(0.5 * (matrix[a][b] + matrix[b][a]), 0.0);
      matrix[a][b] = matrix[b][a] = std::abs(coupling) < 1e-13 * std::abs(matrix[a][a]) ? 0.0 : coupling;
    }
  }
}

template <int C>
void differences(const std::vector<int>& start, const std::vector<int>& column, const std::vector<double>& entry,
                 const double* x, double* y) {
  const int rows = static_cast<int>(start.size()) - 1;
  for (int i = 0; i < rows; ++i) {
    const double* xi = x + static_cast<std::size_t>(C) * i;
    double sum[C] = {};
    for (int k = start[i]; k < start[i + 1]; ++k) {
      const double a = entry[k];
      const double* xj = x + static_cast<std::size_t>(C) * column[k];
      for (int c = 0; c < C; ++c) sum[c] += a * (xj[c] - xi[c]);
    }
    for (int c = 0; c < C; ++c) y[static_cast<std::size_t>(C) * i + c] = sum[c];
  }
}

}  // namespace

Filter::Filter(const Mesh& mesh, const std::vector<double>& mass, const std::function<Mat3(int)>& diffusivity)
    : mesh_(mesh) {
  const NodalGraph graph(mesh);
  std::vector<double> full(graph.column.size(), 0.0);
  const int n = mesh.nodes_per_cell;
  for (int c = 0; c < mesh.cells; ++c) {
    double matrix[8][8];
    cell_matrix(mesh, c, diffusivity(c), matrix);
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) {
        if (a != b) full[graph.cell_entry[(static_cast<std::size_t>(c) * n + a) * n + b]] += matrix[a][b];
      }
    }
  }
  // Row i of -K/M without the diagonal; the diagonal is minus the sum, which differences() builds in, so constants stay
  // to the bit.
  std::vector<double> rate(mesh.nodes, 0.0);
  row_start_.assign(1, 0);
  for (int i = 0; i < mesh.nodes; ++i) {
    for (int k = graph.row_start[i]; k < graph.row_start[i + 1]; ++k) {
      if (full[k] == 0 || graph.column[k] == i) continue;
      column_.push_back(graph.column[k]);
      entry_.push_back(-full[k] / mass[i]);
      rate[i] += entry_.back();
    }
    row_start_.push_back(static_cast<int>(column_.size()));
  }
  mesh.sum_shared(rate.data(), 1);
  double most = 0;
  for (const double r : rate) most = std::max(most, r);
  most = mpi_max(most);
  if (most == 0) return;
  // Each factor stays a weighted mean while t <= 1 / most. One of half that length removes what alternates from node to
  // node.
  const double passes = std::ceil(most + 0.5 - 1e-9);
  if (passes > most_passes) {
    throw UserError(
        fmt::format("coupling_filter_length: the filter is so wide against the smallest cells that it takes {:.0f} "
                    "passes, at most {} are allowed",
                    passes, most_passes));
  }
  factors_.assign(static_cast<std::size_t>(passes), 1.0);
  if (factors_.size() > 1) {
    factors_[0] = 0.5 / most;
    for (std::size_t k = 1; k < factors_.size(); ++k) factors_[k] = (1 - factors_[0]) / (passes - 1);
  }
}

void Filter::apply(double* values, int components) const {
  const std::size_t size = static_cast<std::size_t>(mesh_.nodes) * components;
  change_.resize(size);
  for (const double factor : factors_) {
    switch (components) {
      case 1:
        differences<1>(row_start_, column_, entry_, values, change_.data());
        break;
      case 2:
        differences<2>(row_start_, column_, entry_, values, change_.data());
        break;
      case 3:
        differences<3>(row_start_, column_, entry_, values, change_.data());
        break;
      case 4:
        differences<4>(row_start_, column_, entry_, values, change_.data());
        break;
      case 5:
        differences<5>(row_start_, column_, entry_, values, change_.data());
        break;
      case 6:
        differences<6>(row_start_, column_, entry_, values, change_.data());
        break;
      case 9:
        differences<9>(row_start_, column_, entry_, values, change_.data());
        break;
      default:
        throw std::logic_error("Filter::apply takes 1 to 6 components, or 9");
    }
    mesh_.sum_shared(change_.data(), components);
    for (std::size_t k = 0; k < size; ++k) values[k] += factor * change_[k];
  }
}

std::function<Mat3(int)> uniform_diffusivity(double length) {
  return [length](int) -> Mat3 { return length * length * Mat3::Identity(); };
}

std::function<Mat3(int)> automatic_diffusivity(const Mesh& mesh, double diameter) {
  return [&mesh, diameter](int cell) -> Mat3 {
    const double middle[3] = {0.5, 0.5, mesh.dimension == 3 ? 0.5 : 0.0}, corner[3] = {0, 0, 0};
    double dN[8][3];
    Mat3 extent = jacobian_at(mesh, cell, is_simplex(mesh.cell) ? corner : middle, dN);
    if (is_simplex(mesh.cell)) {
      Mat3 regular;  // edges of the regular simplex of unit edge
      regular << 1, 0.5, 0.5, 0, std::sqrt(3) / 2, std::sqrt(3) / 6, 0, 0, std::sqrt(2.0 / 3);
      if (mesh.dimension == 2) regular.col(2) = Vec3::UnitZ();
      extent = extent * regular.inverse();
    }
    if (mesh.dimension == 2) extent(2, 2) = 0;
    const Mat3 square = extent * extent.transpose();
    const double least = diameter * diameter;
    if (is_simplex(mesh.cell)) return 0.5 * std::max(square.trace() / mesh.dimension, least) * Mat3::Identity();
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(square);
    return 0.5 * axes.eigenvectors() * axes.eigenvalues().cwiseMax(least).asDiagonal() *
           axes.eigenvectors().transpose();
  };
}

}  // namespace silt
