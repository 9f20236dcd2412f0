#pragma once
#include <array>
#include <vector>

#include "fluid/boundary/boundary_conditions.hpp"
#include "fluid/space/lagrange_space.hpp"

namespace silt {

/// The fixed directions of the velocity at all nodes of a velocity space: those of BoundaryConditions at the vertices,
/// the same rules applied at the middles.
class VelocityConstraints {
 public:
  /// Collective.
  VelocityConstraints(const LagrangeSpace& space, const BoundaryConditions& boundary);

  /// An orthonormal frame whose first `count` directions are fixed (all `dimension` of them: Cartesian frame).
  struct Constraint {
    int node, count;
    std::array<Vec3, 3> frame;
  };
  const std::vector<Constraint>& constraints() const { return constraints_; }
  /// [space.nodes] index into constraints(), -1 where the node is free.
  const std::vector<int>& of_node() const { return of_node_; }
  /// Prescribed interstitial velocities at time t: [space.nodes][3]; BoundaryConditions::evaluate has been called.
  void evaluate(double time, const double* void_fraction, double* velocity) const;
  /// Sets the fixed directions of u [space.nodes][3] to `prescribed`.
  void impose(const double* prescribed, double* u) const;

 private:
  void find_middles();
  void add(int node, int count, std::array<Vec3, 3> directions);
  const LagrangeSpace& space_;
  const BoundaryConditions& boundary_;
  std::vector<Constraint> constraints_;
  std::vector<int> of_node_;
  struct Middle {
    int node, boundary;
    Vec3 normal;
  };
  std::vector<Middle> middles_;
};

}  // namespace silt
