#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/moment.hpp"
#include "base/expression.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"
#include "base/output_directory.hpp"

namespace silt {

/// The options `-exact_...`.
struct ExactOptions {
  std::string velocity, pressure, temperature, density;
  std::string turbulent_energy, turbulent_dissipation, specific_dissipation;
  std::string norm = "root_mean_square";
  void options(OptionGroup& option) {
    option("velocity", velocity,
           "m/s, formulas in x, y, z, t: the exact velocity; the error of the computed one is recorded every step in "
           "errors.csv (velocity_error, over the domain as -exact_norm says)");
    option("pressure", pressure,
           "Pa, formula in x, y, z, t: the exact pressure (pressure_error; the mean difference is taken out when no "
           "boundary fixes the pressure)");
    option("temperature", temperature, "K, formula in x, y, z, t: the exact temperature (temperature_error)");
    option("density", density, "kg/m3, formula in x, y, z, t: the exact density of a gas (density_error)");
    option("turbulent_energy", turbulent_energy,
           "m2/s2, formula in x, y, z, t: the exact k of a turbulence model (turbulent_energy_error)");
    option("turbulent_dissipation", turbulent_dissipation,
           "m2/s3, formula in x, y, z, t: the exact epsilon of a model that has it (turbulent_dissipation_error)");
    option("specific_dissipation", specific_dissipation,
           "1/s, formula in x, y, z, t: the exact omega of a model that has it (specific_dissipation_error)");
    option("norm", norm, {"root_mean_square", "mean"},
           "what the errors are: root of the mean square of the difference, or the mean of its magnitude (flows with "
           "shocks)");
  }
};

/// The distance of the computed fields from a known solution: root of the mean square of the difference over the
/// domain, or mean of its magnitude, by a quadrature of degree 5 of the elements' own functions.
class ExactSolution {
 public:
  /// Throws UserError for a field that the fluid has not. `fluid` may be null.
  ExactSolution(const Mesh& mesh, Options& options, const Fluid* fluid);
  /// Names of the errors, <field>_error, as asked for.
  const std::vector<std::string>& columns() const { return columns_; }
  void start(const OutputDirectory& directory);
  /// Collective.
  void sample(const Moment& moment, Quantities& quantities);

 private:
  struct Field {
    std::string name;
    Expression exact;
    bool up_to_a_constant;
  };
  std::vector<double> measure(const Moment& moment) const;
  static std::span<const double> values(const Fluid& fluid, const std::string& name);

  const Mesh& mesh_;
  std::vector<std::string> columns_;
  std::optional<VectorExpression> velocity_;
  std::vector<Field> fields_;
  bool mean_ = false;
  CsvWriter table_;
};

}  // namespace silt
