#pragma once
#include <vector>

#include "base/petsc.hpp"
#include "fluid/space/velocity_constraints.hpp"

namespace silt {

/// Turns the velocities among nodal values into the frames of their constraints; frames are orthonormal, so residuals
/// and unknowns turn alike. place(node): index of the first velocity component of a node.
template <class Place>
void to_frames(const VelocityConstraints& constraints, int dimension, Place place, double* values) {
  for (const auto& c : constraints.constraints()) {
    if (c.count == dimension) continue;
    double* v = values + place(c.node);
    Vec3 cartesian = Vec3::Zero();
    for (int i = 0; i < dimension; ++i) cartesian[i] = v[i];
    for (int k = 0; k < dimension; ++k) v[k] = c.frame[k].dot(cartesian);
  }
}

/// And back.
template <class Place>
void from_frames(const VelocityConstraints& constraints, int dimension, Place place, double* values) {
  for (const auto& c : constraints.constraints()) {
    if (c.count == dimension) continue;
    double* v = values + place(c.node);
    Vec3 cartesian = Vec3::Zero();
    for (int k = 0; k < dimension; ++k) cartesian += v[k] * c.frame[k];
    for (int i = 0; i < dimension; ++i) v[i] = cartesian[i];
  }
}

/// Local values, as many as `local` holds, to the global vector x (INSERT_VALUES, or ADD_VALUES: the sum over ranks),
/// and back. Collective.
PetscErrorCode to_global(const std::vector<double>& values, Vec local, VecScatter scatter, Vec x, InsertMode mode);
PetscErrorCode from_global(Vec x, VecScatter scatter, Vec local, std::vector<double>& values);

}  // namespace silt
