#include "fluid/fluid.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "fluid/boundary/drive.hpp"
#include "fluid/compressible/compressible.hpp"
#include "fluid/energy/energy_equation.hpp"
#include "fluid/fluid_options.hpp"
#include "fluid/monolithic.hpp"
#include "fluid/prescribed.hpp"
#include "fluid/pressure_correction/pressure_correction.hpp"
#include "fluid/turbulence/turbulence.hpp"

namespace silt {
namespace {

/// Whether the case says anything of a fluid: where it does not, the particles are alone.
bool mentioned(const Mesh& mesh, const Options& options) {
  for (const auto& name : Options::declared<FluidOptions>())
    if (options.given("fluid_" + name)) return true;
  for (const auto& name : mesh.boundaries)
    if (options.given("boundary_" + name + "_type")) return true;
  return false;
}

}  // namespace

std::span<const double> Fluid::turbulent_energy() const {
  return turbulence() ? turbulence()->energy() : std::span<const double>{};
}
std::span<const double> Fluid::turbulent_dissipation() const {
  return turbulence() ? turbulence()->dissipation() : std::span<const double>{};
}

void Fluid::set_void_fraction(const Mesh& mesh, double time) {
  if (!void_fraction_formula_) return;
  // The rate is that at the end of the step, by central differences: of higher order than that of the step's change.
  constexpr double h = 1e-6;
  bool wrong = false;
  for (int i = 0; i < mesh.nodes; ++i) {
    const Vec3 x = vec3(&mesh.node_coordinates[3 * static_cast<std::size_t>(i)]);
    const double alpha = load_.void_fraction[i] = void_fraction_formula_(x, time);
    load_.void_fraction_rate[i] = (void_fraction_formula_(x, time + h) - void_fraction_formula_(x, time - h)) / (2 * h);
    wrong |= !(alpha > 0 && alpha <= 1);
  }
  if (mpi_any(wrong))
    throw UserError(fmt::format("-fluid_void_fraction is not above 0 and at most 1 everywhere at t = {:g} s", time));
}

std::unique_ptr<Fluid> Fluid::create(const Mesh& mesh, Options& options, const Vec3& gravity) {
  FluidOptions fluid;
  options.read("fluid", fluid);
  if (fluid.type == "none" || !mentioned(mesh, options)) return nullptr;
  const bool compressible = fluid.type == "compressible";
  for (const char* name : {"fluid_density", "fluid_viscosity"})
    if (!options.given(name) && !(compressible && std::string(name) == "fluid_density"))
      throw UserError(std::string("-") + name + " is missing: the fluid needs it");
  if (fluid.scheme != "monolithic" && options.find("fluid_element").value_or("equal_order") != "equal_order")
    throw UserError(fmt::format("option -fluid_element ({}): '{}' needs -fluid_scheme monolithic",
                                options.origin("fluid_element"), *options.find("fluid_element")));
  if (compressible) {
    if (options.given("fluid_scheme") && fluid.scheme != "monolithic")
      throw UserError("-fluid_scheme pressure_correction is not available with -fluid_type compressible");
    if (options.given("fluid_energy") && !fluid.energy)
      throw UserError("-fluid_energy no is not available with -fluid_type compressible");
    Drive::refuse(options, "with -fluid_type compressible");
    if (options.given("fluid_initial_solve"))
      throw UserError("-fluid_initial_solve is not available with -fluid_type compressible");
    if (options.given("fluid_void_fraction"))
      throw UserError("-fluid_void_fraction is not available with -fluid_type compressible");
    auto gas = make_compressible(mesh, options, fluid, gravity);
    gas->unknowns_ = (mesh.dimension + 2) * mesh.total_nodes;
    gas->description_ = fmt::format("compressible, ideal gas, {} Pa s, BDF{}", fluid.viscosity, fluid.order);
    if (const Turbulence* turbulence = gas->turbulence()) gas->description_ += "; " + turbulence->name();
    return gas;
  }
  if (!(fluid.viscosity > 0))
    throw UserError("option -fluid_viscosity: it must be above 0 unless the flow is compressible");
  if (fluid.type == "prescribed") {
    Drive::refuse(options, "with -fluid_type prescribed");
    auto given = std::make_unique<Prescribed>(mesh, options, fluid);
    given->description_ =
        fmt::format("prescribed, {} kg/m3, {} Pa s, model {}", fluid.density, fluid.viscosity, fluid.model);
    if (const Turbulence* turbulence = given->turbulence()) given->description_ += "; " + turbulence->name();
    return given;
  }
  auto made = fluid.scheme == "pressure_correction" ? make_pressure_correction(mesh, options, fluid, gravity)
                                                    : make_monolithic(mesh, options, fluid, gravity);
  if (fluid.energy) {
    EnergyOptions energy;
    options.read("fluid", energy);
    made->heat_capacity_ = energy.heat_capacity;
    made->conductivity_ = energy.conductivity;
  }
  made->description_ = fmt::format("{}, {} kg/m3, {} Pa s; {}, BDF{}, model {}", fluid.type, fluid.density,
                                   fluid.viscosity, fluid.scheme, fluid.order, fluid.model);
  if (fluid.energy)
    made->description_ += fmt::format("; energy, {} J/(kg K), {} W/(m K)", made->heat_capacity_, made->conductivity_);
  if (const Turbulence* turbulence = made->turbulence()) made->description_ += "; " + turbulence->name();
  if (made->unknowns_ == 0) made->unknowns_ = (mesh.dimension + (fluid.energy ? 2 : 1)) * mesh.total_nodes;
  return made;
}

}  // namespace silt
