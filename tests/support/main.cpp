// Entry of every Catch2 test executable: PETSc is up while the tests run, and only rank 0 reports success.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include <cstdio>

#include "base/petsc.hpp"

int main(int argc, char** argv) {
  silt::PetscSession session;
  int result = Catch::Session().run(argc, argv);
  int worst = 0;
  MPI_Allreduce(&result, &worst, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
  return worst;
}
