#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/options.hpp"

namespace silt {

/// The options `-material_<name>_...`.
struct Material {
  std::string name;
  std::optional<double> density;
  double young_modulus = 1e7, poisson_ratio = 0.3;
  double restitution = 0.9, friction = 0.3, rolling_friction = 0;
  std::optional<double> yield_pressure;
  std::optional<double> heat_capacity, conductivity;
  double surface_energy = 0, hamaker = 0, surface_potential = 0;
  void options(OptionGroup& option) {
    option("density", density, "kg/m3", "density of the material; has no default", positive);
    option("young_modulus", young_modulus, "Pa", "Young's modulus E", positive);
    option("poisson_ratio", poisson_ratio, "-", "Poisson's ratio", between(0, 0.5));
    option("restitution", restitution, "-", "normal coefficient of restitution e", Range{0, 1, true, false});
    option("friction", friction, "-", "Coulomb friction coefficient mu", non_negative);
    option("rolling_friction", rolling_friction, "-", "rolling friction coefficient mu_r", non_negative);
    option("yield_pressure", yield_pressure, "Pa",
           "contact pressure at yield p_y (normal law thornton); default: elastic", positive);
    option("heat_capacity", heat_capacity, "J/(kg K)", "specific heat capacity, for particles with a temperature",
           positive);
    option("conductivity", conductivity, "W/(m K)", "heat conductivity, for heat through contacts", positive);
    option("surface_energy", surface_energy, "J/m2", "surface energy g (adhesion); of a pair: the geometric mean",
           non_negative);
    option("hamaker", hamaker, "J", "Hamaker constant A (dlvo); of a pair: the geometric mean", non_negative);
    option("surface_potential", surface_potential, "V", "potential psi0 of the surface (dlvo)");
  }
};

/// The options `-pair_<a>_<b>_...`: what overrides the mean of two materials.
struct PairOverride {
  std::optional<double> restitution, friction, rolling_friction, yield_pressure, surface_energy, hamaker;
  void options(OptionGroup& option) {
    option("restitution", restitution, "-", "normal coefficient of restitution of this pair", Range{0, 1, true, false});
    option("friction", friction, "-", "Coulomb friction coefficient of this pair", non_negative);
    option("rolling_friction", rolling_friction, "-", "rolling friction coefficient of this pair", non_negative);
    option("yield_pressure", yield_pressure, "Pa", "contact pressure at yield of this pair", positive);
    option("surface_energy", surface_energy, "J/m2", "g of this pair, half its work of adhesion", non_negative);
    option("hamaker", hamaker, "J", "Hamaker constant of this pair");
  }
};

/// What a contact law knows of the two materials that touch.
struct PairProperties {
  double effective_young;  ///< Pa, 1/E_eff = (1-s_i^2)/E_i + (1-s_j^2)/E_j (7.13)
  double effective_shear;  ///< Pa, 1/G_eff = (2-s_i)/G_i + (2-s_j)/G_j (7.35)
  double poisson_ratio;    ///< mean
  double restitution, friction, rolling_friction;
  double yield_pressure;                                  ///< Pa, the smaller; infinity where both are elastic
  double surface_energy;                                  ///< J/m2, half the work of adhesion
  double hamaker;                                         ///< J
  double potential_product, potential_squares;            ///< V2, psi_i psi_j and psi_i^2 + psi_j^2
  double least_share = 0.5;                               ///< of a step's slip before a spring is read (share_of_step)
  double smallest_radius = infinity, largest_radius = 0;  ///< m, effective, of the particles of the run
};

/// All materials of the run and the properties of every pair of them.
class Materials {
 public:
  /// Reads every `-material_<name>_...` and `-pair_<a>_<b>_...`; throws UserError for a material without a density and
  /// for a pair of unknown materials.
  explicit Materials(Options& options);

  int count() const { return static_cast<int>(materials_.size()); }
  const Material& operator[](int i) const { return materials_[i]; }
  /// Symmetric in a and b.
  const PairProperties& pair(int a, int b) const { return pairs_[a * count() + b]; }
  /// The first option by which the user gave a restitution, "" where all are the default.
  const std::string& restitution_given() const { return restitution_given_; }

 private:
  std::vector<Material> materials_;
  std::vector<PairProperties> pairs_;
  std::string restitution_given_;
};

}  // namespace silt
