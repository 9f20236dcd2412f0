#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "base/options.hpp"

namespace silt {

/// What the particles do to the fluid during the coming step, at the mesh nodes (consistent on shared nodes). The
/// coupling fills it before every advance(); without particles alpha is 1 and the rest 0.
struct ParticleLoad {
  std::vector<double> void_fraction;       ///< [nodes] alpha at the end of the step
  std::vector<double> void_fraction_rate;  ///< [nodes] 1/s, (alpha^{n+1} - alpha^n)/dt
  std::vector<double> force;  ///< [nodes][3] N, load vector: what the particles push the fluid with (-sum_p w_i I_p/dt)
  std::vector<double> response;  ///< [nodes] kg/s: sum_p w_i K_p; the fluid feels -response (u^{n+1} - u^n)
  /// [nodes] s, share of the volume taken by particles that follow a change of the flow within the step,
  /// sum_p w_i V_p (dv_p/du)/M_i. Continuity counts on it, div(alpha u + s (u - u^n)) = -d(alpha)/dt; and in model A
  /// the fluid feels -s grad p beside -alpha grad p, and s grad p of the step before in return
  /// (docs/theory/coupling.md).
  std::vector<double> following;
  std::vector<double> heat;           ///< [nodes] W, load vector: heat that the particles give the fluid
  std::vector<double> heat_response;  ///< [nodes] W/K: the fluid gets heat - heat_response (T^{n+1} - T^n)
  std::vector<double> energy;      ///< [nodes] W, load vector: minus the work on the particles; for a fluid that solves
                                   ///< for its total energy
  std::vector<double> turbulence;  ///< [nodes] W, load vector: what the particles add to k (negative: take from it)
  double dissipation_factor = 0;   ///< C of what they add to epsilon, C epsilon/k times that
  explicit ParticleLoad(int nodes = 0)
      : void_fraction(nodes, 1.0),
        void_fraction_rate(nodes, 0.0),
        force(3 * nodes, 0.0),
        response(nodes, 0.0),
        following(nodes, 0.0),
        heat(nodes, 0.0),
        heat_response(nodes, 0.0),
        energy(nodes, 0.0),
        turbulence(nodes, 0.0) {}
};

/// What one fluid step took and left, for the progress line, the diagnostics and the ledger.
struct FluidStep {
  int velocity_iterations = 0, pressure_iterations = 0, newton_iterations = 0, energy_iterations = 0,
      turbulence_iterations = 0;
  bool first_order = false;      ///< compressible flow: only first-order viscosity got over the step
  double courant = 0;            ///< largest |u| dt / h
  double mass_residual = 0;      ///< inflow - outflow - d/dt int alpha, relative to VolumeScale
  Vec3 momentum = Vec3::Zero();  ///< kg m/s, int alpha rho u at the end of the step
  Vec3 lent = Vec3::Zero();      ///< N s, dt int s grad p: what particles that follow the flow get of its pressure and
                                 ///< the fluid has felt for them; the next step gives it back
  Vec3 boundary_force =
      Vec3::Zero();  ///< N, pressure, viscous and convective momentum flux through the boundary (into the fluid)
  double drive_gradient = 0;  ///< Pa/m, fall of the mean pressure that drives a periodic flow
  double drive_velocity = 0;  ///< m/s, mean superficial velocity along its direction
  double heat = 0;            ///< J, at the end of the step, counted from the reference temperature
  double energy_supply = 0;   ///< W, given to the total energy by boundaries and gravity; compressible flow
};

/// Volume flow and force per named boundary.
struct BoundaryFlow {
  double volume_flow = 0;     ///< m3/s, int alpha u.n, positive out
  double mass_flow = 0;       ///< kg/s, positive out
  double mean_pressure = 0;   ///< Pa
  Vec3 force = Vec3::Zero();  ///< N, force of the fluid on the boundary
  double heat_flow = 0;       ///< W, heat that leaves, conducted and carried
};

class Turbulence;

/// The carrier phase on a mesh. Implementations: PressureCorrection, Monolithic. The flow never sees a particle.
class Fluid {
 public:
  /// Reads `-fluid_...` and `-boundary_<name>_...`; refuses a boundary without a condition. Null for `-fluid_type
  /// none`. Collective.
  static std::unique_ptr<Fluid> create(const Mesh& mesh, Options& options, const Vec3& gravity);
  virtual ~Fluid() = default;

  ParticleLoad& load() { return load_; }
  const ParticleLoad& load() const { return load_; }
  /// kg/m3 and Pa s; of a gas at its units' state, and properties() has what holds at the nodes.
  double density() const { return density_; }
  double viscosity() const { return viscosity_; }
  /// Properties at the nodes: density (kg/m3), viscosity (Pa s), speed of sound (m/s); empty where density() and
  /// viscosity() hold everywhere.
  struct Properties {
    std::span<const double> density, viscosity, sound;
  };
  virtual Properties properties() const { return {}; }
  /// True when the fluid solves for its total energy: what it does to particles must then be taken from that.
  virtual bool total_energy() const { return false; }
  /// W, int (p - reference) d(alpha)/dt of the last step: what displacing the fluid took from its total energy.
  /// Collective.
  virtual double displacement_power(double reference) const {
    (void)reference;
    return 0;
  }
  /// True when the flow through a periodic domain is driven (`-fluid_drive_...`).
  bool driven() const { return driven_; }
  /// J/(kg K) and W/(m K); 0 when no energy equation is solved.
  double heat_capacity() const { return heat_capacity_; }
  double conductivity() const { return conductivity_; }
  /// True for the volume-averaged form A (pressure gradient times alpha), false for form B.
  bool model_a() const { return model_a_; }
  /// True when pressure() is the pressure less the static head rho g.x (the default): gravity then does not enter the
  /// fluid's equation, and the buoyancy of a particle, -rho V_p g, comes on top of its pressure-gradient force. False
  /// (`-fluid_hydrostatic yes`): the pressure gradient holds the static head and the buoyancy is part of -V_p grad p.
  bool reduced_pressure() const { return reduced_pressure_; }

  /// One line for the header of the run.
  const std::string& description() const { return description_; }
  /// Number of unknowns over all ranks.
  long long unknowns() const { return unknowns_; }

  /// Makes the initial velocity meet continuity among the particles, before the first step: div(alpha u + j) = 0 with
  /// the flow of the boundaries, alpha of the load and j [nodes][3] m/s the particles' volume flux
  /// (initial_projection.hpp). A gas that can be compressed, and a prescribed flow, stay as they are. Collective.
  virtual void meet_continuity(std::span<const double> solids_flux) { (void)solids_flux; }

  /// Advances from time to time + dt with the present load. On SolveFailure the state is as before. Collective.
  virtual FluidStep advance(double time, double dt) = 0;
  /// Largest |u| dt/h of the present state for a unit step (1/s). Collective.
  virtual double courant_rate() const = 0;

  /// Longest step, s, that the scheme advises after one of `last` s (0: none yet). Collective.
  virtual double longest_step(double last) const {
    (void)last;
    return infinity;
  }

  /// [nodes][3] m/s, interstitial velocity; consistent on shared nodes.
  virtual std::span<const double> velocity() const = 0;
  /// [nodes][3] m/s, the velocity by which the fluid drags particles; velocity() but for what the scheme's last
  /// correction adds.
  virtual std::span<const double> carrying_velocity() const { return velocity(); }
  /// [nodes][3] m/s, the change of carrying_velocity() in the last step, as it entered the particles' response.
  virtual std::span<const double> velocity_change() const = 0;
  /// [nodes] Pa.
  virtual std::span<const double> pressure() const = 0;
  /// [nodes][3] Pa/m, the adjoint of the discrete -alpha grad p of the last step: sum_i M_i (1 - alpha_i) g_i = int (1
  /// - alpha_h) grad p_h with the lumped mass M, so that the pressure force on the particles balances the fluid's to
  /// round-off.
  virtual std::span<const double> pressure_gradient() const = 0;
  /// [nodes] K; empty when no energy equation is solved.
  virtual std::span<const double> temperature() const { return {}; }
  /// [nodes] K, the change of the temperature that entered the particles' heat response in the last step.
  virtual std::span<const double> temperature_change() const { return {}; }
  /// What there is at the nodes beside velocity, pressure and void fraction: temperature, density, ...
  struct Scalar {
    std::string name;
    std::span<const double> values;  ///< [nodes]
  };
  virtual std::vector<Scalar> scalars() const {
    return temperature().empty() ? std::vector<Scalar>{} : std::vector<Scalar>{{"temperature", temperature()}};
  }
  /// Null for laminar flow.
  virtual const Turbulence* turbulence() const { return nullptr; }
  /// [nodes] m2/s2 and m2/s3: k and epsilon; empty for laminar flow and for models of turbulence that have none.
  virtual std::span<const double> turbulent_energy() const;
  virtual std::span<const double> turbulent_dissipation() const;
  /// [cells][points][3] m/s at the points of a rule on the reference cell, where the velocity is of higher order than
  /// the nodes tell; empty where it is not.
  virtual std::vector<double> velocity_at(const Quadrature& rule) const {
    (void)rule;
    return {};
  }
  /// [nodes] the void fraction that particles see instead of their own; empty unless it is prescribed.
  virtual std::span<const double> given_void_fraction() const { return {}; }
  /// Flow and force per boundary, in the order of Mesh::boundaries. Collective.
  virtual std::vector<BoundaryFlow> boundary_flow() const = 0;

  /// Every array that a restart needs, by name, read and written by the checkpoint: [nodes][components], or
  /// [cells][components] when `on_cells`.
  struct StateArray {
    std::string name;
    std::vector<double>* values;
    int components;
    bool on_cells = false;
  };
  virtual std::vector<StateArray> state() = 0;
  /// To be called after the arrays of state() were overwritten. Collective.
  virtual void restored() {}
  /// The values of state(), to go back to when something after the fluid's step fails. Unlike state() it leaves the
  /// solvers as they are.
  std::vector<std::vector<double>> kept() {
    std::vector<std::vector<double>> values;
    for (const StateArray& array : arrays()) values.push_back(*array.values);
    return values;
  }
  /// Collective.
  void go_back(const std::vector<std::vector<double>>& values) {
    const std::vector<StateArray> to = state();
    for (std::size_t k = 0; k < to.size(); ++k) *to[k].values = values[k];
    restored();
  }

 protected:
  /// state() without what a checkpoint asks of the solvers.
  virtual std::vector<StateArray> arrays() { return state(); }
  /// `-fluid_void_fraction` of a solved fluid (a fixed porous matrix without drag): alpha at `time` and its rate become
  /// the load. Collective.
  void set_void_fraction(const Mesh& mesh, double time);
  std::function<double(const Vec3&, double)> void_fraction_formula_;
  ParticleLoad load_;
  double density_ = 0, viscosity_ = 0, heat_capacity_ = 0, conductivity_ = 0;
  bool model_a_ = true;
  bool reduced_pressure_ = true;
  bool driven_ = false;
  std::string description_;
  long long unknowns_ = 0;
};

}  // namespace silt
