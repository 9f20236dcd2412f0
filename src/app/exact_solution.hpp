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
  std::string velocity, pressure, temperature;
  void options(OptionGroup& option) {
    option("velocity", velocity,
           "m/s, formulas in x, y, z, t: the exact velocity; the error of the computed one is recorded every step in "
           "errors.csv (velocity_error: root of its mean square over the domain)");
    option("pressure", pressure,
           "Pa, formula in x, y, z, t: the exact pressure (pressure_error; the mean difference is taken out when no "
           "boundary fixes the pressure)");
    option("temperature", temperature, "K, formula in x, y, z, t: the exact temperature (temperature_error)");
  }
};

/// The distance of the computed fields from a known solution: root of the mean square of the difference over the
/// domain, by a quadrature of degree 5 of the elements' own functions.
class ExactSolution {
 public:
  /// Throws UserError for a field that the fluid has not. `fluid` may be null.
  ExactSolution(const Mesh& mesh, Options& options, const Fluid* fluid);
  /// Names of the errors: velocity_error, pressure_error, temperature_error, as asked for.
  const std::vector<std::string>& columns() const { return columns_; }
  void start(const OutputDirectory& directory);
  /// Collective.
  void sample(const Moment& moment, Quantities& quantities);

 private:
  std::vector<double> measure(const Moment& moment) const;

  const Mesh& mesh_;
  std::vector<std::string> columns_;
  std::optional<VectorExpression> velocity_;
  std::optional<Expression> pressure_, temperature_;
  bool free_pressure_ = true;
  CsvWriter table_;
};

}  // namespace silt
