#pragma once
#include <stdlib.h>

#include <filesystem>
#include <string>

#include "base/petsc.hpp"

/// A directory of the test's own, the same on every rank, removed at the end.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    char name[] = "/tmp/silt_test_XXXXXX";
    if (silt::mpi_rank() == 0 && !mkdtemp(name)) std::abort();
    MPI_Bcast(name, sizeof name, MPI_CHAR, 0, PETSC_COMM_WORLD);
    path_ = name;
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  ~TemporaryDirectory() {
    MPI_Barrier(PETSC_COMM_WORLD);
    std::error_code code;
    if (silt::mpi_rank() == 0) std::filesystem::remove_all(path_, code);
  }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};
