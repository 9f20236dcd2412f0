#pragma once
#include <memory>
#include <string>
#include <vector>

#include "particles/brownian.hpp"
#include "particles/contact_laws.hpp"
#include "particles/contact_lists.hpp"
#include "particles/energy_ledger.hpp"
#include "particles/force_field.hpp"
#include "particles/halo.hpp"
#include "particles/heat/particle_heat.hpp"
#include "particles/insertion/streams.hpp"
#include "particles/liquid_exchange.hpp"
#include "particles/materials.hpp"
#include "particles/migration.hpp"
#include "particles/neighbours.hpp"
#include "particles/packed_state.hpp"
#include "particles/particle_options.hpp"
#include "particles/particles.hpp"
#include "particles/step_news.hpp"
#include "particles/store.hpp"
#include "particles/time_step.hpp"
#include "particles/wall_contacts.hpp"
#include "particles/walls/walls.hpp"

namespace silt {

/// A communicator of our own, so that no message is taken for another's.
class OwnCommunicator {
 public:
  OwnCommunicator() { MPI_Comm_dup(PETSC_COMM_WORLD, &communicator_); }
  ~OwnCommunicator() { MPI_Comm_free(&communicator_); }
  OwnCommunicator(const OwnCommunicator&) = delete;
  OwnCommunicator& operator=(const OwnCommunicator&) = delete;
  operator MPI_Comm() const { return communicator_; }

 private:
  MPI_Comm communicator_;
};

/// A copy of the state of a rank's particles.
struct Particles::Snapshot {
  int owned = 0;
  PackedMotions motion;
  PackedLoads present;  ///< empty: not kept
  PackedIds id;
  std::vector<int> cell;
  std::vector<FluidAction> action;
  std::vector<double> columns;
  PackedRows contacts, walls;
  bool contacts_once;  ///< ContactMemory::once
  Impulses impulses;
  long long total, removed;
  std::int64_t next_id;
  Vec3 wall_total, field_total;
  std::vector<Vec3> wall_force, wall_torque;
  std::vector<WallMotion::State> wall_states;
  EnergyLedger::State energy;
  std::vector<StreamState> streams;
  bool started;
  std::size_t bytes() const;
};

/// What is behind Particles: the parts of the particle solver and the loop over the substeps.
class Engine {
 public:
  Engine(const Mesh& mesh, Options& options, const Vec3& gravity, bool empty = false);

  void add(const std::vector<Seed>& seeds);
  ParticleStep advance(double time, double dt);
  void supply(double time, double dt);
  /// Lets the particles fall without fluid until the options say they are at rest; those held fixed are then.
  void settle(const SettleOptions& options);

  const ContactLaws& laws() const { return laws_; }
  /// What the user should know of laws and fields at the sizes of the particles, a line each.
  std::vector<std::string> warnings() const;
  /// Liquid of this rank's films and of what they gave to bridges; after an advance. m3
  double liquid_volume() const { return liquid_.volume(store, contacts, wall_contacts); }
  /// `to_repeat`: with the present forces, so that a step can be repeated bit by bit.
  std::shared_ptr<const Particles::Snapshot> snapshot(bool to_repeat) const;
  /// What this rank's arrays take, by name. B
  std::vector<std::pair<std::string, std::size_t>> bytes() const;
  void restore(const Particles::Snapshot& snapshot);
  void save(CheckpointWriter& to);
  void load(const CheckpointReader& from, bool elsewhere);
  void load_columns(const CheckpointReader& from);

  /// J/K, null without temperatures.
  const ParticleHeat* heat() const { return heat_.get(); }
  /// Null unless `-particles_energy`.
  EnergyLedger* energy() const { return energy_.get(); }

  /// Momentum etc. that this rank's particles received since the last take_impulses().
  Particles::Impulses impulses;
  Store store;
  std::vector<Departed> departed;
  long long total = 0, removed = 0;
  StepLimit limit;
  const Mesh& mesh;
  Materials materials;
  ContactLists contacts;
  WallContacts wall_contacts;
  std::vector<Vec3> wall_force, wall_torque;  ///< of the last substep, on the particles, per wall, this rank
  /// N s, N m s about the origin: what each wall gave the particles in the last advance(), which lasted wall_time.
  std::vector<Vec3> wall_impulse, wall_turning;
  double wall_time = 0;
  const Walls& walls() const { return walls_; }

 private:
  /// advance() of particles that are held.
  ParticleStep hold(double time, double dt);
  void prepare_fluid(double h);
  void prepare_turning(double h);
  void collect_fluid();
  void start(double time);
  void rebuild(Aligned<Load>& carried, bool within_step, double h);
  CellOrder sort_along(const CellGrid& grid, Aligned<Load>& carried);
  bool out_of_lists();
  /// Tells the other ranks of the substep, in which a particle may have come `farthest` from where the lists were made;
  /// whether the lists must be made anew.
  bool agree_on_lists(double farthest);
  /// Takes what the ranks told of a substep, if it was not heard yet. Throws RunError where something is wrong.
  void hear();
  void adapt_skin();
  void depart(const std::vector<Gone>& gone, bool within_step, double h);
  void evaluate(double time, double dt);
  /// The particles' forces on each other, in evaluate(): waits for the ghosts.
  void act_contacts(double dt);
  /// The contacts `from` to `to`; whole packs, but for the last. Returns how many ended.
  int sweep_contacts(PairSweep& sweep, int from, int to);
  void note_loaded();
  /// Takes the work of the step that evaluate() ended, and lets go of the contacts that ended with it.
  void account(double h);
  void correct(double h);
  /// The longest step at this collision speed, for the particles that are there. Throws UserError.
  void choose_step();
  void take_out(double time);
  void move_walls(double time, double h);
  void add_wall_impulses(double h);
  /// Throws UserError for a wall with a temperature that cannot act.
  void check_warm_walls() const;
  /// Adds the force fields' part to the present loads.
  void act_fields(double time, double dt);
  /// Asks the pass for the rotations of the step where a field has vectors that turn with the particles.
  void want_turns(Integration& step);
  void come_to_rest(const SettleOptions& options);
  /// Temperatures of held particles, in steps that conduction allows.
  void heat_held(double time, double dt);
  /// Takes the contacts' memories out of the lists, whose indices are about to change.
  void detach();
  /// Sums that change only when particles come or go.
  void sum_up();
  Integration pass(double h);
  std::string describe(const Body& motion, std::int64_t id) const;
  /// The same with what the particle touches and the wall it touched last.
  std::string describe(int p) const;
  std::string describe(const Gone& gone) const;
  std::string last_wall(double number) const;
  /// Stops at the next opportunity, or warns, as the option says.
  void report(const std::string& option, const std::string& text);
  /// Throws RunError with the text of the lowest rank that has one, on all ranks; does nothing when none has.
  /// Collective.
  void stop_if_any(const std::string& text) const;
  std::string describe_deepest(int contact) const;
  /// Tells the laws the sizes of the particles. Collective.
  void take_sizes();
  std::string find_bad() const;
  /// Touching pairs and walls, their deepest overlap and the fabric, of all ranks. Collective.
  void count_contacts(ParticleStep& step) const;

  ParticleOptions options_;
  OwnCommunicator communicator_;
  ContactLaws laws_;
  LiquidExchange liquid_;
  Walls walls_;
  Streams streams_;
  std::vector<Departed> taken_out_;  ///< by removal boxes, since the last advance()
  bool advanced_ = false;            ///< the run is past its first step
  Migration migration_;
  Halo halo_;
  StepNews news_;
  const Kernels& kernels_;
  Vec3 gravity_;
  bool plane_;
  int orientation_ = -1;  ///< column, -1: not wanted
  int last_wall_ = -1;    ///< column, number of the wall it touched last and 1; -1: there are no walls
  double speed_ = 0;      ///< m/s, largest collision speed expected
  int leaving_count_ = 0;
  long long warnings_ = 0;
  std::unique_ptr<EnergyLedger> energy_;
  Periods periods_;
  double skin_ = 0, largest_radius_ = 0;
  double travel_ = 0;         ///< m, no particle of any rank is further from where the lists were made
  double wall_travel_ = 0;    ///< m, the same for walls
  double stride_ = infinity;  ///< m, the longest way of a particle or a wall of any rank in the last step heard of
  double path_ = 0;           ///< m, sum of the longest ways of a particle or ghost in each step since then
  double way_ = 0;            ///< m, longest way of a particle in the step, not yet in the path
  // Which particles the last evaluation may have loaded, and the one before it, where it was worth noting.
  bool few_loaded_ = false, few_loaded_before_ = false;
  std::vector<unsigned char> loaded_, loaded_before_;
  double strode_ = 0;  ///< m, longest way of this rank's particles, and of a wall, in the last step
  int steps_since_rebuild_ = 0;
  SmallestRadii smallest_;
  std::int64_t next_id_ = 0;
  bool settling_ = false;
  bool started_ = false;  ///< lists and present forces are valid
  bool fluid_ = false;    ///< store.drag is in use in this advance
  bool turning_ = false;  ///< store.turning is in use in this advance
  double acted_ = 0;      ///< s, how long the fluid's forces have acted in this advance
  bool detached_ = true;  ///< the memories are outside the lists
  ContactMemory memory_;
  ParticleRows wall_memory_;
  double mass_ = 0;  ///< kg, of this rank's particles
  Vec3 fluid_force_ = Vec3::Zero();
  int rebuilds_ = 0;
  std::string trouble_;  ///< what this rank found in the last evaluation
  std::vector<double> wall_force_sum_, wall_torque_sum_;
  Vec3 wall_total_ = Vec3::Zero();
  Brownian brownian_;
  std::vector<std::unique_ptr<ForceField>> fields_;
  std::unique_ptr<ParticleHeat> heat_;  ///< null: particles have no temperature
  Vec3 field_total_ =
      Vec3::Zero();        ///< N, of the last evaluation: what fields from outside do to this rank's particles
  double field_size_ = 0;  ///< N, of what particles do to each other by fields
};

}  // namespace silt
