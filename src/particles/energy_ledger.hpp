#pragma once
#include <array>
#include <vector>

#include "base/vector.hpp"
#include "particles/aligned.hpp"
#include "particles/contact_laws.hpp"
#include "particles/contact_lists.hpp"
#include "particles/particles.hpp"
#include "particles/store.hpp"
#include "particles/wall_contacts.hpp"

namespace silt {

/// What the ledger looks at after a substep; `h` is its length (0: only where the account begins anew).
struct EnergyStep {
  Store& store;
  const ContactLists& contacts;
  const WallContacts& walls;
  const ContactLaws& laws;
  const Periods& periods;
  Integration pass;  ///< gravity and the directions that may move
  bool fluid = false;
  double h = 0;
};

/// The energy of this rank's particles and the work done on them, by mechanism (`-particles_energy`).
///
/// With velocity Verlet m (v' - v) = h/2 (F + F'), so the kinetic energy changes by h/2 (F.v + F'.v') up to a
/// telescoping rest h^2/(8 m) (F^2 - F'^2); the power of every mechanism is therefore taken with the forces that acted,
/// as the sweep left them, and the velocities at the end of the step, and summed by the trapezoid rule. With
/// semi-implicit Euler the exact velocity is the mean of those before and after the force acted, v + h/2 F/m. What the
/// fluid gave a particle is m (v' - v) - h/2 (F + F') - h m g times the mean velocity, torques likewise.
///
/// The normal law's force splits into its value at rest (elastic) and the remainder (damping); its potential is that
/// value integrated over the overlap. A law with memory or beyond touching has no such potential: what it stores is the
/// work it has not given back.
class EnergyLedger {
 public:
  using Work = Particles::EnergyAccount::Work;

  /// Registers the column that carries the velocities of the last account.
  explicit EnergyLedger(Columns& columns);

  /// Makes the sweeps keep what the contacts exert, until account().
  void trace(PairSweep& sweep);
  void trace(WallSweep& sweep);
  /// What fields do to the particles is the change of their loads between the two calls.
  void before_fields(const Store& store);
  void after_fields(const Store& store);
  /// Remembers the velocities at which the step starts (the coupling may have kicked particles since the last one).
  void begin(Store& store);
  /// Adds the work of the step; the lists must be those of the sweep.
  void account(const EnergyStep& step);

  void came(const Body& body) { work_[Particles::EnergyAccount::added] += energy(body); }
  void went(const Body& body) { work_[Particles::EnergyAccount::removed] += energy(body); }
  /// Left within a step: with the velocities of its last account.
  void went_from(const Body& body, const std::vector<double>& columns, const Columns& where);
  void kicked(const Motion& motion, const Vec3& impulse);
  /// Begins anew: what is there counts as added.
  void restart(const Store& store);

  const Work& work() const { return work_; }
  double stored() const { return stored_; }
  /// Numbers to go on from.
  struct State {
    Work work{}, power{};
    double stored = 0;
  };
  State state() const { return {work_, power_, stored_}; }
  void set_state(const State& state) { work_ = state.work, power_ = state.power, stored_ = state.stored; }
  void add_state(const State& state);
  static double energy(const Body& body);

 private:
  /// Force at rest (N) and potential (J) of the normal law at every contact.
  struct Elastic {
    std::vector<double> force, energy;
    std::vector<char> damped;  ///< whether the force depends on which way the surfaces move
    bool potential = true;
    /// Elastic part (N) of what the law exerted at contact k: all of it without a dashpot (its reading may take off an
    /// error of the step, which its value at rest does not know).
    double of(int k, double exerted) const { return damped[k] && (potential || force[k] != 0) ? force[k] : exerted; }
  };
  template <class ContactAt>
  void find_elastic(const ContactLaws& laws, int count, ContactAt&& contact_at, Elastic& elastic) const;
  void add_pairs(const EnergyStep& step, Work& power, double& stored);
  void add_walls(const EnergyStep& step, Work& power, double& stored);
  void add_singles(const EnergyStep& step, Work& power);
  void add_fluid(const EnergyStep& step);
  /// The velocity and spin with which the present loads do their work.
  void working_motion(const EnergyStep& step, int p, Vec3& velocity, Vec3& spin) const;

  int column_;
  Work work_{}, power_{};
  double stored_ = 0;
  Aligned<double> pair_trace_, wall_trace_;  ///< [trace_width][stride], see sweep.hpp
  std::size_t pair_stride_ = 0, wall_stride_ = 0;
  std::vector<Load> field_;  ///< of the last evaluation; empty without fields
  Elastic elastic_;
};

}  // namespace silt
