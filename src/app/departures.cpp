#include "app/departures.hpp"

#include <algorithm>
#include <array>

#include "base/petsc.hpp"

namespace silt {
namespace {
constexpr int columns = 10;
using Row = std::array<double, columns>;
}  // namespace

void Departures::start(const OutputDirectory& directory) {
  table_ = directory.table("removed.csv", {"time", "id", "position_x", "position_y", "position_z", "velocity_x",
                                           "velocity_y", "velocity_z", "mass", "boundary"});
}

void Departures::record(const Moment& moment) {
  if (!moment.particles) return;
  std::vector<Row> mine;
  for (const Departed& gone : moment.particles->departed())
    mine.push_back({moment.time, static_cast<double>(gone.id), gone.position[0], gone.position[1], gone.position[2],
                    gone.velocity[0], gone.velocity[1], gone.velocity[2], gone.mass,
                    static_cast<double>(gone.boundary)});
  // Counted in rows: numbers of numbers would pass the largest int from 2e8 particles on.
  const int count = static_cast<int>(mine.size());
  std::vector<int> counts(mpi_size()), first(mpi_size(), 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (int r = 1; r < mpi_size(); ++r) first[r] = first[r - 1] + counts[r - 1];
  std::vector<Row> rows(static_cast<std::size_t>(first.back()) + counts.back());
  if (rows.empty()) return;
  MPI_Datatype row;
  MPI_Type_contiguous(columns, MPI_DOUBLE, &row);
  MPI_Type_commit(&row);
  MPI_Allgatherv(mine.data(), count, row, rows.data(), counts.data(), first.data(), row, PETSC_COMM_WORLD);
  MPI_Type_free(&row);
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
  table_.row({rows.front().data(), columns * rows.size()});
}

}  // namespace silt
