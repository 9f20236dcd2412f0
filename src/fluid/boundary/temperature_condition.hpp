#pragma once
#include <string>

#include "base/options.hpp"

namespace silt {

/// The options `-boundary_<name>_temperature_...`: what the energy equation obeys on a boundary.
struct TemperatureOptions {
  std::string type;
  std::string value = "0", flux = "0", coefficient = "0";
  void options(OptionGroup& option) {
    option("type", type, {"adiabatic", "given", "flux", "heat_transfer", "inflow"},
           "adiabatic: no heat is conducted through (default of walls); given: the temperature is; flux: heat per area "
           "and time is; heat_transfer: coefficient times the difference to the temperature outside; inflow: that of "
           "what enters, heat passes with the flow alone (default of velocity and mass_flow in incompressible flow)");
    option("value", value,
           "K, formula in x, y, z, t: the temperature given, that outside (heat_transfer), or, on a boundary where "
           "fluid may enter, that of what enters");
    option("flux", flux, "W/m2 into the fluid, formula in x, y, z, t");
    option("coefficient", coefficient, "W/(m2 K), heat-transfer coefficient, formula in x, y, z, t");
  }
};

}  // namespace silt
