#pragma once
#include <functional>
#include <vector>

#include "base/mesh.hpp"
#include "base/nodal_matrix.hpp"

namespace silt {

/// The spreading of what particles do over the mesh: a diffusion over one unit of time with diffusivity D, so that a
/// point becomes a Gaussian whose variance is 2 D in each direction (Sun & Xiao 2015; D = l^2 of the Helmholtz filter M
/// + l^2 K to first order, and the same variance). Natural boundaries: what meets a wall is reflected.
///
/// S = (1 - t_1 M^-1 K) ... (1 - t_n M^-1 K), t_k > 0, sum t_k = 1: a fixed polynomial in M^-1 K, with M the lumped
/// mass and K a stiffness matrix without positive couplings. Hence, whatever the mesh and the ranks,
///  - S 1 = 1 and sum_i M_i (S f)_i = sum_i M_i f_i to round-off: constants and totals are kept,
///  - sum_i M_i a_i (S b)_i = sum_i M_i (S a)_i b_i to round-off: its own adjoint, no solver tolerance anywhere,
///  - every t_k M_i^-1 K_ii <= 1, so S f is a weighted mean of f: no over- or undershoot, void fraction and response
///  stay positive.
/// The number of factors grows as (width / cell)^2: 4 for a standard deviation of one cell, 13 for two.
class Filter {
 public:
  /// `diffusivity(cell)`: D in m2, a symmetric matrix. Collective.
  Filter(const Mesh& mesh, const std::vector<double>& mass, const std::function<Mat3(int)>& diffusivity);

  /// values[nodes][components] -> S values, consistent on shared nodes. Collective.
  void apply(double* values, int components) const;
  /// Number of passes over the matrix in one application.
  int passes() const { return static_cast<int>(factors_.size()); }

 private:
  const Mesh& mesh_;
  std::vector<int> row_start_, column_;  ///< this rank's couplings without the diagonal
  std::vector<double> entry_;            ///< K_ij / M_i
  std::vector<double> factors_;          ///< t_k
  mutable std::vector<double> change_;
};

/// D = length^2 in every direction.
std::function<Mat3(int)> uniform_diffusivity(double length);

/// D for a kernel whose standard deviation is the particle diameter, and never less than the cell's extent in each
/// direction: its width, two standard deviations, is two diameters or two cells. Simplices take their mean extent.
std::function<Mat3(int)> automatic_diffusivity(const Mesh& mesh, double diameter);

}  // namespace silt
