#pragma once
#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "base/options.hpp"
#include "particles/materials.hpp"
#include "particles/store.hpp"
#include "particles/time_step.hpp"

namespace silt {

/// One evaluation of the fields: forces and torques are added to Store::present of this rank's particles.
struct FieldStep {
  Store& store;
  const Periods& periods;
  const Materials& materials;
  MPI_Comm communicator;
  double time;                   ///< s, of the positions
  double dt;                     ///< s, since the evaluation before; 0 at the start
  Vec3 external = Vec3::Zero();  ///< out: N, the part that no other particle feels the opposite of, on this rank
  double size = 0;               ///< out: N, sum of the magnitudes of what particles do to each other, on this rank
};

/// A field that acts at a distance: magnetic, electric, by temperature. One call a substep.
class ForceField {
 public:
  virtual ~ForceField() = default;
  virtual void act(FieldStep& step) = 0;
  /// Whether it has vectors that are fixed in the particles.
  virtual bool turns() const { return false; }
  /// Turns them by the rotation vectors of a step ([owned][4], rad).
  virtual void turn(Store&, const double (*)[4]) {}
  /// Durations that the time step must resolve, for the smallest particles of each material.
  virtual std::vector<StepBound> bounds(const Materials& materials, const SmallestRadii& smallest) const = 0;
  /// What the user should know at these sizes, a line each.
  virtual std::vector<std::string> warnings(const Materials& materials, const SmallestRadii& smallest) const = 0;
  virtual std::string description() const = 0;
};

/// For the smallest particles of each material, a line where a force that falls as the distance to the power `-power`
/// is cut off (option `name`, m; 0: never) at more than 1e-3 of its size in contact.
std::vector<std::string> cutoff_warnings(const std::string& name, double cutoff, double power,
                                         const Materials& materials, const SmallestRadii& smallest);

/// What the user chose by `-magnetic_...`, `-electric_...`, `-thermophoresis_...`; their columns are registered.
std::vector<std::unique_ptr<ForceField>> make_force_fields(Options& options, const Mesh& mesh, Columns& columns,
                                                           const std::string& instructions);

}  // namespace silt
