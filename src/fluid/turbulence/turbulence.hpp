#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fluid/boundary/boundary_conditions.hpp"
#include "fluid/fluid.hpp"
#include "fluid/pressure_correction/bdf.hpp"
#include "fluid/turbulence/turbulence_options.hpp"

namespace silt {

/// The turbulence of a flow: what a scheme has to add to its viscosity, and the turbulent quantities at the nodes
/// (docs/theory/turbulence.md). It knows nothing of the scheme; density and viscosity may vary, so every scheme,
/// incompressible or compressible, plane, axisymmetric or in space, uses it in the same way:
///
///     turbulence_ = Turbulence::create(mesh, options, boundaries, axisymmetric);  // null without
///     if (turbulence_ && no step was taken) turbulence_->start(flow);              // the initial state
///     ... solve the flow with viscosity + turbulence_->cell_eddy_viscosity()[cell] (times alpha), frozen ...
///     turbulence_->solve(time, bdf, dt, flow with the new velocity);               // may throw SolveFailure
///     turbulence_->accept();                                                       // with the rest of the step
///
/// A scheme that counts its total energy solves the turbulence first, in the flow of the step's start, and takes
/// exchange() from its energy; snapshot() and restore() undo that when the flow then fails.
///
/// Heat: the same with conductivity + turbulence_->cell_eddy_conductivity(...)[cell]. The momentum equation gains
/// div(mu_t grad u^T) too where mu_t varies: add_transposed_stress(). The trace -2/3 rho k is part of the pressure.
class Turbulence {
 public:
  /// The flow at the nodes, consistent on shared nodes.
  struct Flow {
    std::span<const double> velocity;       ///< [nodes][3] m/s, interstitial
    std::span<const double> density;        ///< [nodes] kg/m3
    std::span<const double> viscosity;      ///< [nodes] Pa s, molecular
    std::span<const double> void_fraction;  ///< [nodes]
    /// [nodes] W, load vector: what particles add to k (negative: take from it); empty: none. epsilon gets factor
    /// epsilon/k times that, omega (factor - 1) omega/k.
    std::span<const double> source = {};
    bool compressible = false;  ///< dilatation of the flow does work on k (C18)
    double dissipation_factor = 0;
    std::span<const double> sound = {};  ///< [nodes] m/s, compressible flow
    double heat_ratio = 1.4;
  };

  /// Reads `-fluid_turbulence...` and `-boundary_<name>_turbulence_...`; null for `none`. Collective.
  static std::unique_ptr<Turbulence> create(const Mesh& mesh, Options& options, const BoundaryConditions& boundaries,
                                            bool axisymmetric = false);
  /// Throws UserError when a turbulence model is asked for; `reason` says where it is not available.
  static void refuse(const Mesh& mesh, Options& options, const std::string& reason);
  /// Throws UserError for the turbulence of an inflow where there are no equations for it.
  static void refuse_inflow(const Mesh& mesh, const Options& options, const std::string& reason);
  virtual ~Turbulence() = default;

  /// Eddy viscosity of the initial state. Collective.
  virtual void start(const Flow& flow) = 0;
  /// Finds the turbulence at time + dt in the flow at that time; accept() makes it the present one. Returns the linear
  /// iterations; throws SolveFailure. Collective.
  virtual int solve(double time, const Bdf& bdf, double dt, const Flow& flow) = 0;
  virtual void accept() = 0;

  /// [cells] Pa s, what the turbulence adds to the mean molecular viscosity of a cell. At walls with a law of the wall
  /// this is what gives the shear of the law with the velocity linear in the cell and that of the wall on it.
  const std::vector<double>& cell_eddy_viscosity() const { return cell_eddy_viscosity_; }
  /// [cells] W/(m K), added to the conductivity; the law of the wall for temperature in its cells.
  std::vector<double> cell_eddy_conductivity(double heat_capacity, double conductivity, double viscosity) const;
  /// The same for a viscosity [cells] that varies, at one Prandtl number of the gas.
  std::vector<double> cell_eddy_conductivity(double heat_capacity, double prandtl,
                                             std::span<const double> viscosity) const;
  /// [nodes] W, load vector (around an axis per radian): what k took from the flow and the particles in the last
  /// solve(): production less dissipation; empty for models without k, whose production is heat at once.
  virtual std::span<const double> exchange() const { return {}; }
  /// [nodes] Pa s.
  const std::vector<double>& eddy_viscosity() const { return eddy_viscosity_; }
  /// [nodes] m2/s2 and m2/s3: k and epsilon; empty for the models that have none.
  virtual std::span<const double> energy() const { return {}; }
  virtual std::span<const double> dissipation() const { return {}; }
  /// [nodes] m, to the nearest no_slip boundary.
  const std::vector<double>& wall_distance() const { return wall_distance_; }

  /// Adds div(alpha mu_t grad u^T) = grad u . grad(alpha mu_t) to force [nodes][3] N/m3, div u apart. Collective.
  void add_transposed_stress(const Mesh& mesh, std::span<const double> velocity, std::span<const double> void_fraction,
                             std::vector<double>& force) const;

  /// Sources added to the equations, W/m3 and density times the unit of the second quantity per second, not divided
  /// among the phases; null: none (`-fluid_turbulent_energy_source`, `-fluid_turbulent_dissipation_source`).
  std::function<double(const Vec3&x, double t)> energy_source, second_source;

  /// For output: k, epsilon or omega, eddy viscosity, wall distance.
  virtual void add_scalars(std::vector<Fluid::Scalar>& scalars) const;
  virtual void add_state(std::vector<Fluid::StateArray>& arrays);
  /// After the arrays of add_state() were overwritten.
  virtual void restored() {}
  using Snapshot = std::vector<std::vector<double>>;
  Snapshot snapshot();
  void restore(const Snapshot& kept);
  const std::string& name() const { return options_.turbulence; }

 protected:
  Turbulence(const TurbulenceOptions& options, std::vector<double> wall_distance)
      : options_(options), wall_distance_(std::move(wall_distance)) {}
  static std::vector<double> wall_distance_of(const Mesh& mesh, const BoundaryConditions& boundaries);

  TurbulenceOptions options_;
  std::vector<double> wall_distance_, eddy_viscosity_, cell_eddy_viscosity_;
  std::vector<double> wall_y_plus_;  ///< [cells] y+ of the first node where a law of the wall acts, else 0
};

}  // namespace silt
