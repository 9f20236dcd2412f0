#pragma once
#include <optional>

#include "base/expression.hpp"
#include "base/nodal_gradient.hpp"
#include "fluid/boundary/facets.hpp"
#include "fluid/fluid.hpp"
#include "fluid/fluid_options.hpp"
#include "fluid/turbulence/turbulence.hpp"

namespace silt {

/// The options `-fluid_...` of a flow that is given, not solved.
struct PrescribedOptions {
  std::string velocity = "0, 0, 0", pressure = "0", temperature;
  std::string turbulent_energy, turbulent_dissipation;
  double heat_capacity = 0, conductivity = 0;
  void options(OptionGroup& option) {
    option("velocity", velocity, "m/s, formulas in x, y, z, t: the velocity of a prescribed fluid");
    option("pressure", pressure, "Pa, formula in x, y, z, t: the pressure of a prescribed fluid");
    option("temperature", temperature, "K, formula in x, y, z, t: the temperature of a prescribed fluid");
    option("turbulent_energy", turbulent_energy,
           "m2/s2, formula in x, y, z, t: k of a prescribed fluid, for turbulent dispersion");
    option("turbulent_dissipation", turbulent_dissipation,
           "m2/s3, formula in x, y, z, t: epsilon of a prescribed fluid, for turbulent dispersion");
    option("heat_capacity", heat_capacity, "J/(kg K)", "specific heat capacity of the fluid", non_negative);
    option("conductivity", conductivity, "W/(m K)", "heat conductivity of the fluid", non_negative);
  }
};

/// `-fluid_type prescribed`: velocity, pressure and void fraction by formulas at the mesh nodes. Particles feel it as
/// they feel a solved flow; what they do to it changes nothing, and is accounted for all the same. For flows that are
/// known, and for tests of every force without a solution. `-fluid_turbulence` solves for the turbulence in it.
class Prescribed final : public Fluid {
 public:
  Prescribed(const Mesh& mesh, Options& options, const FluidOptions& fluid);

  FluidStep advance(double time, double dt) override;
  double courant_rate() const override;
  std::span<const double> velocity() const override { return velocity_; }
  std::span<const double> velocity_change() const override { return change_; }
  std::span<const double> pressure() const override { return pressure_; }
  std::span<const double> pressure_gradient() const override { return pressure_gradient_; }
  std::span<const double> given_void_fraction() const override { return void_fraction_; }
  std::span<const double> turbulent_energy() const override {
    return turbulence_ ? Fluid::turbulent_energy() : turbulent_energy_;
  }
  std::span<const double> turbulent_dissipation() const override {
    return turbulence_ ? Fluid::turbulent_dissipation() : turbulent_dissipation_;
  }
  std::span<const double> temperature() const override { return temperature_; }
  std::span<const double> temperature_change() const override { return temperature_change_; }
  const Turbulence* turbulence() const override { return turbulence_.get(); }
  std::vector<Scalar> scalars() const override;
  std::vector<BoundaryFlow> boundary_flow() const override;
  std::vector<StateArray> state() override;
  void restored() override;

 private:
  void evaluate(double time);
  void make_turbulence(Options& options, const std::string& velocity);
  Turbulence::Flow turbulent_flow() const;
  /// Returns the linear iterations.
  int solve_turbulence(double time, double dt);

  const Mesh& mesh_;
  VectorExpression velocity_formula_;
  Expression pressure_formula_;
  std::optional<Expression> void_fraction_formula_, temperature_formula_, energy_formula_, dissipation_formula_;
  std::vector<double> mass_;
  NodalGradient gradient_;
  std::vector<FacetRule> facets_;
  int order_;
  std::unique_ptr<BoundaryConditions> boundaries_;  ///< of the turbulence
  std::unique_ptr<Turbulence> turbulence_;
  std::vector<double> past_;  ///< [nodes][2] steps taken (up to 3), s of the last one; of the turbulence
  std::vector<double> density_field_, viscosity_field_;
  std::vector<double> velocity_, change_, pressure_, pressure_gradient_, void_fraction_, temperature_,
      temperature_change_, turbulent_energy_, turbulent_dissipation_;
};

}  // namespace silt
