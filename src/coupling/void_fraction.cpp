#include "coupling/void_fraction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/error.hpp"

namespace silt {

void VoidFraction::start(std::span<const double> solids_fraction, double least) {
  for (std::size_t i = 0; i < previous_.size(); ++i) previous_[i] = 1 - solids_fraction[i];
  check(previous_, least);
}

void VoidFraction::advance(std::span<const double> solids_fraction, double dt, double least, std::span<double> alpha,
                           std::span<double> rate) const {
  for (std::size_t i = 0; i < previous_.size(); ++i) {
    alpha[i] = 1 - solids_fraction[i];
    rate[i] = (alpha[i] - previous_[i]) / dt;
  }
  check(alpha, least);
}

void VoidFraction::check(std::span<const double> alpha, double least) const {
  struct {
    double value;
    int rank;
  } lowest{std::numeric_limits<double>::max(), mpi_rank()};
  std::size_t where = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    if (!(alpha[i] >= lowest.value)) lowest.value = alpha[where = i];
  }
  MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_DOUBLE_INT, MPI_MINLOC, PETSC_COMM_WORLD);
  if (lowest.value >= least) return;
  Vec3 x = Vec3::Zero();
  if (lowest.rank == mpi_rank() && !mesh_.node_coordinates.empty()) x = vec3(&mesh_.node_coordinates[3 * where]);
  MPI_Bcast(x.data(), 3, MPI_DOUBLE, lowest.rank, PETSC_COMM_WORLD);
  throw RunError(
      fmt::format("the void fraction falls to {:.4g} at ({:.4g}, {:.4g}, {:.4g}) m, below "
                  "coupling_void_fraction_minimum = {:.4g}: the particles overlap too "
                  "much there, or the filter is too narrow for them (coupling_filter_length)",
                  lowest.value, x[0], x[1], x[2], least));
}

}  // namespace silt
