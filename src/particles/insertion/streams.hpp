#pragma once
#include <memory>
#include <string>
#include <vector>

#include "particles/insertion/dense_packing.hpp"
#include "particles/insertion/size_distribution.hpp"
#include "particles/particles.hpp"
#include "particles/walls/walls.hpp"

namespace silt {

class Materials;

/// The options `-removal_<name>_...`: a box in which particles are taken out of the run.
struct RemovalOptions {
  std::optional<Vec3> lower, upper;
  double start = 0, end = 1e300;
  void options(OptionGroup& option);
};

/// What a stream has done so far: all that a restart or a step back needs.
struct StreamState {
  double added = 0, mass = 0;        ///< number and kg of particles
  double drawn[4] = {0, 0, 0, 0};    ///< random numbers used for sizes, materials, places, velocities
  double radius = 0, material = -1;  ///< of the particle that waits for room; radius 0: none
};

/// The particles that come and go during a run: `-insertion_<name>_type stream` and `-removal_<name>_...`. What is
/// added is decided alike on every rank from the particles near the region, of all ranks, in the order of their
/// numbers: the same particles for any rank count.
class Streams {
 public:
  /// Reads the options; `walls` and `materials` stay with the caller. Throws UserError. Collective.
  Streams(const Walls& walls, Options& options, const Materials& materials, const std::vector<std::string>& names);
  ~Streams();

  int count() const { return static_cast<int>(states_.size()); }
  /// Indices of the materials that streams bring, with repeats.
  std::vector<int> materials() const;
  bool removes() const { return !removals_.empty(); }
  /// Whether stream s has anything to add in the step from time to time + dt.
  bool due(int s, double time, double dt) const;
  /// The box that centres of its particles may lie in, grown by its largest radius. m
  Box region(int s) const;
  /// The particles it adds, given the spheres there are near its region. What finds no room waits for the next step.
  std::vector<Seed> add(int s, double time, double dt, const std::vector<PlacedSphere>& near);
  /// Whether a particle here is taken out in the step that begins at this time.
  bool removed(const Vec3& x, double time) const;

  const std::vector<StreamState>& states() const { return states_; }
  void set_states(const std::vector<StreamState>& states) { states_ = states; }

 private:
  struct Source;
  std::unique_ptr<Room> room_;
  Vec3 period_ = Vec3::Zero();
  const Materials& materials_;
  std::vector<Source> sources_;
  std::vector<StreamState> states_;
  std::vector<RemovalOptions> removals_;
};

}  // namespace silt
