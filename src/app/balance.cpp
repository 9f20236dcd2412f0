#include "app/balance.hpp"

#include <algorithm>
#include <cmath>

#include "base/petsc.hpp"

namespace silt {

void BalanceOptions::options(OptionGroup& option) {
  option("interval", interval, "s",
         "simulated time between two looks at how evenly the ranks are loaded; where they are not, cells and particles "
         "are "
         "shared out anew; 0: never",
         non_negative);
  option("threshold", threshold, "-", "work of the busiest rank over the mean, above which it is shared out anew",
         at_least(1));
  option("start", start, "-",
         "the same once before the first step, for runs of at least 1000 particles a rank, at costs estimated from the "
         "numbers of substeps and unknowns; 0: never",
         non_negative);
}

Costs Balance::measure(const Mesh& mesh, const Particles* particles, double particle_seconds, double cell_seconds) {
  const double most_particles = std::max(mpi_max(particles ? particles->owned() : 0), 1.0);
  const double most_cells = std::max(mpi_max(mesh.cells), 1.0);
  Costs costs{mpi_max(particle_seconds) / most_particles, mpi_max(cell_seconds) / most_cells};
  // Cells are never free: without a fluid they still carry search and output.
  costs.cell = std::max({costs.cell, 0.01 * costs.particle, 1e-12});
  costs.particle = std::max(costs.particle, 1e-6 * costs.cell);
  return costs;
}

Costs Balance::estimate(double substeps, double unknowns, bool at_once) {
  // In substeps of a particle, as bench/coupled and bench/fluid --duct measure them.
  constexpr double in_turn = 15, together = 250;
  Costs costs{std::max(substeps, 1.0), unknowns * (at_once ? together : in_turn)};
  costs.cell = std::max(costs.cell, 0.01 * costs.particle);
  return costs;
}

bool Balance::worthwhile_at_start(double imbalance, const Particles* particles) const {
  constexpr long long least = 1000;  // particles a rank; fewer are sooner done than shared out
  return options_.start > 0 && mpi_size() > 1 && particles && particles->total() >= least * mpi_size() &&
         imbalance > options_.start;
}

double Balance::imbalance(const Mesh& mesh, const Particles* particles, const Costs& costs) {
  const double work = costs.cell * mesh.cells + costs.particle * (particles ? particles->owned() : 0);
  return mpi_max(work) / std::max(mpi_sum(work) / mpi_size(), 1e-300);
}

bool Balance::due(double time) {
  if (options_.interval <= 0 || mpi_size() == 1) return false;
  const auto passed = static_cast<long long>(std::floor(time / options_.interval * (1 + 1e-12) + 1e-9));
  const bool is_due = passed > looked_;
  looked_ = passed;
  return is_due;
}

void save_partition(const Mesh& mesh, const Costs& costs, CheckpointWriter& to) {
  std::vector<double> centres;
  for (int c = 0; c < mesh.cells; ++c) {
    const Vec3 x = mesh.centre(c);
    centres.insert(centres.end(), {x[0], x[1], x[2]});
  }
  to.add("mesh_cells", 3, std::move(centres));
  to.add("cells_each_rank", 1, std::vector<std::int64_t>{mesh.cells});
  to.note("cost_particle", costs.particle);
  to.note("cost_cell", costs.cell);
}

Partition partition_of(const CheckpointReader& from, bool anew) {
  Partition partition;
  if (mpi_size() == 1) return partition;
  const auto each = from.wholes("cells_each_rank");
  if (static_cast<int>(each.size()) == mpi_size() && !anew) {
    const auto centres = from.numbers("mesh_cells");
    for (std::size_t k = 0; k + 2 < centres.size(); k += 3) partition.cells.push_back(vec3(&centres[k]));
    for (std::size_t r = 0; r < each.size(); ++r)
      partition.ranks.insert(partition.ranks.end(), static_cast<std::size_t>(each[r]), static_cast<int>(r));
    return partition;
  }
  partition.particle_cost = from.number("cost_particle");
  partition.cell_cost = from.number("cost_cell");
  if (!from.has("particle_motion")) return partition;
  const int width = from.components("particle_motion");
  const auto motion = from.numbers("particle_motion");
  for (std::size_t k = 0; k + 2 < motion.size(); k += static_cast<std::size_t>(width))
    partition.points.push_back(vec3(&motion[k]));
  return partition;
}

}  // namespace silt
