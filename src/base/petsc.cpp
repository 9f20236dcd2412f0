#include "base/petsc.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <utility>

namespace silt {
namespace {

std::string last_message;

PetscErrorCode keep_message(MPI_Comm, int line, const char* function, const char* file, PetscErrorCode code,
                            PetscErrorType type, const char* message, void*) {
  if (type == PETSC_ERROR_INITIAL)
    last_message = fmt::format("{} ({}:{} {})", message ? message : "", file, line, function);
  return code;
}

/// A process that nobody launched talks to nobody. Without this Open MPI starts a daemon for it and tries networks that
/// are not there, which takes 0.3 s.
void leave_out_the_network() {
  for (const char* launcher : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
    if (std::getenv(launcher)) return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_pml", "ob1", 0);
}

void start(int* argc, char*** argv) {
  leave_out_the_network();
  // PETSc calls BLAS on small blocks from every rank: more than one thread each only loses time.
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  setenv("OMP_NUM_THREADS", "1", 0);
  // PTScotch with several threads cuts the same mesh differently now and then (one in eight runs on three ranks).
  setenv("SCOTCH_PTHREAD_NUMBER", "1", 0);
  PetscInitialize(argc, argv, nullptr, nullptr);
  PetscPushErrorHandler(keep_message, nullptr);
  if (mpi_size() == 1) return;
  // Sums in the order of the ranks instead of that of arrival (entries of matrices that other ranks add, products of
  // the multigrid hierarchies): the same input on as many ranks gives the same bits. Asking again marks the options as
  // used, which they are not on one rank.
  for (const auto& [name, value] : {std::pair("-matptap_via", "allatonce"), std::pair("-matstash_legacy", "yes"),
                                    std::pair("-matstash_reproduce", "yes"), std::pair("-vecstash_reproduce", "yes")}) {
    PetscBool given = PETSC_FALSE;
    PetscOptionsHasName(nullptr, nullptr, name, &given);
    if (!given) PetscOptionsSetValue(nullptr, name, value);
    PetscOptionsHasName(nullptr, nullptr, name, &given);
  }
}

template <class T>
T reduce(T value, MPI_Datatype type, MPI_Op operation) {
  T result = value;
  MPI_Allreduce(&value, &result, 1, type, operation, PETSC_COMM_WORLD);
  return result;
}

}  // namespace

PetscFailure::PetscFailure(PetscErrorCode error, const char* call, const char* file, int line)
    : std::runtime_error(
          fmt::format("PETSc error {} in {} ({}:{}): {}", static_cast<int>(error), call, file, line, last_message)),
      code(error) {}

PetscSession::PetscSession() { start(nullptr, nullptr); }
PetscSession::PetscSession(int argc, char** argv) { start(&argc, &argv); }
PetscSession::~PetscSession() {
  PetscPopErrorHandler();
  PetscFinalize();
}

int mpi_rank() {
  int rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  return rank;
}

int mpi_size() {
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  return size;
}

double mpi_sum(double value) { return reduce(value, MPI_DOUBLE, MPI_SUM); }
long long mpi_sum(long long value) { return reduce(value, MPI_LONG_LONG, MPI_SUM); }
double mpi_min(double value) { return reduce(value, MPI_DOUBLE, MPI_MIN); }
double mpi_max(double value) { return reduce(value, MPI_DOUBLE, MPI_MAX); }
bool mpi_any(bool value) { return reduce(static_cast<int>(value), MPI_INT, MPI_MAX) != 0; }

}  // namespace silt
