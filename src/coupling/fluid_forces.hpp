#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/models.hpp"
#include "base/nodal_gradient.hpp"
#include "coupling/filter.hpp"
#include "coupling/fluid_properties.hpp"
#include "coupling/kernel.hpp"
#include "coupling/lift/magnus.hpp"
#include "coupling/lift/saffman.hpp"
#include "coupling/lift/viscous_torque.hpp"
#include "fluid/fluid.hpp"
#include "particles/particles.hpp"

namespace silt {

/// Forces of the fluid beside drag and lift that have no list.
inline constexpr SwitchedModel virtual_mass_models[] = {
    {"sphere",
     "virtual_mass_coefficient",
     {"", "Auton, Hunt & Prud'homme 1988", "F = C rho V (Du/Dt - dv/dt), C = 0.5 for a sphere",
      "a bubble starts with nearly 2 g; path in an accelerating flow"}},
};
inline constexpr SwitchedModel coupling_models[] = {
    {"pressure_gradient",
     "fluid_pressure",
     {"(3.291)", "", "F = -V grad p, always", "acceleration by a given gradient"}},
    {"viscous_stress",
     "coupling_viscous_stress yes",
     {"(3.291)", "", "F = V div tau of the undisturbed flow", "acceleration in a parabolic flow"}},
    {"buoyancy",
     "gravity",
     {"(3.292)", "", "m g (1 - rho/rho_p), where p has no static head", "acceleration without drag"}},
};

/// The options `-virtual_mass_...`.
struct VirtualMassOptions {
  double coefficient = 0;
  void options(OptionGroup& option) {
    option("coefficient", coefficient, "-",
           "C of the virtual mass force C rho V (Du/Dt - dv/dt): 0.5 for a sphere; 0: no virtual mass", non_negative);
  }
};

/// The fluid's forces and torques on particles beside drag, pressure gradient and buoyancy: lift by shear and by spin,
/// virtual mass, viscous torque, viscous stress. Each is taken at the start of a fluid step (FluidAction), but for the
/// accelerated mass and the spin that relax within it; the fluid gets the opposite of every force
/// (docs/theory/fluid_forces.md).
class FluidForces {
 public:
  /// Reads `-saffman_...`, `-magnus_...`, `-virtual_mass_...`, `-viscous_torque_...`. `mass`: lumped_mass(mesh).
  FluidForces(const Mesh& mesh, const std::vector<double>& mass, Options& options, bool viscous_stress);
  bool any() const { return width_ > 0 || spins_; }
  /// Names of those chosen, for the header of the run; empty without any.
  std::string description() const;

  /// Adds to the FluidAction of every particle, whose fluid velocity is set. `last_step`: the step that led to the
  /// present flow, s; 0 at the start. The kernel holds the particles' places. Collective.
  void act(const Fluid& fluid, const FluidProperties& properties, const Filter& filter, const Kernel& kernel,
           Particles& particles, double last_step);

 private:
  void make_fields(const Fluid& fluid, double last_step);

  const Mesh& mesh_;
  SaffmanModels::Any saffman_;
  MagnusModels::Any magnus_;
  ViscousTorqueModels::Any torque_;
  VirtualMassOptions virtual_mass_;
  bool viscous_stress_, spins_ = false, turns_ = false;
  int curl_ = -1, rate_ = -1, stress_ = -1, width_ = 0;  ///< places of the fields among the components
  NodalGradient gradient_;
  std::vector<double> slope_, second_, nodal_, at_particles_;
};

}  // namespace silt
