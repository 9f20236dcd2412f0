#pragma once
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "base/options.hpp"
#include "fluid/boundary/boundary_conditions.hpp"

namespace silt {

/// The options `-fluid_initial_...` of states that are no formulas.
struct InitialStateOptions {
  std::string solve = "none";
  InputFile file;
  void options(OptionGroup& option) {
    option(
        "initial_solve", solve, {"none", "potential", "stokes"},
        "initial velocity of an incompressible flow from its boundaries: potential, without friction; stokes, without "
        "inertia, and with its pressure; none: by formulas");
    option("initial_file", file,
           "initial velocity, pressure, temperature and turbulence from an output of an earlier run, "
           "<output>/fluid/<number>.h5, interpolated from its mesh to this one");
  }
};

/// What a run starts from beside its formulas; an empty field stays as the formulas give it.
struct InitialState {
  std::vector<double> velocity;               ///< [places][3] m/s
  std::vector<double> pressure, temperature;  ///< [nodes] Pa, K
  bool stokes = false;                        ///< to be found by solve_stokes of the monolithic scheme
};

/// Reads `-fluid_initial_solve` and `-fluid_initial_file`; nothing when the run goes on from a checkpoint. `places`:
/// where the velocity is wanted, the mesh's nodes first. `boundary` has been evaluated at the start.
/// `also_on_restart`: a gas takes its units from the state it started from. Throws UserError. Collective.
InitialState initial_state(const Mesh& mesh, Options& options, const BoundaryConditions& boundary,
                           const std::vector<double>& places, bool with_temperature, bool also_on_restart = false);

/// Velocity of the potential flow between the boundaries, [nodes][3] m/s: alpha u = grad phi, div grad phi = 0, the
/// flow given on `velocity` and `mass_flow` boundaries, phi = 0 on `pressure` boundaries, no flow through the others;
/// what the boundaries prescribe at their nodes is put in. Collective.
std::vector<double> potential_velocity(const Mesh& mesh, const BoundaryConditions& boundary,
                                       const std::vector<double>& void_fraction);

}  // namespace silt
