#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/expression.hpp"
#include "fluid/boundary/temperature_boundaries.hpp"
#include "fluid/fluid.hpp"
#include "fluid/pressure_correction/bdf.hpp"
#include "fluid/transport/scalar_transport.hpp"

namespace silt {

/// The options `-fluid_...` of the energy equation of incompressible flow.
struct EnergyOptions {
  double heat_capacity = 0;
  double conductivity = 0;
  double expansion = 0;
  double reference_temperature = 0;
  std::string initial_temperature = "0";
  std::string heat_source = "0";
  double energy_supg = 0.25;
  void options(OptionGroup& option);
};

/// Temperature of the incompressible fluid (docs/theory/energy.md):
///   alpha rho c_p (dT/dt + u.grad T) = div(alpha lambda grad T) + q + particles                               (E1)
/// solved after the velocity of the same step, by BDF1 or BDF2 with the same history, P1 or Q1, streamline stabilised.
/// Constants are kept exactly whatever the flow; what leaves through boundaries, particles and sources is what the
/// fluid loses, to the tolerances of flow and temperature. Buoyancy (Boussinesq) acts on the next velocity through the
/// extrapolated temperature.
class EnergyEquation {
 public:
  /// Null without `-fluid_energy yes`; throws UserError when options of the energy equation are given without it.
  static std::unique_ptr<EnergyEquation> create(const Mesh& mesh, Options& options, bool wanted, double density,
                                                const Vec3& gravity, const BoundaryConditions& boundaries,
                                                int table_order);
  EnergyEquation(const Mesh& mesh, Options& options, double density, const Vec3& gravity,
                 const BoundaryConditions& boundaries, int table_order);

  bool buoyant() const { return options_.expansion != 0 && gravity_.norm() > 0; }
  /// Adds the Boussinesq force -alpha rho expansion (T - T_reference) g at the end of the step to force [nodes][3] N/m3
  /// (without alpha in model B, like the weight). T is extrapolated.
  void add_buoyancy(const Bdf& bdf, const std::vector<double>& void_fraction, bool model_a,
                    std::vector<double>& force) const;

  /// Points of a cell at which solve() wants the flux.
  int points() const { return transport_.points(); }
  /// Finds the temperature at time + dt; accept() makes it the present one. `flux` [cells][points()][3] m/s is the
  /// superficial velocity that satisfies the continuity equation, `outflow` [nodes] m3/s int N_i U.n over the whole
  /// boundary, consistent on shared nodes. `eddy_conductivity` [cells] W/(m K) is what turbulence adds. Returns the
  /// linear iterations; throws SolveFailure. Collective.
  int solve(double time, const Bdf& bdf, double dt, const ParticleLoad& load, const std::vector<double>& flux,
            const std::vector<double>& outflow, const std::vector<double>* eddy_conductivity = nullptr);
  void accept();

  /// Replaces the initial temperature, [nodes] K.
  void set_initial(const std::vector<double>& temperature) {
    temperature_ = old_temperature_ = next_ = outside_ = temperature;
  }
  std::span<const double> temperature() const { return temperature_; }
  std::span<const double> temperature_change() const { return change_; }
  /// W per boundary, heat that left through it in the last step: conducted, and carried by the flow relative to the
  /// reference temperature.
  const std::vector<double>& heat_flow() const { return heat_flow_; }
  /// J, int rho c_p alpha (T - T_reference). Collective.
  double heat() const;
  /// W, given sources in the last step.
  double source() const { return source_total_; }
  void add_state(std::vector<Fluid::StateArray>& arrays);

 private:
  const Mesh& mesh_;
  EnergyOptions options_;
  double density_;
  Vec3 gravity_;
  const BoundaryConditions& boundaries_;
  Expression source_;
  ScalarTransport transport_;
  TemperatureBoundaries conditions_;
  std::vector<double> mass_;  ///< [nodes] m3, lumped

  std::vector<double> temperature_, old_temperature_, next_, change_;
  std::vector<double> outside_;  ///< [nodes] K, at the start: of what comes in where nothing else is given
  std::vector<double> void_fraction_, old_void_fraction_, next_void_fraction_;  ///< of steps n, n-1, n+1
  std::vector<double> started_;                                                 ///< [nodes] 1 after the first step
  std::vector<double> heat_flow_;
  double source_total_ = 0;
};

}  // namespace silt
