# Every dependency is a Debian package; scripts/setup installs them.
find_package(PkgConfig REQUIRED)
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(yaml-cpp REQUIRED)
pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET PETSc)
pkg_check_modules(HDF5 REQUIRED IMPORTED_TARGET hdf5-openmpi)
pkg_check_modules(MUPARSER REQUIRED IMPORTED_TARGET muparser)

add_library(silt_dependencies INTERFACE)
target_link_libraries(silt_dependencies INTERFACE MPI::MPI_CXX PkgConfig::PETSC PkgConfig::HDF5
                      PkgConfig::MUPARSER Eigen3::Eigen fmt::fmt yaml-cpp)
# The C++ bindings of MPI are gone from the standard; their header only slows compilation.
target_compile_definitions(silt_dependencies INTERFACE OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX
                           EIGEN_MAX_STATIC_ALIGN_BYTES=32)

# Headers of others that most units include. Own headers are not among them: each stays complete in itself.
set(SILT_PRECOMPILED <petsc.h> <Eigen/Dense> <fmt/format.h> <algorithm> <array> <cmath> <filesystem> <fstream> <functional> <map>
                     <memory> <numbers> <optional> <span> <string> <vector>)
