#pragma once
#include <span>
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// The trapezoidal rule on cells: quadrature points are the corners. Exact for linear integrands on simplices,
/// multilinear ones on parallelepipeds; nodal values are then the values at the points, mass is lumped, and on
/// rectangular cells a stiffness couples along edges only.
class VertexRule {
 public:
  /// One cell: weights m3 and shape gradients 1/m at its corners.
  struct At {
    int cell;
    const int* node;   ///< local nodes
    const double* x;   ///< [corners][3] m
    double weight[8];  ///< at corner v
    Vec3 slope[8][8];  ///< [v][a] gradient of shape function a at corner v
  };

  /// `axisymmetric`: weights times the distance y from the axis, averaged as int N_v y, so that none vanishes.
  VertexRule(const Mesh& mesh, bool axisymmetric);

  template <class F>
  void for_each_cell(F f) const {
    At at;
    for (int c = 0; c < mesh_.cells; ++c) {
      set(c, at);
      f(at);
    }
  }
  const Mesh& mesh() const { return mesh_; }
  int corners() const { return mesh_.nodes_per_cell; }
  /// [nodes] m3, the sum of the weights, consistent on shared nodes.
  const std::vector<double>& volume() const { return volume_; }
  /// field[nodes][components] -> gradient[nodes][components][3], the weighted mean over the corners at each node,
  /// consistent on shared nodes; up to 3 components. Collective.
  void gradient(std::span<const double> field, int components, std::vector<double>& gradient) const;

 private:
  void set(int cell, At& at) const;

  const Mesh& mesh_;
  bool axisymmetric_;
  double corner_weight_;
  double reference_[8][8][3];  ///< [v][a] reference gradients
  std::vector<double> volume_;
};

}  // namespace silt
