#include "fluid/fluid.hpp"

#include "base/error.hpp"
#include "fluid/fluid_options.hpp"
#include "fluid/monolithic.hpp"
#include "fluid/pressure_correction/pressure_correction.hpp"

namespace silt {

std::unique_ptr<Fluid> Fluid::create(const Mesh& mesh, Options& options, const Vec3& gravity) {
  FluidOptions fluid;
  options.read("fluid", fluid);
  if (fluid.type == "none") return nullptr;
  for (const char* name : {"fluid_density", "fluid_viscosity"})
    if (!options.given(name)) throw UserError(std::string("-") + name + " is missing: the fluid needs it");
  if (fluid.scheme == "pressure_correction") return make_pressure_correction(mesh, options, fluid, gravity);
  return make_monolithic(mesh, options, fluid, gravity);
}

}  // namespace silt
