#pragma once
#include <string>

#include "base/options.hpp"
#include "fluid/turbulence/dilatation_dissipation.hpp"

namespace silt {

/// The options `-fluid_turbulence...` and the initial state of the turbulence.
struct TurbulenceOptions {
  std::string turbulence = "none";
  std::string wall = "automatic";
  double prandtl = 0.85;
  int iterations = 1;
  double largest_ratio = 1e6;
  std::string production = "strain";
  std::string compressibility_correction = "none";
  std::string initial_energy = "0", initial_viscosity_ratio = "10";
  std::string energy_source = "0", dissipation_source = "0";
  void options(OptionGroup& option) {
    option("turbulence", turbulence, {"none", "realizable_k_epsilon", "sst_k_omega", "smagorinsky", "wale"},
           "turbulence model; none: laminar flow, or all scales resolved");
    option("turbulence_wall", wall, {"automatic", "resolved"},
           "walls of the k models. automatic: logarithmic law where the first node lies outside the viscous sublayer; "
           "resolved: none (first node at y+ about 1)");
    option("turbulence_prandtl", prandtl, "-", "turbulent Prandtl number", positive);
    option("turbulence_iterations", iterations, "-", "solutions of the two equations in a step", between(1, 100));
    option("turbulence_largest_ratio", largest_ratio, "-", "largest ratio of eddy viscosity to viscosity", positive);
    option("turbulence_production", production, {"strain", "kato_launder"},
           "production of k: mu_t S^2, or mu_t S W of strain rate and vorticity (Kato & Launder 1993), none where the "
           "flow is strained without turning: in front of bodies, in shocks and behind Mach disks");
    option("compressibility_correction", compressibility_correction, DilatationDissipation::names,
           "dissipation by fluctuating compression in the k models of compressible flow, which makes mixing layers of "
           "high "
           "Mach number grow more slowly");
    option("initial_turbulent_energy", initial_energy,
           "m2/s2, formula in x, y, z: turbulent kinetic energy at the start");
    option("initial_viscosity_ratio", initial_viscosity_ratio,
           "formula in x, y, z: eddy viscosity over viscosity at the start");
    option("turbulent_energy_source", energy_source,
           "W/m3 of mixture, formula in x, y, z, t: what something that is not resolved (a grid, a stirrer) adds to k");
    option("turbulent_dissipation_source", dissipation_source,
           "formula in x, y, z, t: the same for epsilon, W/(m3 s) of mixture, or omega, kg/(m3 s2)");
  }
};

/// The options `-boundary_<name>_turbulence_...`: the turbulence of what enters.
struct TurbulenceInflowOptions {
  std::string intensity = "0", energy = "0", length = "0", viscosity_ratio = "0";
  void options(OptionGroup& option) {
    option("intensity", intensity,
           "turbulence intensity of what enters: k = 1.5 (intensity times speed)^2; formula in x, y, z, t");
    option("energy", energy,
           "m2/s2, turbulent kinetic energy of what enters, formula in x, y, z, t (instead of the intensity)");
    option("length", length, "m, length scale of the turbulence that enters, formula in x, y, z, t");
    option("viscosity_ratio", viscosity_ratio,
           "eddy viscosity over viscosity of what enters, formula in x, y, z, t (instead of the length)");
  }
};

}  // namespace silt
