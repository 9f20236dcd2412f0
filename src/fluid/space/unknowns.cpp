#include "fluid/space/unknowns.hpp"

#include <algorithm>

namespace silt {

PetscErrorCode to_global(const std::vector<double>& values, Vec local, VecScatter scatter, Vec x, InsertMode mode) {
  PetscFunctionBeginUser;
  double* array;
  PetscCall(VecGetArrayWrite(local, &array));
  std::copy(values.begin(), values.end(), array);
  PetscCall(VecRestoreArrayWrite(local, &array));
  if (mode == ADD_VALUES) PetscCall(VecSet(x, 0));
  PetscCall(VecScatterBegin(scatter, local, x, mode, SCATTER_REVERSE));
  PetscCall(VecScatterEnd(scatter, local, x, mode, SCATTER_REVERSE));
  PetscFunctionReturn(0);
}

PetscErrorCode from_global(Vec x, VecScatter scatter, Vec local, std::vector<double>& values) {
  PetscFunctionBeginUser;
  PetscCall(VecScatterBegin(scatter, x, local, INSERT_VALUES, SCATTER_FORWARD));
  PetscCall(VecScatterEnd(scatter, x, local, INSERT_VALUES, SCATTER_FORWARD));
  PetscInt size;
  PetscCall(VecGetLocalSize(local, &size));
  const double* array;
  PetscCall(VecGetArrayRead(local, &array));
  values.assign(array, array + size);
  PetscCall(VecRestoreArrayRead(local, &array));
  PetscFunctionReturn(0);
}

}  // namespace silt
