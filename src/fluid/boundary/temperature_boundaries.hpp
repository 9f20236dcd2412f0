#pragma once
#include <memory>
#include <vector>

#include "fluid/boundary/boundary_conditions.hpp"

namespace silt {

/// The thermal conditions on all boundaries of the mesh.
///
/// Walls are adiabatic unless told otherwise. Inflows need the temperature of what enters: `velocity` (and `mass_flow`
/// in incompressible flow) hold it at their nodes, open boundaries bring it with the flow. On `pressure` boundaries it
/// may be given for fluid that comes in there.
class TemperatureBoundaries {
 public:
  struct Condition {
    enum Kind { adiabatic, given, flux, heat_transfer } kind = adiabatic;
    bool has_value = false;
    std::unique_ptr<Expression> value, flux_density, coefficient;
  };

  /// Reads `-boundary_<name>_temperature_...`; throws UserError for what does not fit the flow's condition. Collective.
  TemperatureBoundaries(const Mesh& mesh, Options& options, const BoundaryConditions& boundaries);

  const Condition& operator[](size_t boundary) const { return conditions_[boundary]; }
  /// [nodes] temperature given.
  const std::vector<char>& fixed() const { return fixed_; }
  /// [nodes] the boundary that gives it, of those that meet the one whose flow condition is the strongest; -1: none.
  const std::vector<int>& fixed_boundary() const { return fixed_boundary_; }
  /// K, given at the node at time t; only where fixed.
  double given(int node, double t) const;
  /// W and W/K at the nodes: heat - coefficient T is what `flux` and `heat_transfer` give the fluid. `axisymmetric`:
  /// areas times the distance y from the axis. Consistent on shared nodes. Collective.
  void heat(double t, bool axisymmetric, std::vector<double>& heat, std::vector<double>& coefficient) const;
  /// W per boundary, local part of the heat that leaves by `flux` and `heat_transfer` at temperatures T.
  void add_heat_flow(double t, const std::vector<double>& T, std::vector<double>& flow) const;
  /// Throws UserError when a thermal condition is given though there is no temperature.
  static void refuse(const Mesh& mesh, const Options& options, const std::string& reason);

 private:
  void find_fixed();
  template <class F>
  void for_each_point(double t, F f) const;

  const Mesh& mesh_;
  const BoundaryConditions& boundaries_;
  std::vector<Condition> conditions_;
  std::vector<char> fixed_;
  std::vector<int> fixed_boundary_;
};

}  // namespace silt
