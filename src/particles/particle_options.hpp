#pragma once
#include <optional>
#include <string>

#include "base/options.hpp"

namespace silt {

/// The options `-particles_...`.
struct ParticleOptions {
  double step = 0, step_fraction = 0.05, rayleigh_fraction = 0.2;
  bool step_override = false;
  std::optional<double> speed;
  double skin = 0, overlap_limit = 0.25;
  std::string lost = "stop", deep = "stop", fast = "stop", instructions = "auto";
  std::string integrator = "velocity_verlet", slip_arm = "contact_point";
  bool plane = false, fixed = false, orientation = false, energy = false;
  /// The share of a step's new force in the change of velocity over that step.
  double late_share() const { return integrator == "semi_implicit_euler" ? 0.0 : 0.5; }
  /// Whether contact laws see velocities with half of the step's contact impulse only.
  bool leapfrog() const { return integrator == "leapfrog"; }
  /// At which share of a step springs are read at least: 1/2 where velocities are those predicted for its end, 1 where
  /// they are those that moved the particles.
  double spring_share() const { return integrator == "velocity_verlet" ? 0.5 : 1.0; }
  void options(OptionGroup& option) {
    option("step", step, "s", "time step of the particles; 0: as long as the step fractions allow", non_negative);
    option("step_fraction", step_fraction, "-", "longest step as a share of the shortest collision",
           Range{0, 0.5, true, false});
    option("rayleigh_fraction", rayleigh_fraction, "-",
           "longest step as a share of the Rayleigh time (Hertz family of normal laws)", Range{0, 1, true, false});
    option("step_override", step_override, "accept a particles_step that is longer than the step fractions allow");
    option("speed", speed, "m/s",
           "largest collision speed expected; default: the larger of the fastest start and a fall through the domain",
           positive);
    option("skin", skin, "m",
           "neighbours are listed this much beyond touching; 0: a tenth of the largest diameter, up to a quarter where "
           "particles run",
           non_negative);
    option("overlap_limit", overlap_limit, "-", "overlap that is too deep, as a share of the smaller radius",
           Range{0, 1, true, false});
    option("deep", deep, {"stop", "warn"}, "what to do about an overlap beyond particles_overlap_limit");
    option("fast", fast, {"stop", "warn"}, "what to do about a particle that moves more than its radius in a step");
    option(
        "integrator", integrator, {"velocity_verlet", "leapfrog", "semi_implicit_euler"},
        "velocity_verlet: second order in the step; leapfrog: contact laws see the velocities of half a step before, "
        "as in LAMMPS, first order where they damp; semi_implicit_euler: first order, the velocity first");
    option("slip_arm", slip_arm, {"contact_point", "radius"},
           "where the slip of a contact takes the spins: contact_point, where the force acts; radius: at the whole "
           "radius, as LAMMPS does");
    option("orientation", orientation,
           "particles carry their orientation, a unit quaternion (w, x, y, z; start 1, 0, 0, 0), for the output");
    option("energy", energy, "work on the particles by mechanism, every step, in energy.csv");
    option("lost", lost, {"stop", "warn"}, "what to do when a particle has passed a wall");
    option("instructions", instructions, {"auto", "plain", "avx2", "avx512"},
           "processor instructions of the particle loops");
    option(
        "fixed", fixed,
        "all particles are held where they are once settled: fluid and weight act on them, what holds them counts as "
        "walls");
    option("plane", plane, "particles move in x and y and turn about z only (always so on 2D meshes)");
  }
};

/// The options `-settle_...`: the particles alone come to rest before the run starts.
struct SettleOptions {
  double time = 0, friction_factor = 1, speed = 0;
  void options(OptionGroup& option) {
    option("time", time, "s", "longest time the particles alone may settle before the run starts", non_negative);
    option("friction_factor", friction_factor, "-",
           "friction while settling, as a share of the materials' friction; 0 packs densest", fraction);
    option("speed", speed, "m/s", "settling ends early once the root-mean-square speed is below this; 0: never",
           non_negative);
  }
};

}  // namespace silt
