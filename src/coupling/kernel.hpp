#pragma once
#include <span>
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// The weights by which particles and mesh nodes exchange quantities: the shape functions phi_i at the particle's
/// centre, w_pi = phi_i(x_p). One set of weights serves both directions, so that for any nodal f and particle q: sum_p
/// q_p (sample f)_p = sum_i (deposit q)_i f_i. A particle larger than its cell is treated alike: its spreading over the
/// mesh is the filter's (filter.hpp).
class Kernel {
 public:
  explicit Kernel(const Mesh& mesh) : mesh_(mesh) {}

  /// Starts anew for `count` particles.
  void resize(int count);
  int count() const { return static_cast<int>(cell_.size()); }
  /// Sets the place of particle p: local cell and reference coordinates there.
  void place(int p, int cell, const double* xi);

  /// b_i = sum_p w_pi q_p. quantities[count][components] -> nodal[nodes][components], summed over ranks. Collective.
  void deposit(std::span<const double> quantities, std::span<double> nodal, int components) const;
  /// values_p = sum_i w_pi f_i, the adjoint. nodal[nodes][components] -> values[count][components]. Local.
  void sample(std::span<const double> nodal, std::span<double> values, int components) const;

 private:
  const Mesh& mesh_;
  std::vector<int> cell_;
  std::vector<double> weight_;  ///< [count][nodes_per_cell]
};

}  // namespace silt
