#include "app/departures.hpp"

#include <algorithm>
#include <array>

#include "base/petsc.hpp"

namespace silt {
namespace {
constexpr int columns = 10;
}

void Departures::start(const OutputDirectory& directory) {
  table_ = directory.table("removed.csv", {"time", "id", "position_x", "position_y", "position_z", "velocity_x",
                                           "velocity_y", "velocity_z", "mass", "boundary"});
}

void Departures::record(const Moment& moment) {
  if (!moment.particles) return;
  std::vector<double> mine;
  for (const Departed& gone : moment.particles->departed()) {
    mine.insert(mine.end(), {moment.time, static_cast<double>(gone.id)});
    for (const Vec3* v : {&gone.position, &gone.velocity}) mine.insert(mine.end(), v->data(), v->data() + 3);
    mine.insert(mine.end(), {gone.mass, static_cast<double>(gone.boundary)});
  }
  int count = static_cast<int>(mine.size());
  std::vector<int> counts(mpi_size()), first(mpi_size(), 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (int r = 1; r < mpi_size(); ++r) first[r] = first[r - 1] + counts[r - 1];
  std::vector<double> all(first.back() + counts.back());
  if (all.empty()) return;
  MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), first.data(), MPI_DOUBLE, PETSC_COMM_WORLD);
  std::vector<std::array<double, columns>> rows(all.size() / columns);
  for (size_t k = 0; k < rows.size(); ++k) std::copy_n(&all[columns * k], columns, rows[k].begin());
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
  table_.row({rows.front().data(), all.size()});
}

}  // namespace silt
