#pragma once
#include "base/mesh.hpp"
#include "particles/store.hpp"

namespace silt {

/// The particles as a DMSwarm: registered fields, for output, projections and whatever else PETSc offers. The step
/// works on its own arrays; the swarm is brought up to date when somebody looks. DMSwarm's own migration is never used.
class SwarmStore {
 public:
  /// The swarm with the present particles of this rank. Collective.
  DM refresh(const Mesh& mesh, const Store& store);

 private:
  void create(const Mesh& mesh);
  DmHandle swarm_;
};

}  // namespace silt
