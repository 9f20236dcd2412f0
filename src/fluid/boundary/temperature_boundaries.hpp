#pragma once
#include <memory>
#include <vector>

#include "fluid/boundary/boundary_conditions.hpp"

namespace silt {

/// The thermal conditions on all boundaries of the mesh.
///
/// Walls are adiabatic unless told otherwise. Inflows need the temperature of what enters: it comes with the flow, so
/// that the heat brought in is exact however steep the temperature is behind (Danckwerts 1953), or is held at the nodes
/// (`given`; `velocity` in compressible flow always). On `pressure` boundaries it may be given for fluid that comes in,
/// which in incompressible flow else is as warm as the fluid there was at the start.
class TemperatureBoundaries {
 public:
  struct Condition {
    enum Kind { adiabatic, given, flux, heat_transfer, inflow } kind = adiabatic;
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
  /// [nodes] the boundary, `inflow` or `pressure`, that fluid which enters there comes through; -1: none.
  const std::vector<int>& entered_boundary() const { return entered_boundary_; }
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
  /// The boundary of the strongest flow condition among those with the property, for each node; -1: none. Collective.
  std::vector<int> strongest(const std::vector<char>& has_it) const;
  template <class F>
  void for_each_point(double t, F f) const;

  const Mesh& mesh_;
  const BoundaryConditions& boundaries_;
  std::vector<Condition> conditions_;
  std::vector<char> fixed_;
  std::vector<int> fixed_boundary_, entered_boundary_;
};

}  // namespace silt
