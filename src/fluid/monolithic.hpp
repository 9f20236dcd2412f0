#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "fluid/assembly/flow_system.hpp"
#include "fluid/boundary/drive.hpp"
#include "fluid/energy/energy_equation.hpp"
#include "fluid/fluid.hpp"
#include "fluid/fluid_options.hpp"
#include "fluid/newton_solver.hpp"
#include "fluid/turbulence/turbulence.hpp"
#include "fluid/volume_scale.hpp"

namespace silt {

/// The options `-fluid_...` of the monolithic scheme.
struct MonolithicOptions {
  std::string element = "equal_order";
  std::optional<double> supg, pspg, grad_div;
  std::string pressure_stage = "auto";
  void options(OptionGroup& option);
};

/// Velocity and pressure in one system, solved by Newton's method with the exact Jacobian (automatic differentiation of
/// VolumeAveragedNavierStokes). Fully implicit in time, BDF1 or BDF2 with variable step (the first step is BDF1).
///
/// The particles' load with equal-order elements is the nodal vector as given: row i gets force_i - response_i
/// (u_i^{n+1} - u_i^n); the stabilisation sees the densities sum_i N_i force_i / M_i and response_i / M_i (M lumped
/// mass of the vertices). With Taylor-Hood elements these densities f_h, r_h enter the weak form: int f_h.v - int r_h
/// (u^{n+1} - u^n).v. A load on the vertices alone would be a set of spikes for P2, whose vertex functions have no
/// mean. Both forms hand over the same total: int f_h = sum force_i, and int r_h (u^{n+1} - u^n) = sum response_i c_i
/// with the weighted mean c_i = int N_i (u^{n+1} - u^n) / M_i, which velocity_change() returns; it is exact because M_i
/// and c_i use the quadrature of the weak form.
class Monolithic final : public Fluid {
 public:
  /// Reads `-fluid_element` and the stabilisation factors; `boundary` conditions from `-boundary_...`. Collective.
  Monolithic(const Mesh& mesh, Options& options, const FluidOptions& fluid, const Vec3& gravity);

  void meet_continuity(std::span<const double> solids_flux) override;
  FluidStep advance(double time, double dt) override;
  double courant_rate() const override;
  std::span<const double> velocity() const override { return {velocity_.data(), 3 * static_cast<size_t>(mesh_.nodes)}; }
  std::span<const double> velocity_change() const override { return change_; }
  std::span<const double> pressure() const override { return pressure_; }
  std::span<const double> pressure_gradient() const override { return pressure_gradient_; }
  std::span<const double> temperature() const override {
    return energy_ ? energy_->temperature() : std::span<const double>();
  }
  std::span<const double> temperature_change() const override {
    return energy_ ? energy_->temperature_change() : std::span<const double>();
  }
  std::vector<double> velocity_at(const Quadrature& rule) const override;
  std::vector<BoundaryFlow> boundary_flow() const override;
  const Turbulence* turbulence() const override { return turbulence_.get(); }
  std::vector<Scalar> scalars() const override;
  std::vector<StateArray> state() override;
  std::vector<StateArray> arrays() override;
  void restored() override;

  /// Adds a force per volume (N/m3) to the momentum equation, as `-fluid_body_force` does.
  void set_body_force(std::function<Vec3(const Vec3& x, double t)> force) { body_force_ = std::move(force); }
  /// The step of the last advance(), for tests of the algebraic system.
  const FlowSystem& system() const { return system_; }
  const StepFields& fields() const { return fields_; }
  /// [system().space().nodes][3] m/s, all velocity nodes.
  std::span<const double> all_velocities() const { return velocity_; }
  std::span<double> all_velocities() { return velocity_; }
  /// Sets up fields() for a step from time to time + dt, as advance() does. Collective.
  void prepare_step(double time, double dt);
  /// Residual norms of the Newton iterations of the last step.
  const std::vector<double>& newton_norms() const { return solver_.norms(); }

 private:
  void choose_scales();
  /// The steady flow without inertia, for a start.
  void solve_stokes();
  NewtonSolver::Result solve_driven(double time);
  /// Finds the gradient with which the flow is `target`; `set` puts a gradient into the step.
  NewtonSolver::Result find_drive(double target, const std::function<void(double)>& set);
  /// m3/s m, int alpha u over the domain, of velocity_. Collective.
  Vec3 total_flux() const;
  /// N, int s grad p of the last step. Collective.
  Vec3 lent_force() const;
  void find_change(const std::vector<double>& before);
  void find_pressure_gradient();
  void remove_mean_pressure();
  FluidStep report(double dt);
  std::vector<BoundaryFlow> boundary_flow(const std::vector<FacetIntegrals>& integrals) const;
  Turbulence::Flow turbulent_flow() const;

  const Mesh& mesh_;
  MonolithicOptions options_;
  BoundaryConditions boundary_;
  FlowSystem system_;
  NewtonSolver solver_;
  std::unique_ptr<EnergyEquation> energy_;
  std::unique_ptr<Turbulence> turbulence_;
  std::vector<double> density_field_, viscosity_field_;  ///< [nodes], uniform, for the turbulence
  std::unique_ptr<Drive> drive_;
  VolumeScale volume_scale_;
  StepFields fields_;
  Bdf bdf_{};
  int order_;
  std::function<Vec3(const Vec3&, double)> body_force_;
  VecHandle unknown_;
  std::vector<double> velocity_, velocity_previous_;  ///< [v][3], u^n and u^{n-1}
  std::vector<double> pressure_, change_, pressure_gradient_;
  std::vector<double>
      step_previous_;  ///< [nodes] s, dt of the last step, 0 before the first (an array for the checkpoint)
  std::vector<double> lent_share_;  ///< [nodes] s of the last step, whose s grad p comes back in this one
  std::vector<double> vertices_, vertices_previous_;  ///< [nodes][3], velocities as the checkpoint sees them
  std::vector<double> middles_, middles_previous_;    ///< [cells][middles][3]
  Vec3 static_head_ = Vec3::Zero();                   ///< Pa/m, gradient that the pressure holds at rest
  double drive_gradient_ = 0;                         ///< Pa/m, of the present step
  std::vector<double> last_drive_;                    ///< [nodes] Pa/m, of the last step (an array for the checkpoint)
  double residual_scale_ = 0;
};

std::unique_ptr<Fluid> make_monolithic(const Mesh& mesh, Options& options, const FluidOptions& fluid,
                                       const Vec3& gravity);

}  // namespace silt
