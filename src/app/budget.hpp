#pragma once
#include <string>
#include <vector>

#include "app/moment.hpp"
#include "base/csv.hpp"
#include "base/output_directory.hpp"
#include "coupling/coupling.hpp"
#include "coupling/exchange.hpp"

namespace silt {

/// The options `-ledger_...`.
struct LedgerOptions {
  double tolerance = 1e-10, mass_tolerance = 1e-2;
  void options(OptionGroup& option);
};

/// The conservation ledger, `ledger.csv`, a row a step (N s unless said otherwise):
///  - exchange_residual: largest imbalance between what fluid and particles gave each other and of the particle volume
///    in the void fraction, relative to the magnitudes that were summed (ExchangeLedger);
///  - particle_residual: |change of the particles' momentum - impulses of gravity, walls, applied fields, drag, other
///  fluid forces,
///    kicks, insertion and removal|, relative to those impulses, to what fields made particles give each other and to
///    sqrt(2 M E), the size of the momenta summed;
///  - taken_residual: what the particles say they received from the fluid against what the coupling gave, same scale;
///  - mass_residual: the fluid's volume balance as the fluid reports it, relative to what comes in (FluidStep); it is
///    as small as the solver's tolerance, and above `-ledger_mass_tolerance` it stops the run;
///  - unaccounted_*: change of the fluid's momentum less the impulses through the boundary and of the particles; it
///    holds the time scheme's and the stabilisation's share and is no residual.
///  - of a gas, J: fluid_energy (internal and kinetic), energy_supply (boundaries and gravity, in the step),
///  energy_from_particles (work, heat and displacement), unaccounted_energy: what they leave of the change, the share
///  of the solver's tolerance and, with BDF2, of the time scheme; energy_in_transit: work done on the particles that
///  the gas is charged with in the next step; particle_energy: kinetic, of translation and spin.
///  - particle_mass, added_mass, removed_mass (kg): what is there, and what came and went in the step; its residual is
///    part of particle_residual.
/// The first three above `-ledger_tolerance` stop the run.
class Budget {
 public:
  Budget(Options& options, bool with_fluid, bool with_particles);
  /// Opens the file and takes the starting momenta. Collective.
  void start(const OutputDirectory& directory, const Fluid* fluid, Particles* particles);
  /// Closes the account of the step that led to `moment`: writes a row and returns the largest of the gated residuals.
  /// Throws RunError on every rank when out of balance. Collective.
  double close(const Moment& moment, Particles* particles, const ExchangeAccounts& exchanged);

  /// What the account of the next step opens with on the fluid's side: its momentum (N s) and a gas's energy (J), once
  /// a step has told them. A run that goes on takes it over from the one before.
  struct Opening {
    bool known = false;
    Vec3 momentum = Vec3::Zero();
    double energy = 0;
  };
  const Opening& opening() const { return fluid_; }
  void open_with(const Opening& opening) { fluid_ = opening; }

 private:
  static double energy_from(const ExchangeAccounts& exchanged);

  LedgerOptions options_;
  bool with_fluid_, with_particles_, with_energy_ = false;
  CsvWriter table_;
  Opening fluid_;
  Vec3 particle_momentum_ = Vec3::Zero();
  double particle_mass_ = 0;
};

}  // namespace silt
