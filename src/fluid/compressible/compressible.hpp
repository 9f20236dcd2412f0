#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fluid/boundary/temperature_boundaries.hpp"
#include "fluid/compressible/gas_newton.hpp"
#include "fluid/compressible/gas_system.hpp"
#include "fluid/fluid.hpp"
#include "fluid/fluid_options.hpp"
#include "fluid/pressure_correction/bdf.hpp"
#include "fluid/turbulence/turbulence.hpp"

namespace silt {

/// The options `-fluid_...` of compressible flow.
struct CompressibleOptions {
  double gas_constant = 287.05;
  double heat_ratio = 1.4;
  double prandtl = 0.71;
  std::string viscosity_law = "constant";
  double viscosity_temperature = 273.15;
  double sutherland_temperature = 110.4;
  std::string symmetry = "none";
  std::string march = "time";
  double shock_capturing = 1;
  double expansion_sensor = 1;
  double shock_sensor = 0;
  std::string initial_temperature = "0";
  std::string heat_source = "0";
  void options(OptionGroup& option);
};

/// Compressible flow of an ideal gas: mass, momentum and total energy in conservation form for pressure, velocity and
/// temperature, implicit (BDF1 or BDF2), P1 or Q1 elements with streamline stabilisation and shock capturing, both held
/// fixed while Newton iterates; plane, axisymmetric or in space (docs/theory/compressible.md).
class Compressible final : public Fluid {
 public:
  Compressible(const Mesh& mesh, Options& options, const FluidOptions& fluid, const Vec3& gravity);

  FluidStep advance(double time, double dt) override;
  double courant_rate() const override;
  double longest_step(double last) const override;
  std::span<const double> velocity() const override { return velocity_; }
  std::span<const double> velocity_change() const override { return velocity_change_; }
  std::span<const double> pressure() const override { return pressure_; }
  std::span<const double> pressure_gradient() const override { return pressure_gradient_; }
  std::span<const double> temperature() const override { return temperature_; }
  std::span<const double> temperature_change() const override { return temperature_change_; }
  Properties properties() const override { return {density_field_, viscosity_field_, sound_}; }
  bool total_energy() const override { return true; }
  const Turbulence* turbulence() const override { return turbulence_.get(); }
  double displacement_power(double reference) const override;
  std::vector<Scalar> scalars() const override;
  std::vector<BoundaryFlow> boundary_flow() const override;
  std::vector<StateArray> state() override;
  void restored() override;

  /// Sources per volume of mixture: mass (kg/m3/s, for tests), momentum (N/m3), which does its work on the gas, and
  /// heat (W/m3); `-fluid_body_force` and `-fluid_heat_source` set them.
  using Source = std::function<void(const Vec3& x, double t, double& mass, Vec3& momentum, double& heat)>;
  void set_source(Source source) { source_ = std::move(source); }
  /// Residual norms of the Newton iterations of the last step.
  const std::vector<double>& newton_norms() const { return newton_.norms(); }
  const GasSystem& system() const { return system_; }
  const GasStep& last_step() const { return step_; }

 private:
  void choose_units(const Vec3& gravity);
  void read_sources(const Options& options, const FluidOptions& fluid);
  Bdf difference(double dt, int order) const;
  void prepare(double time, double dt, int order);
  void set_outside(double time, double dt);
  void let_surroundings_follow(OpenBoundary& outside, const FacetRule& rule, int q, double dt) const;
  Turbulence::Flow turbulent_flow() const;
  /// k and epsilon in the flow of the step's start; what they take from its energy goes into the step. Returns the
  /// linear iterations.
  int solve_turbulence(double time, double dt);
  void take_eddy_viscosity();
  void relax_capturing();
  GasNewton::Result solve_flow(double time, double dt, const std::vector<double>& before);
  void from_state();
  void find_pressure_gradient();
  double norm_scale() const;
  FluidStep report() const;

  const Mesh& mesh_;
  CompressibleOptions options_;
  int order_;
  BoundaryConditions boundaries_;
  TemperatureBoundaries thermal_;
  GasSystem system_;
  GasNewton newton_;
  GasStep step_;
  Source source_;
  double p0_ = 1, T0_ = 1, u0_ = 1;  ///< units of pressure, temperature and speed
  std::unique_ptr<Turbulence> turbulence_;
  std::vector<double> cell_size_, mass_;
  VecHandle unknown_;

  std::vector<double> state_;                      ///< [nodes][size] p, u, T in those units
  std::vector<double> conserved_, old_conserved_;  ///< alpha U of steps n and n-1
  std::vector<double> rate_;                       ///< [nodes][size] rate of change of the last step
  std::vector<double> last_capturing_;  ///< [cells] capturing viscosity of the last step, in the units of GasLaw
  std::vector<double> last_normal_;     ///< [cells][dimension] GasFrozen::normal of the last step
  std::vector<double> past_;            ///< [nodes][2] steps taken (up to 3), s of the last one
  std::vector<double> velocity_, pressure_, temperature_, density_field_, viscosity_field_, sound_, mach_;
  std::vector<double> velocity_change_, temperature_change_, pressure_gradient_;
  int last_newton_ = 0;
  bool rescued_ = false;  ///< the last step needed first-order viscosity
};

std::unique_ptr<Fluid> make_compressible(const Mesh& mesh, Options& options, const FluidOptions& fluid,
                                         const Vec3& gravity);

}  // namespace silt
