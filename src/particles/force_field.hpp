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
  /// Durations that the time step must resolve, for the smallest particles of each material.
  virtual std::vector<StepBound> bounds(const Materials& materials, const SmallestRadii& smallest) const = 0;
  /// Distance beyond which nothing acts (a cut-off), m; 0 when it acts on all.
  virtual std::string description() const = 0;
};

/// What the user chose by `-magnetic_...`, `-electric_...`, `-thermophoresis_...`; their columns are registered.
std::vector<std::unique_ptr<ForceField>> make_force_fields(Options& options, const Mesh& mesh, Columns& columns,
                                                           const std::string& instructions);

}  // namespace silt
