#pragma once
#include <string>
#include <vector>

#include "base/expression.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"
#include "fluid/turbulence/turbulence_options.hpp"

namespace silt {

/// k and the second quantity (epsilon or omega) that a model with two equations starts from: those of
/// `-fluid_initial_file`, of whichever of the two models (epsilon = C_mu k omega), or the formulas
/// `-fluid_initial_turbulent_energy` and `-fluid_initial_viscosity_ratio`.
class InitialTurbulence {
 public:
  /// `dissipation`: the second quantity is epsilon, else omega. Throws UserError when neither a file nor a formula
  /// gives k, or both do. Collective.
  InitialTurbulence(const Mesh& mesh, Options& options, const TurbulenceOptions& read, bool dissipation);

  bool from_file() const { return !k_.empty(); }
  /// m2/s2 and the unit of the second quantity, [nodes]; empty when formulas give them.
  const std::vector<double>& k() const { return k_; }
  const std::vector<double>& second() const { return second_; }
  /// m2/s2 and eddy viscosity over viscosity by the formulas.
  double energy(const Vec3& x) const;
  double viscosity_ratio(const Vec3& x) const;

 private:
  Expression energy_, ratio_;
  std::vector<double> k_, second_;
};

}  // namespace silt
