#pragma once
#include <span>
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// Gradients of nodal fields as nodal fields: g_i = (1/M_i) int phi_i grad f, M_i = int phi_i. Exact for linear fields
/// up to the boundary, of second order inside regular meshes. sum_i M_i a_i g_i = int a_h grad f_h for every nodal a.
class NodalGradient {
 public:
  /// `mass`: lumped_mass(mesh).
  NodalGradient(const Mesh& mesh, const std::vector<double>& mass);
  /// field[nodes][components] -> gradient[nodes][components][3], consistent on shared nodes; 1 to 9 components.
  /// Collective.
  void apply(std::span<const double> field, int components, std::vector<double>& gradient) const;

 private:
  const Mesh& mesh_;
  const std::vector<double>& mass_;
};

}  // namespace silt
