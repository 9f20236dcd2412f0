#include "particles/swarm_store.hpp"

#include <cstring>

namespace silt {
namespace {

/// Fills one field of the swarm, particle by particle.
template <class T, class Value>
void fill(DM swarm, const char* name, int count, int components, Value&& value) {
  void* data = nullptr;
  PetscInt size = 0;
  PetscDataType type;
  SILT_PETSC(DMSwarmGetField(swarm, name, &size, &type, &data));
  T* field = static_cast<T*>(data);
  for (int p = 0; p < count; ++p)
    for (int c = 0; c < components; ++c) field[p * components + c] = static_cast<T>(value(p, c));
  SILT_PETSC(DMSwarmRestoreField(swarm, name, &size, &type, &data));
}

}  // namespace

void SwarmStore::create(const Mesh& mesh) {
  SILT_PETSC(DMCreate(PETSC_COMM_WORLD, swarm_.out()));
  SILT_PETSC(DMSetType(swarm_, DMSWARM));
  SILT_PETSC(DMSetDimension(swarm_, mesh.dimension));
  SILT_PETSC(DMSwarmSetType(swarm_, DMSWARM_BASIC));
  SILT_PETSC(DMSwarmRegisterPetscDatatypeField(swarm_, "id", 1, PETSC_LONG));
  SILT_PETSC(DMSwarmRegisterPetscDatatypeField(swarm_, "material", 1, PETSC_INT));
  for (const char* name : {"position", "velocity", "spin", "fluid_velocity", "drag_impulse"})
    SILT_PETSC(DMSwarmRegisterPetscDatatypeField(swarm_, name, 3, PETSC_REAL));
  for (const char* name : {"radius", "mass", "exchange"})
    SILT_PETSC(DMSwarmRegisterPetscDatatypeField(swarm_, name, 1, PETSC_REAL));
  SILT_PETSC(DMSwarmFinalizeFieldRegister(swarm_));
}

DM SwarmStore::refresh(const Mesh& mesh, const Store& store) {
  if (!swarm_) create(mesh);
  const int n = store.owned;
  SILT_PETSC(DMSwarmSetLocalSizes(swarm_, n, 16));
  fill<long>(swarm_, "id", n, 1, [&](int p, int) { return store.id[p]; });
  fill<PetscInt>(swarm_, "material", n, 1, [&](int p, int) { return store.rotation[p].material; });
  fill<PetscReal>(swarm_, "position", n, 3, [&](int p, int d) { return store.motion[p].position[d]; });
  fill<PetscReal>(swarm_, "velocity", n, 3, [&](int p, int d) { return store.motion[p].velocity[d]; });
  fill<PetscReal>(swarm_, "spin", n, 3, [&](int p, int d) { return store.rotation[p].spin[d]; });
  fill<PetscReal>(swarm_, "radius", n, 1, [&](int p, int) { return store.motion[p].radius; });
  fill<PetscReal>(swarm_, "mass", n, 1, [&](int p, int) { return 1 / store.motion[p].inverse_mass; });
  const FluidAction none;
  const auto action = [&](int p) -> const FluidAction& { return store.acted_on ? store.action[p] : none; };
  fill<PetscReal>(swarm_, "fluid_velocity", n, 3, [&](int p, int d) { return action(p).velocity[d]; });
  fill<PetscReal>(swarm_, "exchange", n, 1, [&](int p, int) { return action(p).exchange; });
  fill<PetscReal>(swarm_, "drag_impulse", n, 3, [&](int p, int d) { return action(p).impulse[d]; });
  const int rank = mpi_rank();
  fill<PetscInt>(swarm_, DMSwarmField_rank, n, 1, [&](int, int) { return rank; });
  return swarm_;
}

}  // namespace silt
