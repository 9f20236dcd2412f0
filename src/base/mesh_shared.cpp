// Sums and copies over the nodes that several ranks hold.
#include <map>

#include "base/mesh.hpp"

namespace silt {
namespace {

/// A contiguous MPI type of that many doubles, made once.
MPI_Datatype doubles(int components) {
  static std::map<int, MPI_Datatype> types;
  auto [it, added] = types.try_emplace(components, MPI_DOUBLE);
  if (added && components > 1) {
    MPI_Type_contiguous(components, MPI_DOUBLE, &it->second);
    MPI_Type_commit(&it->second);
  }
  return it->second;
}

}  // namespace

void Mesh::sum_shared(double* values, int components) const {
  if (mpi_size() == 1 || components == 0) return;
  SILT_PETSC(PetscSFReduceBegin(node_exchange_, doubles(components), values, values, MPI_SUM));
  SILT_PETSC(PetscSFReduceEnd(node_exchange_, doubles(components), values, values, MPI_SUM));
  copy_from_owner(values, components);
}

void Mesh::copy_from_owner(double* values, int components) const {
  if (mpi_size() == 1 || components == 0) return;
  SILT_PETSC(PetscSFBcastBegin(node_exchange_, doubles(components), values, values, MPI_REPLACE));
  SILT_PETSC(PetscSFBcastEnd(node_exchange_, doubles(components), values, values, MPI_REPLACE));
}

double Mesh::dot(const double* a, const double* b, int components) const {
  double sum = 0;
  for (int i = 0; i < owned_nodes * components; ++i) sum += a[i] * b[i];
  return mpi_sum(sum);
}

}  // namespace silt
