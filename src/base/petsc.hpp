#pragma once
#include <petscdmplex.h>
#include <petscdmswarm.h>
#include <petscksp.h>
#include <petscsf.h>
#include <petscsnes.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace silt {

/// An error raised by PETSc, with PETSc's own message; never a user mistake (those are UserError).
struct PetscFailure : std::runtime_error {
  PetscFailure(PetscErrorCode code, const char* call, const char* file, int line);
  PetscErrorCode code;
};

/// Checks a PETSc call in our own code, where exceptions may fly. Inside PETSc callbacks use PetscCall instead.
#define SILT_PETSC(...)                                                                       \
  do {                                                                                        \
    PetscErrorCode silt_code_ = (__VA_ARGS__);                                                \
    if (silt_code_) throw ::silt::PetscFailure(silt_code_, #__VA_ARGS__, __FILE__, __LINE__); \
  } while (0)

/// Initialises MPI and PETSc for its lifetime; PETSc's messages are kept for PetscFailure instead of being printed.
class PetscSession {
 public:
  PetscSession();
  PetscSession(int argc, char** argv);
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

/// Owner of a reference-counted PETSc object: `Handle<Vec, VecDestroy> v; VecCreate(comm, v.out());`.
template <class T, PetscErrorCode (*Destroy)(T*)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(T object) : object_(object) {}
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  /// Destroys what is held.
  void reset() {
    if (object_) Destroy(&object_);
    object_ = nullptr;
  }
  /// Where a PETSc create function writes; destroys what was held.
  T* out() {
    reset();
    return &object_;
  }
  operator T() const { return object_; }
  T get() const { return object_; }

 private:
  T object_ = nullptr;
};

using DmHandle = Handle<DM, DMDestroy>;
using VecHandle = Handle<Vec, VecDestroy>;
using MatHandle = Handle<Mat, MatDestroy>;
using KspHandle = Handle<KSP, KSPDestroy>;
using SnesHandle = Handle<SNES, SNESDestroy>;
using SfHandle = Handle<PetscSF, PetscSFDestroy>;
using IsHandle = Handle<IS, ISDestroy>;

/// Rank and size of the world communicator.
int mpi_rank();
int mpi_size();

/// Sums, minima and maxima over all ranks.
double mpi_sum(double value);
long long mpi_sum(long long value);
double mpi_min(double value);
double mpi_max(double value);
/// True when true on any rank.
bool mpi_any(bool value);

}  // namespace silt
