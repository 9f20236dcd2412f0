#pragma once
#include <string>

#include "base/options.hpp"

namespace silt {

/// The options `-fluid_...` that every scheme shares.
struct FluidOptions {
  std::string type = "incompressible";
  std::string scheme = "pressure_correction";
  std::string model = "a";
  double density = 0;
  double viscosity = 0;
  int order = 2;
  double backflow = 0.5;
  bool hydrostatic = false;
  bool energy = false;
  std::string initial_velocity = "0, 0, 0";
  std::string initial_pressure = "0";
  std::string body_force = "0, 0, 0";
  std::string void_fraction;

  void options(OptionGroup& option) {
    option("type", type, {"incompressible", "compressible", "prescribed", "none"},
           "the carrier fluid; prescribed: given by formulas, not solved; none: particles only");
    option("scheme", scheme, {"pressure_correction", "monolithic"},
           "pressure_correction: semi-implicit, velocity and pressure one after the other; monolithic: one Newton "
           "iteration over both");
    option("model", model, {"a", "b"},
           "volume-averaged form: a, pressure gradient shared by both phases; b, all on the "
           "fluid");
    option("density", density, "kg/m3", "density of the fluid", positive);
    option("viscosity", viscosity, "Pa s", "dynamic viscosity of the fluid; 0: none (compressible flow only)",
           non_negative);
    option("order", order, "-", "order of the backward difference formula in time", between(1, 2));
    option("backflow", backflow, "-",
           "share of the momentum that inflow through a pressure boundary loses there; 0.5 bounds the energy, 0 is "
           "unprotected",
           fraction);
    option("hydrostatic", hydrostatic,
           "the pressure includes the static head; if not it is the pressure less density times gravity times height");
    option("energy", energy, "solve the energy equation: the fluid has a temperature");
    option("initial_velocity", initial_velocity, "m/s, formulas in x, y, z");
    option("initial_pressure", initial_pressure, "Pa, formula in x, y, z");
    option("void_fraction", void_fraction,
           "formula in x, y, z, t: void fraction of a fixed matrix that fills the domain (without particles), or what "
           "the particles of a prescribed fluid see; default: what the particles leave");
    option("body_force", body_force, "N/m3 of mixture, formulas in x, y, z, t");
  }
};

}  // namespace silt
