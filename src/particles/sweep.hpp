#pragma once
#include <cstddef>

#include "particles/contact.hpp"

namespace silt {

/// What acts on a particle: force (N) and torque (N m), the fourth entries stay 0.
struct alignas(64) Load {
  double force[4];
  double torque[4];
};

/// One of the laws of a contact, as the sweep sees it: its place in its list of models (contact_models.hpp) and
/// its constants for every pair of materials.
struct LawStage {
  int model = 0;
  const double* constants = nullptr;  ///< [constants of the model][pairs of materials]
  int first_history = 0;              ///< its first component among the contact's history
};

/// The laws of all contacts of a run.
struct LawSetup {
  LawStage normal, adhesion, dlvo, bridge, interfacial, lubrication, tangential, rolling, twisting;
  int materials = 1;
  bool extended = false;        ///< a law reads the extended fields of Contact
  bool cohesive = false;        ///< a law acts beyond touching or pulls
  bool jumping = false;         ///< the force of a law jumps within a step (force_jump.hpp)
  bool traced = false;          ///< the sweep's trace is wanted
  bool slip_at_radius = false;  ///< the slip takes the spins at the radius, not at the arm to the contact point
  int history_components = 0;
  double enter_gap = 0;  ///< m, a pair is taken among the contacts when the surfaces are nearer than this
  double leave_gap = 0;  ///< m, and leaves them when they are further apart than this
};

/// Touching pairs: indices, and the history as one array per component. Padded to whole packs with the padding pair.
struct PairArrays {
  int count = 0;
  const int *i = nullptr, *j = nullptr;
  double* history = nullptr;  ///< [components][stride]
  std::size_t stride = 0;
};

/// Periods of the domain; half a period is further than any contact reaches.
struct Periods {
  double length[3] = {0, 0, 0};   ///< m, 0 where not periodic
  double inverse[3] = {0, 0, 0};  ///< 1/m, 0 where not periodic
  bool any = false;
};

/// What a sweep may leave behind of every contact, a component after the other: the normal law's force (N), all force
/// on i (N), the couple of rolling and twisting on i (N m).
inline constexpr int trace_width = 7;

struct PairSweep {
  const Motion* motion = nullptr;
  const Rotation* rotation = nullptr;
  Load* load = nullptr;
  PairArrays pairs;
  int first = 0;  ///< where among them to begin, at a whole pack
  LawSetup laws;
  Periods periods;
  double dt = 0;
  double deepest_share = 1;  ///< overlap allowed, as a share of the smaller radius
  /// Both partners are to be asked for ahead: few contacts, far apart, or more particles than the caches hold.
  bool scattered = false;
  /// out: a bit for each pair, set where it no longer touches; [(count + 7)/8], zero before
  unsigned char* leaving = nullptr;
  int leaving_count = 0;    ///< out: how many
  int too_deep = -1;        ///< out: place of a pair with too large an overlap, or -1
  double* trace = nullptr;  ///< out: [trace_width][pairs.stride], null: not wanted; needs laws.traced
};

struct CandidateSweep {
  const Motion* motion = nullptr;
  int count = 0;  ///< padded as PairArrays
  const int *i = nullptr, *j = nullptr;
  Periods periods;
  double enter_gap = 0;   ///< m, a contact begins when the surfaces are nearer than this
  double* gap = nullptr;  ///< out: m, what each pair lacks to a contact, negative where it is one; padded as the pairs
};

/// How many pairs touch, how deeply and which way; each is counted by the owner of its first particle.
struct ContactCensus {
  const Motion* motion = nullptr;
  int owned = 0;
  int count = 0;  ///< padded as PairArrays
  const int *i = nullptr, *j = nullptr;
  Periods periods;
  double touching = 0;           ///< out: pairs that overlap
  double largest = 0;            ///< out: largest overlap, as a share of the smaller radius
  double fabric[3] = {0, 0, 0};  ///< out: sums of the squared components of their normals
};

/// Which of many spheres are near one.
struct NearSearch {
  struct Stretch {
    int begin, end;
  };
  const double* x[3] = {};         ///< coordinates of the many; seven beyond the last may be read
  const double* radius = nullptr;  ///< as x
  const Stretch* stretch = nullptr;
  int stretches = 0;    ///< those to look at
  int after = -1;       ///< of them only those with higher numbers
  bool across = false;  ///< the nearest image may be another than the sphere itself
  const Periods* periods = nullptr;
  double sphere[4] = {};     ///< x, y, z, radius of the one
  double reach = 0;          ///< m, surfaces further apart are not near
  int* found = nullptr;      ///< out: numbers of those near; room for all looked at and seven
  double* square = nullptr;  ///< out: m2, squared distances of their centres
  int count = 0;             ///< out
};

/// The pairs of near spheres of a row of cells of a grid along x: of its spheres with those behind them in it, and with
/// all in other rows. The coordinates are rounded to single precision, so that twice as many spheres fit a register;
/// who asks adds what that may cost to the reach and takes it off the gaps.
struct RowSearch {
  const float* x[3] = {};         ///< m, coordinates of the many, sorted along cells; seven beyond the last may be read
  const float* radius = nullptr;  ///< as x
  const int* column = nullptr;    ///< which cell of its row each of the many is in
  /// A row of cells to look at.
  struct Row {
    const int* start;  ///< [cells + 1] where its cells begin among the many
    float shift[2];    ///< m, to be added to y and z of its spheres, where it is met across a periodic side
  };
  Row row[9];              ///< first the seekers' own
  int rows = 0;            ///< how many there are
  int cells = 0;           ///< in a row
  float period = 0;        ///< m, along the row; 0: its ends do not meet. Else it has three cells at least
  float reach = 0;         ///< m, surfaces further apart are not near
  int* seeker = nullptr;   ///< out: the first of each pair, its number among the many
  int* found = nullptr;    ///< out: the second
  float* gap = nullptr;    ///< out: m, between their surfaces
  float* radii = nullptr;  ///< m, sums of the radii of the pairs
  int room = 0;            ///< of these; the search stops where it might not suffice
  int next = 0, last = 0;  ///< in and out: the next seeker, those before `last`
  int count = 0;           ///< out: pairs
  int needed = 0;          ///< out: the least room to go on where none was found for want of it
};

/// Contacts with walls: the points the geometry gave, with history as for pairs.
struct WallSweep {
  const Motion* motion = nullptr;
  const Rotation* rotation = nullptr;
  Load* load = nullptr;
  int count = 0;
  const WallPoint* points = nullptr;
  double* history = nullptr;
  std::size_t stride = 0;
  LawSetup laws;
  double dt = 0;
  double (*wall_force)[3] = nullptr;   ///< out: N, added to the entry of each point's boundary; force on the particles
  double (*wall_torque)[3] = nullptr;  ///< out: N m, about the origin, on the particles
  double* trace = nullptr;             ///< out: [trace_width][stride] as for pairs
};

/// The fluid's share in a particle's motion over one substep, from FluidAction: exponential integration of
/// (m + added mass) dv/dt = F + k (u - v). `rate` is k over both masses.
struct alignas(64) DragStep {
  double velocity[3];      ///< m/s, u
  double share;            ///< m/(m + added mass): what of every force accelerates the particle
  double acceleration[4];  ///< m/s2, other fluid forces over the mass
  double impulse[4];       ///< N s, drag impulse received; in the last place J, the work of the fluid; summed up
  double rate;             ///< 1/s, k/m
  double first;            ///< s, phi = (1 - exp(-rate h))/rate; h without drag
  double second;           ///< s2, psi = (h - phi)/rate; h^2/2 without drag
  double corrector;        ///< s, psi/h; h/2 without drag
};

/// The fluid's hold on a particle's spin over one substep: I dw/dt = M + k (spin - w), integrated like the drag.
struct alignas(64) TurnStep {
  double spin[4];    ///< rad/s, that the fluid would have
  double rate;       ///< 1/s, k/I
  double first;      ///< s, (1 - exp(-rate h))/rate
  double corrector;  ///< s, (h - first)/(rate h)
  double second;     ///< s2, (h - first)/rate; h^2/2 without torque, more with semi-implicit Euler as for DragStep
};

/// Velocity Verlet as predictor (drift: position, and velocity with the present force, so that velocity-dependent
/// contact forces see the velocity of their own time) and corrector (half the change of the force); semi-implicit Euler
/// is a drift with second = h^2, without corrector; leapfrog drifts with half of the present force and corrects with
/// the other half and half of the new one.
struct Integration {
  Motion* motion = nullptr;
  Rotation* rotation = nullptr;
  Load *present = nullptr, *previous = nullptr;  ///< forces at the present positions; those of the step before
  /// Not 0 where the present or the previous load may be; null: anywhere.
  const unsigned char *loaded = nullptr, *loaded_before = nullptr;
  DragStep* drag = nullptr;           ///< null: no fluid
  const TurnStep* turning = nullptr;  ///< null: no viscous torque; only with drag
  int count = 0;
  double dt = 0;
  double second = 0;                   ///< s2, how far a unit acceleration moves and turns a particle without a fluid
  double (*orientation)[4] = nullptr;  ///< unit quaternions w, x, y, z; null: not wanted
  double (*turned)[4] = nullptr;       ///< out: rad, the rotation vector of the step; null: not wanted
  double late_share = 0.5;             ///< of the forces at the end of a step in its impulse
  bool leapfrog = false;  ///< half of the impulse of the forces at its beginning, too, is given by the corrector only
  alignas(32) double gravity[4] = {0, 0, 0, 0};
  alignas(32) double move[4] = {1, 1, 1, 0};  ///< directions that may move
  alignas(32) double turn[4] = {1, 1, 1, 0};  ///< axes that may turn
  bool correct = false, drift = false;
  double largest_square = 0;  ///< out: m2, largest squared displacement in this step
  double check = 0;           ///< out: finite when every displacement is
};

/// The loops over contacts and particles, for one instruction set.
struct Kernels {
  const char* name;
  void (*pairs)(PairSweep&);
  void (*candidates)(CandidateSweep&);
  void (*census)(ContactCensus&);
  void (*walls)(WallSweep&);
  void (*integrate)(Integration&);
  void (*near)(NearSearch&);
  void (*near_row)(RowSearch&);
};

extern const Kernels plain_kernels, avx2_kernels, avx512_kernels;

/// The widest this processor can run, or the one named plain, avx2, avx512; throws UserError when it cannot.
const Kernels& choose_kernels(const char* name = "auto");

}  // namespace silt
