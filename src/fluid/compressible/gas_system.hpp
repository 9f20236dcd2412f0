#pragma once
#include <vector>

#include "fluid/boundary/temperature_boundaries.hpp"
#include "fluid/compressible/gas_frozen.hpp"
#include "fluid/compressible/gas_loop.hpp"
#include "fluid/compressible/open_boundary.hpp"
#include "fluid/space/lagrange_space.hpp"
#include "fluid/space/unknowns.hpp"

namespace silt {

/// Everything that is given during one step of the compressible equations, in the units of GasLaw; [nodes] arrays.
struct GasStep {
  GasLaw law;
  double rate = 0;  ///< factor of U^{n+1} in its rate of change
  double gravity[3] = {};
  bool axisymmetric = false;
  std::vector<double> known;   ///< [nodes][size] the rest of the rate
  std::vector<double> source;  ///< [nodes][size] per volume: mass, momentum (which does work), heat
  std::vector<double> alpha, alpha_rate;
  std::vector<double> force;         ///< [nodes][size] what acts at the nodes: momentum, and heat in the last place
  std::vector<double> response;      ///< [nodes] kg/s of the particles, on u - u^n
  std::vector<double> old_velocity;  ///< [nodes][3]
  std::vector<double> prescribed_velocity;                ///< [nodes][3] at constrained nodes
  std::vector<double> prescribed_temperature;             ///< [nodes] where fixed
  std::vector<double> heat, heat_coefficient;             ///< [nodes] heat into walls' nodes: heat - coefficient T
  std::vector<std::vector<OpenBoundary>> open;            ///< [facet][point] what stands outside; empty: a wall
  std::vector<double> eddy_viscosity, eddy_conductivity;  ///< [cells]; empty: laminar
  double eddy(int cell) const { return eddy_viscosity.empty() ? 0.0 : eddy_viscosity[cell]; }
  GasFrozen frozen;
  CapturingFactors capturing;
};

/// Fluxes of mass, momentum and energy through each boundary, outward.
struct GasBoundaryFlow {
  double mass = 0, energy = 0, volume = 0, pressure = 0, area = 0;
  Vec3 momentum = Vec3::Zero();  ///< Euler flux with the pressure, and reactions of walls
};

/// The algebraic system of compressible flow: pressure, velocity and temperature at the nodes, interlaced, BAIJ. At
/// nodes with a condition the velocity stands in the frame of its constraint; fixed rows read unknown - given.
class GasSystem {
 public:
  /// Collective.
  GasSystem(const Mesh& mesh, const BoundaryConditions& boundary, const TemperatureBoundaries& thermal);

  int size() const { return dimension_ + 2; }
  /// Sets what the step's conditions prescribe in a state.
  void impose(const GasStep& step, std::vector<double>& state) const;
  VecHandle create_vector() const;
  MatHandle create_matrix() const;
  /// Unknowns [nodes][size], Cartesian <-> global vector.
  void to_vector(const std::vector<double>& state, Vec x) const;
  PetscErrorCode from_vector(Vec x, std::vector<double>& state) const;

  /// Finds GasStep::frozen from a state whose rate of change is `rate_now` [nodes][size].
  void freeze(GasStep& step, const std::vector<double>& state, const std::vector<double>& rate_now) const;
  PetscErrorCode residual(const GasStep& step, Vec x, Vec r) const;
  PetscErrorCode jacobian(const GasStep& step, Vec x, Mat matrix) const;
  /// alpha times the conserved quantities of a state, [nodes][size].
  std::vector<double> conserved(const GasStep& step, const std::vector<double>& state) const;
  /// Fluxes through the boundaries; what constrained rows lack is the wall's reaction. Collective.
  std::vector<GasBoundaryFlow> boundary_flow(const GasStep& step, const std::vector<double>& state) const;
  /// int of the conserved quantities, times the radius. Collective.
  std::vector<double> totals(const std::vector<double>& conserved) const;
  const std::vector<double>& weights() const { return weights_; }
  void set_axisymmetric(bool axisymmetric);

 private:
  template <Cell C>
  void gather(const GasStep& step, const std::vector<double>& state, int cell, GasCell<C>& out) const;
  template <Cell C>
  void freeze_cells(GasStep& step, const std::vector<double>& state, const std::vector<double>& rate_now) const;
  PetscErrorCode cells(const GasStep& step, const std::vector<double>& state, double* residual, Mat matrix) const;
  PetscErrorCode facets(const GasStep& step, const std::vector<double>& state, double* residual, Mat matrix) const;
  template <int dim>
  PetscErrorCode facets_of(const GasStep& step, const std::vector<double>& state, double* residual, Mat matrix) const;
  template <int dim>
  struct FacetState;
  template <int dim>
  void flux_through(const GasStep& step, const FacetState<dim>& point, size_t facet, int q, double* out) const;
  bool viscous_through(const GasStep& step, size_t facet, int q, const Vec3& normal) const;
  void shape_at(size_t facet, int q, double* N, double (*gradient)[3]) const;
  PetscErrorCode assemble(const GasStep& step, const std::vector<double>& state, double* residual, Mat matrix) const;
  void nodes(const GasStep& step, const std::vector<double>& state, double* residual) const;
  size_t velocity_place(int node) const { return static_cast<size_t>(node) * size() + 1; }
  void to_frames(double* values) const;
  void add_wall_work(const GasStep& step, double* residual) const;
  void constrain(const GasStep& step, int count, const int* nodes, double* matrix) const;
  double radius(double y) const { return axisymmetric_ ? y : 1.0; }

  const Mesh& mesh_;
  const BoundaryConditions& boundary_;
  LagrangeSpace space_;
  VelocityConstraints constraints_;
  const std::vector<char>& fixed_temperature_;
  std::vector<int> temperature_boundary_;  ///< [nodes] where heat is given: temperature, flux or transfer; -1: nowhere
  int dimension_;
  GasLoop loop_;
  bool axisymmetric_ = false;
  std::vector<PetscInt> global_;  ///< [nodes] block
  std::vector<double> weights_;   ///< [nodes] m3, int N_i (r)
  Handle<VecScatter, VecScatterDestroy> scatter_;
  VecHandle local_;
};

}  // namespace silt
