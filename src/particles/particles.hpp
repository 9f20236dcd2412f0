#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "base/options.hpp"
#include "base/vector.hpp"
#include "particles/columns.hpp"

namespace silt {

/// What the fluid does to one particle during a fluid step, and what the particle took; travels with the particle.
/// Drag is integrated exactly in the substeps: m dv/dt = F_other + exchange (fluid_velocity - v).
struct FluidAction {
  double velocity[3] = {0, 0, 0};  ///< m/s, fluid velocity at the particle (u^n)
  double exchange = 0;             ///< kg/s, drag coefficient k_p, constant over the fluid step
  double force[3] = {
      0, 0,
      0};  ///< N, every other fluid force, constant over the fluid step (pressure gradient, buoyancy, owed impulse)
  double held = 1;  ///< 0: free, 1: held by contacts (the safe guess of the first step; coupling keeps it here)
  double owed[3] = {0, 0, 0};  ///< N s, owed by the last fluid step, given as a force over the next; coupling keeps it
  double impulse[3] = {0, 0, 0};         ///< N s, drag impulse received since the last reset; the engine adds
  double start_velocity[3] = {0, 0, 0};  ///< m/s, velocity at the start of the fluid step; set by the coupling
  double reaction[3] = {0, 0,
                        0};    ///< N, part of `force` whose opposite acts on the fluid (lift ...); coupling keeps it
  double added_mass = 0;       ///< kg, fluid that is accelerated with the particle: (m + added) dv/dt = forces
  double spin[3] = {0, 0, 0};  ///< rad/s, half the fluid's vorticity
  double field_impulse[3] = {0, 0, 0};  ///< N s, received from magnetic and other fields since the coupling reset it
  double spin_exchange = 0;  ///< N m s, viscous torque spin_exchange (spin - w), relaxed exactly in the substeps
  double work =
      0;  ///< J, done on the particle by the fluid (drag, `force`, viscous torque) since the coupling reset it
};

/// Counts of one advance(), for the progress line and the diagnostics (global).
struct ParticleStep {
  int substeps = 0, rebuilds = 0;
  long long contacts = 0;      ///< touching pairs, walls included
  long long removed = 0;       ///< particles that left through an outlet since the start
  double largest_overlap = 0;  ///< as a share of the radius
  /// Mean squares of the normal's components over the touching pairs of particles (diagonal of the fabric tensor): a
  /// third each without a preferred direction, 1 along a chain; 0 without a contact.
  Vec3 fabric = Vec3::Zero();
};

/// A particle to be created.
struct Seed {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), spin = Vec3::Zero();
  double radius = 0;  ///< m
  int material = 0;   ///< index into Materials
  /// Values of columns that do not start as their models say; a name that no model asked for is ignored.
  struct Value {
    std::string name;
    std::vector<double> row;
  };
  std::vector<Value> columns = {};
};

/// A particle that left the domain through an outlet (or was lost) during the last advance(), with its last state.
struct Departed {
  std::int64_t id = 0;
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero();
  double mass = 0;
  int cell = -1;                ///< the last local cell that contained it
  int boundary = -1;            ///< index into Mesh::boundaries
  FluidAction action;           ///< with the drag impulse received in this advance
  double acted = 0;             ///< s, how long `action.force` acted in this advance
  std::vector<double> columns;  ///< Columns::gather of its row
};

class Materials;
class CheckpointWriter;
class CheckpointReader;

/// The soft-sphere particles of this rank: those whose centre lies in a local cell.
/// Indices are valid until the next advance() or add(); `id` is for ever.
class Particles {
 public:
  /// The particles of a case, null when it inserts none. Collective.
  /// `empty`: none is made at the start, they come from load().
  static std::unique_ptr<Particles> create(const Mesh& mesh, Options& options, const Vec3& gravity, bool empty = false);
  /// Reads materials, contact laws and walls, and makes every `-insertion_<name>_...`. Collective.
  Particles(const Mesh& mesh, Options& options, const Vec3& gravity, bool empty = false);
  ~Particles();

  /// Creates particles; the seeds are the same on every rank. Throws UserError for one outside the mesh. Collective.
  void add(const std::vector<Seed>& seeds);

  /// Lets the particles come to rest without fluid, as `-settle_...` says; before the first advance(). Collective.
  void settle();

  int owned() const;
  long long total() const;  ///< on all ranks

  std::int64_t id(int i) const;
  Map<const Vec3> position(int i) const;
  Map<const Vec3> velocity(int i) const;
  Map<const Vec3> spin(int i) const;
  double radius(int i) const;
  double mass(int i) const;
  double volume(int i) const;
  /// Whether particles have a temperature (`-heat_particles`), the column "temperature".
  bool has_heat() const;
  double heat_capacity(int i) const;  ///< J/K, m c_p
  int material(int i) const;
  int cell(int i) const;  ///< local cell that contains the centre
  FluidAction& fluid_action(int i);
  /// What models let the particles carry besides; a model registers its own before the first advance().
  Columns& columns();
  const Columns& columns() const;

  /// The whole state, to return to after a fluid step that failed. restore() must be followed by an advance(). Local /
  /// collective.
  struct Snapshot;
  /// `to_repeat`: a step from it has the same bits again (a copy of the present forces, 48 B a particle); else the
  /// forces are evaluated anew.
  std::shared_ptr<const Snapshot> snapshot(bool to_repeat = true) const;
  void restore(const Snapshot& snapshot);
  /// Adds the whole state to a checkpoint: motion, fluid action, contact memory, walls' motion, counters. Collective.
  void save(CheckpointWriter& to);
  /// "612 B a particle: motion 96, loads 128, ...": memory of the particles' arrays and of a snapshot (may be null)
  /// over all ranks, as counted by the containers. Collective.
  std::string memory(const Snapshot* kept = nullptr) const;
  /// The same sum. B
  double bytes(const Snapshot* kept = nullptr) const;
  /// Goes on from a checkpoint, on any number of ranks; with that of the run that wrote it, with the same bits.
  /// `elsewhere`: the cells are shared out in another way. Throws UserError for one of other materials, walls or
  /// contact laws. Collective.
  void load(const CheckpointReader& from, bool elsewhere = false);
  /// Then, once every model has asked for its columns, their values. Collective.
  void load_columns(const CheckpointReader& from);

  /// The particles of this rank as a DMSWARM_BASIC with the fields id (long), position, velocity, spin (3), radius,
  /// mass, material (int), DMSwarm_rank, fluid_velocity (3), exchange, drag_impulse (3): as of this call, for output
  /// and projections; changes to it do not come back. Collective.
  DM swarm();

  /// Adds an impulse to particle i at once (settling with the fluid).
  void kick(int i, const Vec3& impulse);

  /// Takes out the particles in removal boxes and adds those that streams bring in the step from time to time + dt; to
  /// be called before the step. Those taken out are among departed() after the advance(). Collective.
  void supply(double time, double dt);
  /// Moves all particles by dt (in substeps not longer than time_step()). Collective.
  ParticleStep advance(double time, double dt);
  /// Those that left during the last advance() and were owned by this rank.
  const std::vector<Departed>& departed() const;
  const Materials& materials() const;
  double time_step() const;
  /// "Hertz contact time, 20 steps a contact": the bound that limits time_step().
  std::string time_step_reason() const;
  /// What the laws say of themselves at the sizes of the run, and what the user should be warned of, a line each.
  const std::vector<std::string>& notices() const;
  std::vector<std::string> warnings() const;

  /// Global sums. Collective.
  Vec3 momentum() const;
  /// About `origin`, spin included (not meaningful across periodic sides).
  Vec3 angular_momentum(const Vec3& origin) const;
  double kinetic_energy() const;
  double rotational_energy() const;
  double total_mass() const;
  struct Totals {
    double mass = 0, volume = 0;         ///< kg, m3
    double kinetic = 0, rotational = 0;  ///< J
    Vec3 momentum = Vec3::Zero();        ///< kg m/s
    Vec3 first_moment = Vec3::Zero();    ///< kg m, of the mass about the origin
    double fastest = 0;                  ///< m/s
  };
  /// The sums above, and more, in one pass over the particles.
  Totals totals() const;
  /// Liquid in the films of the particles and in bridges (`-bridge_type`). m3
  double liquid_volume() const;
  /// N s given to the particles by gravity, walls, fluid and applied fields since the last call; momentum change =
  /// their sum. Collective.
  struct Impulses {
    Vec3 gravity = Vec3::Zero(), walls = Vec3::Zero(), drag = Vec3::Zero(), fluid_force = Vec3::Zero(),
         kicks = Vec3::Zero(), added = Vec3::Zero(), removed = Vec3::Zero(), fields = Vec3::Zero();
    double added_mass = 0, removed_mass = 0;  ///< kg
    double exchanged = 0;  ///< N s, sum of the magnitudes of what fields made particles give each other
  };
  Impulses take_impulses();

  /// The energy of all particles and the work done on them since the start, by mechanism. J
  struct EnergyAccount {
    enum Mechanism {
      elastic,  ///< normal springs; what they take is in `stored`
      damping,  ///< normal dashpots
      friction,
      rolling,
      twisting,
      adhesion,  ///< every force along the line of centres beside the normal law
      walls,     ///< of moving walls
      fields,
      gravity,
      fluid,
      added,
      removed,
      mechanisms
    };
    using Work = std::array<double, mechanisms>;
    static constexpr const char* names[mechanisms] = {"elastic",  "damping",  "friction", "rolling",
                                                      "twisting", "adhesion", "walls",    "fields",
                                                      "gravity",  "fluid",    "added",    "removed"};
    double kinetic = 0, rotational = 0;
    double stored = 0;  ///< in normal springs
    Work work{};
    /// Energy that nothing accounts for: what is there less all that was added and done, the springs' work apart.
    double residual() const;
    /// What dashpots, friction, rolling and twisting took.
    double dissipated() const { return -work[damping] - work[friction] - work[rolling] - work[twisting]; }
  };
  /// Whether `-particles_energy` asks for it.
  bool has_energy_account() const;
  /// Collective.
  EnergyAccount energy_account() const;

  /// What the particles did to one wall, mean over the last advance(), and where the wall is.
  struct WallLoad {
    std::string name;  ///< of a boundary of the mesh, or of a rigid wall (after those)
    Vec3 force = Vec3::Zero();
    Vec3 torque = Vec3::Zero();  ///< N m, about the origin; of a rigid wall about its centre of rotation
    Vec3 displacement = Vec3::Zero();
    double angle = 0;  ///< rad
    double heat = 0;   ///< W, conducted from the wall to the particles
  };
  /// Of all walls, over all ranks. Collective.
  std::vector<WallLoad> wall_loads() const;
  std::vector<std::string> wall_names() const;
  /// Whether a wall conducts heat to particles.
  bool wall_conducts(int wall) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace silt
