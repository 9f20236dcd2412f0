#pragma once
#include <memory>
#include <optional>

#include "base/expression.hpp"
#include "base/models.hpp"
#include "base/options.hpp"
#include "particles/contact_lists.hpp"
#include "particles/materials.hpp"
#include "particles/store.hpp"
#include "particles/wall_contacts.hpp"
#include "particles/walls/walls.hpp"

namespace silt {

/// What `-heat_...` switches on.
inline constexpr SwitchedModel heat_models[] = {
    {"convection",
     "heat_particles yes",
     {"(7.95-7.96)", "Newton 1701", "Q = h A (T_f - T), h = Nu lambda/d", "cooling of a sphere, any step (MFiX)"}},
    {"source", "heat_source", {"(7.95)", "", "m c_p dT/dt = q V", "warming of a sphere"}},
    {"conduction",
     "heat_conduction yes",
     {"", "Batchelor & O'Brien 1977",
      "Q_ij = 4 a (T_j - T_i)/(1/l_i + 1/l_j), a = (R_eff x)^0.5 or of the lens, times (E/E_real)^0.2; j a sphere or a "
      "wall",
      "two spheres that even out (MFiX), a sphere on a warm wall"}},
    {"radiation",
     "heat_emissivity",
     {"", "Stefan 1879; Boltzmann 1884", "Q = e sigma A (T_env^4 - T^4)", "cooling of a glowing sphere"}},
};

/// The options `-heat_...` of the particles.
struct HeatOptions {
  bool particles = false, conduction = false;
  std::string initial_temperature = "293.15", source = "0", environment = "293.15", contact_radius = "hertz";
  double emissivity = 0;
  std::optional<double> real_young_modulus;
  void options(OptionGroup& option) {
    option("particles", particles, "particles have a temperature");
    option("initial_temperature", initial_temperature, "K, formula in x, y, z: temperature of new particles");
    option("source", source, "W/m3 of particle, formula in x, y, z, t: heat made in the particles");
    option("conduction", conduction,
           "particles that touch each other, or a wall with a temperature, conduct heat (Batchelor & O'Brien 1977)");
    option("contact_radius", contact_radius, {"hertz", "lens"},
           "radius of a contact: hertz, (R_eff x)^1/2; lens, of the circle in which the spheres intersect");
    option("real_young_modulus", real_young_modulus, "Pa",
           "Young's modulus of the real material where the particles are softer: contact radii are reduced by "
           "(E/E_real)^1/5",
           positive);
    option("emissivity", emissivity, "-", "of the particles, for radiation to the environment; 0: none", fraction);
    option("environment", environment, "K, formula in x, y, z, t: temperature that particles radiate to");
  }
};

/// Temperature of the particles (7.95, H1). What the fluid gives is set by the coupling and relaxed exactly within each
/// substep; the rest is taken at its start.
///
/// Columns: "temperature" (K), "fluid_temperature" (K) and "heat_exchange" (h A, W/K), constant over a fluid step, and
/// "heat_received" (J) from the fluid since somebody reset it.
class ParticleHeat {
 public:
  /// Null unless `-heat_particles yes`.
  static std::unique_ptr<ParticleHeat> create(Options& options, const Materials& materials, Columns& columns);
  ParticleHeat(const HeatOptions& options, const Materials& materials, Columns& columns);

  /// Throws UserError where particles of this material cannot have a temperature; one of walls alone needs no heat
  /// capacity.
  void check(int material) const;
  bool conducts() const { return options_.conduction; }
  /// Throws UserError for a wall that has a temperature but cannot conduct.
  void check(const Walls& walls) const;
  /// Moves the temperatures of this rank's particles on by dt, up to `time`.
  void advance(Store& store, const ContactLists& contacts, const WallContacts& at_walls, const Walls& walls,
               const Periods& periods, double time, double dt);
  /// J, what each wall gave to this rank's particles since restart_account().
  const std::vector<double>& from_walls() const { return from_walls_; }
  void restart_account(int walls) { from_walls_.assign(static_cast<std::size_t>(walls), 0.0); }
  /// J/K, m c_p of a particle.
  double capacity(const Store& store, int p) const {
    const auto material = static_cast<int>(store.rotation[p].material);
    return materials_[material].heat_capacity.value_or(0) / store.motion[p].inverse_mass;
  }
  /// K, of this rank's particles.
  const double* temperatures(const Store& store) const { return store.columns.values(temperature_); }
  /// s, in which conduction between the smallest particles that overlap by a tenth of their radius would even out.
  double conduction_time(double radius, int material) const;

 private:
  void conduct(Store& store, const ContactLists& contacts, const Periods& periods);
  void conduct_from_walls(Store& store, const WallContacts& at_walls, const Walls& walls, double time, double dt);
  /// W/K, through a contact of a spot of this area (over pi, m2) between the materials.
  double conductance(double area, int first, int second) const;

  HeatOptions options_;
  const Materials& materials_;
  Expression source_, environment_;
  std::shared_ptr<Expression> initial_;
  int temperature_, fluid_temperature_, exchange_, received_;
  std::vector<double> gain_;  ///< [owned + ghosts + 2] W
  std::vector<double> from_walls_;
};

}  // namespace silt
