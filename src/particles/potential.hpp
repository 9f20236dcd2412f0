#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/locator.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"

namespace silt {

/// `-boundary_<name>_potential`.
struct PotentialBoundaryOptions {
  std::string potential;
  void options(OptionGroup& option) {
    option("potential", potential,
           "V, formula in x, y, z: electric potential of the boundary (-electric_solve); without it no field line ends "
           "there");
  }
};

/// Electric field on the mesh: -div(eps grad phi) = rho with phi given on boundaries, linear elements, solved once by
/// conjugate gradients with algebraic multigrid (PETSc prefix `electric_`). E = -grad phi at the nodes, of second
/// order, and its gradient in the same way.
class ElectricPotential {
 public:
  /// Throws UserError when no boundary has a potential. Collective.
  ElectricPotential(const Mesh& mesh, Options& options, double permittivity, const std::string& charge_density);

  /// E and gradient(k, d) = dE_k/dx_d at x, near the local cell `hint`. Local.
  void at(const double* x, int hint, Vec3& field, Mat3& gradient) const;
  /// V/m, the largest |E| at the nodes. Collective.
  double strongest() const;
  const std::vector<double>& values() const { return potential_; }  ///< [nodes] V

 private:
  void fix_boundaries(Options& options);
  void solve(double permittivity, const std::vector<double>& charge);

  const Mesh& mesh_;
  Locator locator_;
  std::vector<char> fixed_;
  std::vector<double> potential_, field_, slope_;  ///< [nodes], [nodes][3], [nodes][3][3]
};

}  // namespace silt
