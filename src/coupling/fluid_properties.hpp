#pragma once
#include <vector>

#include "coupling/filter.hpp"
#include "coupling/kernel.hpp"
#include "fluid/fluid.hpp"

namespace silt {

/// Density, viscosity, conductivity and speed of sound of the fluid at each particle: the fluid's constants, or its
/// fields seen through the same filter and weights as its velocity.
class FluidProperties {
 public:
  FluidProperties(const Mesh& mesh, const Fluid& fluid) : mesh_(mesh), fluid_(fluid) {}
  /// Looks at the fluid from where the kernel has the particles. Collective.
  void sample(const Filter& filter, const Kernel& kernel);

  double density(int p) const { return varies_ ? values_[3 * static_cast<std::size_t>(p)] : fluid_.density(); }
  double viscosity(int p) const { return varies_ ? values_[3 * static_cast<std::size_t>(p) + 1] : fluid_.viscosity(); }
  /// W/(m K); that of a gas follows its viscosity (constant Prandtl number).
  double conductivity(int p) const {
    return varies_ ? fluid_.conductivity() * viscosity(p) / fluid_.viscosity() : fluid_.conductivity();
  }
  /// Of a relative speed; 0 for an incompressible fluid.
  double mach(int p, double speed) const { return varies_ ? speed / values_[3 * static_cast<std::size_t>(p) + 2] : 0; }

 private:
  const Mesh& mesh_;
  const Fluid& fluid_;
  bool varies_ = false;
  std::vector<double> nodal_, values_;
};

}  // namespace silt
