#pragma once
#include <memory>

#include "base/models.hpp"
#include "particles/field/clausius_mossotti.hpp"
#include "particles/field/given_field.hpp"
#include "particles/force_field.hpp"
#include "particles/pair_sums.hpp"
#include "particles/potential.hpp"

namespace silt {

/// What `-electric_...` switches on.
inline constexpr SwitchedModel electric_models[] = {
    {"dc",
     "electric_type dc",
     {"(7.65-7.70)", "Pohl 1978; Jones 1995",
      "F = Q E + grad(p.E), M = p_0 x E, p = p_0 + (pi/2) e_f K d^3 E, K = (e_p - e_f)/(e_p + 2 e_f), or of "
      "conductivities",
      "forces of uniform and parabolic fields; a dipole that swings; both signs of K"}},
    {"ac",
     "electric_type ac",
     {"(7.71-7.76)", "Pohl 1978; Jones 1995",
      "F = (pi/4) e_f d^3 Re K grad(E_rms^2), M = -(pi/2) e_f d^3 Im K E_rms^2 n, K(w) = [e_p - e_f - j (l_p - "
      "l_f)/w]/[e_p "
      "+ 2 e_f - j (l_p + 2 l_f)/w]",
      "both limits of K and the time t_MW between them; speed of drift and of rotation"}},
    {"coulomb",
     "electric_coulomb yes",
     {"", "Coulomb 1785", "F = Q_i Q_j/(4 pi e_f r^2), all pairs or up to a cut-off", "two charges fly apart"}},
    {"solved",
     "electric_solve yes",
     {"", "Jackson 1975", "-div(e_f grad phi) = rho on the mesh, E = -grad phi",
      "order 2 of potential and field; force in a coaxial cell"}},
};

/// The options `-electric_...`.
struct ElectricOptions {
  std::string type = "none", field = "0, 0, 0", charge = "0", polarisation = "permittivity";
  Vec3 dipole = Vec3::Zero(), rotation = Vec3::Zero();
  double particle_permittivity = 1, fluid_permittivity = 1, particle_conductivity = 0, fluid_conductivity = 0;
  double frequency = 0, cutoff = 0;
  bool coulomb = false, solve = false;
  std::string charge_density = "0";
  void options(OptionGroup& option) {
    option("type", type, {"none", "dc", "ac"},
           "dc: charges and dipoles in a constant or slow field; ac: the mean force "
           "of a field that alternates fast");
    option("field", field, "V/m, formulas in x, y, z, t: the applied field; with ac its root mean square");
    option("charge", charge, "C, formula in x, y, z: charge of new particles");
    option("dipole", dipole, "C m", "permanent dipole moment, which turns with the particle (dc)");
    option("polarisation", polarisation, {"permittivity", "conductivity"},
           "whether permittivities or conductivities decide the induced dipole in a constant field (dc)");
    option("particle_permittivity", particle_permittivity, "-", "relative permittivity of the particles", positive);
    option("fluid_permittivity", fluid_permittivity, "-", "relative permittivity of the fluid", positive);
    option("particle_conductivity", particle_conductivity, "S/m", "electric conductivity of the particles",
           non_negative);
    option("fluid_conductivity", fluid_conductivity, "S/m", "electric conductivity of the fluid", non_negative);
    option("frequency", frequency, "Hz", "of the alternating field (ac)", non_negative);
    option("rotation", rotation, "-", "axis about which the field turns (ac): it turns the particles; 0, 0, 0: none");
    option("solve", solve,
           "solve for the field of the boundaries' potentials (-boundary_<name>_potential), besides field");
    option("charge_density", charge_density, "C/m3, formula in x, y, z: charge in the fluid (solve)");
    option("coulomb", coulomb, "charged particles act on each other");
    option("cutoff", cutoff, "m", "charges further apart do not act on each other; 0: all do", non_negative);
  }
};

/// Charged and polarisable particles in an electric field that is given, or solved for on the mesh, or the sum of both
/// (7.65-7.76); charges act on each other. Formulas: `electric_models`. Columns "charge" (C), and "electric_moment" (C
/// m) where there is a permanent dipole.
class Electric final : public ForceField {
 public:
  /// Null for `-electric_type none`.
  static std::unique_ptr<Electric> create(Options& options, const Mesh& mesh, Columns& columns,
                                          const std::string& instructions);
  Electric(const ElectricOptions& chosen, Options& options, const Mesh& mesh, Columns& columns,
           const std::string& instructions);
  void act(FieldStep& step) override;
  bool turns() const override { return moment_ >= 0; }
  void turn(Store& store, const double (*turned)[4]) override;
  std::vector<StepBound> bounds(const Materials& materials, const SmallestRadii& smallest) const override;
  std::vector<std::string> warnings(const Materials& materials, const SmallestRadii& smallest) const override {
    return cutoff_warnings("electric_cutoff", options_.coulomb ? options_.cutoff : 0, 2, materials, smallest);
  }
  std::string description() const override;
  double real_factor() const { return real_; }
  double imaginary_factor() const { return imaginary_; }

 private:
  void repel(FieldStep& step);

  ElectricOptions options_;
  GivenField field_;
  FieldRange range_;                              ///< V/m, of the given field and the one solved for
  std::unique_ptr<ElectricPotential> potential_;  ///< null: the field is given
  std::shared_ptr<Expression> charge_formula_;
  double permittivity_, real_ = 0, imaginary_ = 0, largest_charge_ = 0;  ///< largest: C, as sampled
  int charge_ = -1, moment_ = -1;
  const PairKernels& kernels_;
  PairSources sources_;
  PairSums sum_;
};

}  // namespace silt
