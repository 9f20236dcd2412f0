#pragma once
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "base/expression.hpp"
#include "base/models.hpp"
#include "base/nodal_gradient.hpp"
#include "base/physical_constants.hpp"
#include "coupling/filter.hpp"
#include "coupling/fluid_properties.hpp"
#include "coupling/kernel.hpp"
#include "fluid/fluid.hpp"
#include "particles/particles.hpp"

namespace silt {

/// The gas around a particle, as a thermophoretic force needs it. Each law gives the factor of -grad T, N m/K.
struct GasAround {
  double diameter, density, viscosity, temperature;  ///< m, kg/m3, Pa s, K
  double mean_free_path;                             ///< m
  double conductivity_ratio;                         ///< k, gas over particle
  double molecule;                                   ///< kg, mass of a gas molecule
  /// m/s, mean speed c of the molecules.
  double speed() const { return std::sqrt(8 * boltzmann_constant * temperature / (std::numbers::pi * molecule)); }
  /// W/(m K), l_tr, of the molecules' translation.
  double translational_conductivity() const { return 15.0 / 4 * boltzmann_constant * viscosity / molecule; }
  double knudsen() const { return mean_free_path / diameter; }
};

struct NoThermophoresis {
  static constexpr const char* name = "none";
  static constexpr ModelNote note = {"", "", "F = 0", ""};
  void options(OptionGroup&) {}
  double factor(const GasAround&) const { return 0; }
};

/// Particles much smaller than the mean free path (7.81), Waldmann 1959.
struct WaldmannThermophoresis {
  static constexpr const char* name = "waldmann";
  static constexpr ModelNote note = {
      "(7.81)", "Waldmann 1959", "F = -(8/15) d^2 (l_tr/c) grad T, c = (8 k_B T/(pi m_g))^1/2, l_tr = 15/4 k_B mu/m_g",
      "its value; drift speed"};
  void options(OptionGroup&) {}
  double factor(const GasAround& gas) const {
    return 8.0 / 15 * gas.diameter * gas.diameter * gas.translational_conductivity() / gas.speed();
  }
};

/// Any Knudsen number with a function of the user's choice (7.82).
struct GeneralThermophoresis {
  static constexpr const char* name = "general";
  static constexpr ModelNote note = {"(7.82)", "Waldmann 1959 (limit)",
                                     "F = -(pi^1/2/8) (l_tr d^2/c) h(Kn, k) grad T, h = 64/(15 pi^1/2) unless given",
                                     "Waldmann's limit; drift speed"};
  std::string h = "64/(15*sqrt(pi))";
  void options(OptionGroup& option) {
    option("h", h, "formula in x = Kn = lambda/d and y = k, gas over particle conductivity");
    formula = std::make_shared<Expression>(option.full("h"), h);
  }
  std::shared_ptr<Expression> formula;
  double factor(const GasAround& gas) const {
    return std::sqrt(std::numbers::pi) / 8 * gas.translational_conductivity() * gas.diameter * gas.diameter /
           gas.speed() * (*formula)(Vec3(gas.knudsen(), gas.conductivity_ratio, 0), 0);
  }
};

/// All Knudsen numbers by interpolation (7.83), Talbot et al. 1980.
struct TalbotThermophoresis {
  static constexpr const char* name = "talbot";
  static constexpr ModelNote note = {"(7.83)", "Talbot et al. 1980",
                                     "F = -6 pi mu^2 d C_s (k + 2 C_t Kn)/(rho T (1 + 6 C_m Kn)(1 + 2k + 4 C_t Kn)) "
                                     "grad T, Kn = lambda/d, C_s = 1.17, C_t = 2.18, C_m = 1.14",
                                     "force at d 0.1, 1, 10 um; drift speed"};
  void options(OptionGroup&) {}
  double factor(const GasAround& gas) const {
    constexpr double slip = 1.17, jump = 2.18, momentum = 1.14;
    const double kn = gas.knudsen(), k = gas.conductivity_ratio;
    return 6 * std::numbers::pi * gas.viscosity * gas.viscosity * gas.diameter * slip * (k + 2 * jump * kn) /
           (gas.density * gas.temperature * (1 + 6 * momentum * kn) * (1 + 2 * k + 4 * jump * kn));
  }
};

using ThermophoresisModels =
    Models<NoThermophoresis, WaldmannThermophoresis, GeneralThermophoresis, TalbotThermophoresis>;

/// The options `-thermophoresis_...` of all laws.
struct ThermophoresisOptions {
  double mean_free_path = 6.7e-8, conductivity_ratio = 0.026, molar_mass = 0.02896;
  void options(OptionGroup& option) {
    option("mean_free_path", mean_free_path, "m", "mean free path lambda of the gas", positive);
    option("conductivity_ratio", conductivity_ratio, "-", "k, heat conductivity of the gas over the particles'",
           positive);
    option("molar_mass", molar_mass, "kg/mol", "of the gas", positive);
  }
};

/// Thermophoresis in the fluid's temperature field, solved or prescribed; the fluid gets the opposite force.
class Thermophoresis {
 public:
  /// Null for `-thermophoresis_type none`; throws UserError when the fluid has no temperature.
  static std::unique_ptr<Thermophoresis> create(const Mesh& mesh, const std::vector<double>& mass, const Fluid& fluid,
                                                Options& options);
  Thermophoresis(const Mesh& mesh, const std::vector<double>& mass, ThermophoresisModels::Any law,
                 const ThermophoresisOptions& options);
  std::string name() const;
  /// Adds to force and reaction of every FluidAction. Collective.
  void act(const Fluid& fluid, const FluidProperties& properties, const Filter& filter, const Kernel& kernel,
           Particles& particles);

 private:
  const Mesh& mesh_;
  ThermophoresisModels::Any law_;
  ThermophoresisOptions options_;
  NodalGradient gradient_;
  std::vector<double> slope_, nodal_, at_particles_;
};

}  // namespace silt
