#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/nodal_matrix.hpp"
#include "fluid/boundary/boundary_conditions.hpp"
#include "fluid/boundary/drive.hpp"
#include "fluid/energy/energy_equation.hpp"
#include "fluid/fluid.hpp"
#include "fluid/fluid_options.hpp"
#include "fluid/pressure_correction/bdf.hpp"
#include "fluid/pressure_correction/cell_loops.hpp"
#include "fluid/pressure_correction/pressure_solver.hpp"
#include "fluid/pressure_correction/velocity_solver.hpp"
#include "fluid/turbulence/turbulence.hpp"
#include "fluid/volume_scale.hpp"

namespace silt {

/// The options `-fluid_...` of the pressure correction alone.
struct PressureCorrectionOptions {
  double supg = 0.25;
  bool rotational = true;
  double velocity_tolerance = 1e-5;
  int width = 0;
  void options(OptionGroup& option);
};

/// Semi-implicit incremental pressure correction in rotational form for the volume-averaged equations (Guermond, Minev
/// & Shen 2006), BDF1 or variable-step BDF2 with extrapolated convecting velocity, equal-order P1 or Q1 elements.
///
/// One step: the velocity u~ from one scalar matrix shared by its components, with the pressure of the last step and
/// the effect of the last corrections in its history; then the pressure increment from the continuity of the corrected
/// superficial flux U~ - alpha k grad phi, stabilised by orthogonal subscales weighted with their own time scale. The
/// particles enter both operators through void fraction and response. Formulas: docs/theory/pressure_correction.md.
class PressureCorrection : public Fluid {
 public:
  PressureCorrection(const Mesh& mesh, Options& options, const FluidOptions& fluid, const Vec3& gravity);

  void meet_continuity(std::span<const double> solids_flux) override;
  FluidStep advance(double time, double dt) override;
  double courant_rate() const override;
  std::span<const double> velocity() const override { return velocity_; }
  std::span<const double> carrying_velocity() const override { return carrying_; }
  std::span<const double> velocity_change() const override { return velocity_change_; }
  std::span<const double> pressure() const override { return pressure_; }
  std::span<const double> pressure_gradient() const override { return pressure_gradient_; }
  std::span<const double> temperature() const override {
    return energy_ ? energy_->temperature() : std::span<const double>();
  }
  std::span<const double> temperature_change() const override {
    return energy_ ? energy_->temperature_change() : std::span<const double>();
  }
  std::vector<BoundaryFlow> boundary_flow() const override;
  const Turbulence* turbulence() const override { return turbulence_.get(); }
  std::vector<Scalar> scalars() const override;
  std::vector<StateArray> state() override;
  void restored() override;

 private:
  std::vector<StateArray> arrays() override;
  /// The numbers of the last two steps; kept with the nodal arrays so that a restart finds them.
  struct Past {
    int steps = 0;                  ///< taken, up to 2
    double dt = 0;                  ///< s, of the last step
    double rate = 0, old_rate = 0;  ///< 1/s, gamma/dt of the last two steps
  };
  Past past() const;

  void prepare(double time, double dt, const Past& past);
  void set_eddy_viscosity();
  /// The flow as the turbulence sees it.
  Turbulence::Flow turbulent_flow(const std::vector<double>& velocity) const;
  void set_cell_forces(const double* weight);
  void set_momentum_terms();
  void assemble_momentum();
  void add_backflow();
  /// Replaces the initial fields by those of `-fluid_initial_solve` or `-fluid_initial_file`.
  void start_from(Options& options);
  void start_drive();
  /// The driving pressure gradient at a time, or the flow that it has to give.
  void choose_drive(double time);
  void add_drive();
  /// Finds the driving pressure gradient with which solution_ carries the flow asked for. Returns iterations.
  int control_flow();
  void accept_drive();
  /// m/s, mean over the domain of the superficial velocity along the drive. Collective.
  double mean_flow(const std::vector<double>& u) const;
  std::vector<double> continuity(const std::vector<double>& u, std::vector<double>& divergence);
  void assemble_pressure(const Past& past);
  /// The pressure that balances the forces on the fluid at rest, for a start of which no pressure is known.
  void set_static_pressure(const Past& before);
  void solve(const Past& before, FluidStep& step, std::vector<double>& phi, std::vector<double>& divergence);
  /// [cells][points][3] the superficial velocity that the pressure equation balanced, at the quadrature points.
  std::vector<double> superficial_velocity(const std::vector<double>& phi) const;
  void set_pressure_gradient();
  /// s_e of the last step, times what the lent impulse is as a force over this one.
  void set_lent(double last_dt);
  /// [padded cells] m3 s/kg: what turns grad phi into the volume flux of the correction and of the stabilisation.
  std::vector<double> pressure_coefficient() const;
  /// u - k grad phi at the nodes, with k from the node's own drag: what the correction gives the particles and takes
  /// from the fluid are then equal to round-off.
  void set_carrying_velocity(const std::vector<double>& phi);
  /// N s, what the step lent to particles that follow, dt int s grad p. Collective.
  Vec3 lent_impulse() const;
  void accept(const Past& before, double dt, std::vector<double>& phi, const std::vector<double>& divergence);
  /// Outflow less what alpha makes room for, relative to VolumeScale; `prescribed` at the boundaries with a given
  /// flow.
  double volume_imbalance(double prescribed, double inflow, double volume_rate);
  FluidStep report(double dt) const;
  Vec3 boundary_reactions(std::vector<BoundaryFlow>& flows) const;

  const Mesh& mesh_;
  FluidOptions fluid_;
  PressureCorrectionOptions scheme_;
  Vec3 gravity_;
  BoundaryConditions boundaries_;
  VectorExpression body_force_expression_;
  NodalGraph graph_;
  CellLoops loops_;
  NodalMatrix momentum_;
  VelocitySolver velocity_solver_;
  PressureSolver pressure_solver_;
  std::unique_ptr<EnergyEquation> energy_;
  std::unique_ptr<Turbulence> turbulence_;
  std::unique_ptr<Drive> drive_;
  std::vector<double> density_field_, viscosity_field_;  ///< [nodes], uniform, for the turbulence
  std::vector<double> mass_;                             ///< [nodes] m3, lumped
  std::vector<double> node_size_;                        ///< [nodes] m, shortest edge of the local cells around
  bool has_body_force_ = false, has_weight_ = false, initial_pressure_given_ = false;

  // The state: fields of step n, n-1 and of the corrections in between.
  std::vector<double> velocity_, old_velocity_, pressure_, increment_, old_increment_;
  std::vector<double> void_fraction_, old_void_fraction_, drag_, old_drag_;  ///< of the last two corrections
  std::vector<double> pressure_gradient_, velocity_change_, carrying_;
  std::vector<double> following_, old_following_;  ///< s of the last two corrections
  std::vector<double> lent_pressure_;              ///< p^{n-1} + phi^n, the pressure that the last step felt
  std::vector<double> past_;                       ///< [nodes][4], Past at every node

  // Of the present step.
  bool porous_ = false, renew_ = true;
  Bdf bdf_{};
  double bdf_dt_ = 0, mass_residual_ = 0;
  VolumeScale volume_scale_;
  double matrix_rate_ = 0;  ///< gamma/dt of the assembled pressure matrix
  int matrix_age_ = 0;
  std::vector<double> convecting_, history_, body_force_, weight_, load_per_drag_, drag_now_, right_, solution_, flux_,
      effective_, projection_;
  std::vector<double> cell_values_;  ///< the arrays of CellCoefficients and the increment factors, one after the other
  CellCoefficients cell_{};
  double *increment_factor_ = nullptr, *old_increment_factor_ = nullptr, *lent_ = nullptr, *scratch_[5] = {};
  MomentumTerms terms_{};
  std::vector<double> eddy_viscosity_;            ///< [padded cells] Pa s; empty without turbulence
  std::vector<double> outflow_;                   ///< [nodes] m3/s through the pressure boundaries, of the last step
  double drive_gradient_ = 0, drive_target_ = 0;  ///< Pa/m and m/s, of the present step
  std::vector<double> last_drive_;                ///< [nodes] Pa/m, of the last step (an array for the checkpoint)
  std::vector<double> drive_load_;                ///< [nodes] m3, right side of the velocity per driving gradient
  std::vector<double> drive_share_;   ///< [nodes] 1, what the cells around a node see of it in pressure_gradient_
  std::vector<double> drive_answer_;  ///< [nodes][3] velocity per driving gradient

  struct OutletFacet {
    const FacetRule* rule;
    int entry[4][4];
  };
  std::vector<OutletFacet> outlets_;
};

std::unique_ptr<Fluid> make_pressure_correction(const Mesh& mesh, Options& options, const FluidOptions& fluid,
                                                const Vec3& gravity);

}  // namespace silt
