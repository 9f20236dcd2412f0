// How the cells are shared out among the ranks: by their cost, or as they were before.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.hpp"
#include "base/expression.hpp"
#include "base/mesh.hpp"

namespace silt {
namespace {

/// Mean of a cell's corners.
Vec3 centre_of(DM plex, PetscInt cell) {
  PetscBool discontinuous;
  PetscInt count, dimension;
  const PetscScalar* array;
  PetscScalar* coordinates;
  SILT_PETSC(DMGetCoordinateDim(plex, &dimension));
  SILT_PETSC(DMPlexGetCellCoordinates(plex, cell, &discontinuous, &count, &array, &coordinates));
  Vec3 sum = Vec3::Zero();
  for (PetscInt k = 0; k < count; ++k) sum[k % dimension] += PetscRealPart(coordinates[k]);
  const double corners = static_cast<double>(count) / static_cast<double>(dimension);
  SILT_PETSC(DMPlexRestoreCellCoordinates(plex, cell, &discontinuous, &count, &array, &coordinates));
  return sum / corners;
}

/// Finds the nearest of many points.
class Nearest {
 public:
  explicit Nearest(const std::vector<Vec3>& points) : points_(points) {
    Vec3 high = Vec3::Constant(-infinity);
    low_ = Vec3::Constant(infinity);
    for (const Vec3& x : points) low_ = low_.cwiseMin(x), high = high.cwiseMax(x);
    const Vec3 size = (high - low_).cwiseMax(1e-12 * (high - low_).maxCoeff() + 1e-300);
    const int flat = static_cast<int>((size.array() < 1e-6 * size.maxCoeff()).count());
    double volume = 1;
    for (int d = 0; d < 3; ++d) volume *= size[d] < 1e-6 * size.maxCoeff() ? 1 : size[d];
    width_ = std::pow(volume / static_cast<double>(points.size()), 1.0 / (3 - std::min(flat, 2)));
    for (int d = 0; d < 3; ++d) count_[d] = std::clamp(static_cast<int>(size[d] / width_) + 1, 1, 1024);
    start_.assign(static_cast<size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    for (const Vec3& x : points) ++start_[bin(cell(x)) + 1];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    order_.resize(points.size());
    auto at = start_;
    for (size_t k = 0; k < points.size(); ++k) order_[at[bin(cell(points[k]))]++] = static_cast<int>(k);
  }

  int operator()(const Vec3& x) const {
    const auto c = cell(x);
    int best = -1;
    double least = infinity;
    // Rings of bins until nothing nearer can lie in the next one.
    for (int ring = 0; ring < 2048; ++ring) {
      if (best >= 0 && least < (ring - 1) * (ring - 1) * width_ * width_) break;
      for (int k = c[2] - ring; k <= c[2] + ring; ++k)
        for (int j = c[1] - ring; j <= c[1] + ring; ++j) {
          const bool shell = std::max(std::abs(k - c[2]), std::abs(j - c[1])) == ring;
          for (int i = c[0] - ring; i <= c[0] + ring; i += shell || ring == 0 ? 1 : 2 * ring) {
            if (i < 0 || j < 0 || k < 0 || i >= count_[0] || j >= count_[1] || k >= count_[2]) continue;
            const size_t b = bin({i, j, k});
            for (int s = start_[b]; s < start_[b + 1]; ++s)
              if (const double square = (points_[order_[s]] - x).squaredNorm(); square < least)
                least = square, best = order_[s];
          }
        }
    }
    return best;
  }

 private:
  std::array<int, 3> cell(const Vec3& x) const {
    std::array<int, 3> c;
    for (int d = 0; d < 3; ++d)
      c[d] = static_cast<int>(std::clamp((x[d] - low_[d]) / width_, 0.0, static_cast<double>(count_[d] - 1)));
    return c;
  }
  size_t bin(const std::array<int, 3>& c) const {
    return (static_cast<size_t>(c[2]) * count_[1] + c[1]) * count_[0] + c[0];
  }
  const std::vector<Vec3>& points_;
  Vec3 low_;
  double width_;
  std::array<int, 3> count_;
  std::vector<int> start_, order_;
};

std::vector<Vec3> centres_of(DM plex) {
  PetscInt first, last;
  SILT_PETSC(DMPlexGetHeightStratum(plex, 0, &first, &last));
  std::vector<Vec3> centres;
  for (PetscInt c = first; c < last; ++c) centres.push_back(centre_of(plex, c));
  return centres;
}

}  // namespace

/// PETSc takes the unknowns of a cell, as its local section counts them, for the cell's weight in the partition.
void Mesh::weigh(const std::string& weight, const Partition& partition, double scale) {
  const Expression cost("mesh_weight", weight);
  if (cost.constant() && partition.points.empty()) return;
  const std::vector<Vec3> centres = centres_of(plex_);
  std::vector<double> costs;
  std::string bad;
  for (const Vec3& centre : centres) {
    const double value = partition.points.empty() ? cost(centre, 0) : partition.cell_cost;
    if (!(value > 0) || value > 1e6) bad = fmt::format("{:g}", value);
    costs.push_back(value);
  }
  if (mpi_any(!bad.empty()))
    throw UserError(fmt::format("option -mesh_weight: '{}' must lie between 0 and 1e6 everywhere", weight));
  double unit = 1;
  if (!partition.points.empty()) {
    if (!centres.empty()) {
      // Where particles are known, they say what the work is.
      const Nearest nearest(centres);
      for (const Vec3& x : partition.points) costs[nearest(x / scale)] += partition.particle_cost;
    }
    const double all = mpi_sum(std::accumulate(costs.begin(), costs.end(), 0.0));
    unit = std::min(1e8 / all, 1000 / partition.cell_cost);
  }
  PetscInt first = 0, last = 0;
  SILT_PETSC(DMPlexGetHeightStratum(plex_, 0, &first, &last));
  PetscSection section;
  SILT_PETSC(PetscSectionCreate(PETSC_COMM_WORLD, &section));
  SILT_PETSC(PetscSectionSetChart(section, first, last));
  for (PetscInt c = first; c < last; ++c)
    SILT_PETSC(PetscSectionSetDof(section, c, static_cast<PetscInt>(std::ceil(unit * costs[c - first]))));
  SILT_PETSC(PetscSectionSetUp(section));
  SILT_PETSC(DMSetLocalSection(plex_, section));
  SILT_PETSC(PetscSectionDestroy(&section));
}

/// Gives every cell the rank that the nearest of the given centres has.
void Mesh::assign(const Partition& partition, double scale) {
  const std::vector<Vec3> centres = centres_of(plex_);
  const Nearest nearest(partition.cells);
  std::vector<std::vector<PetscInt>> of_rank(mpi_size());
  for (size_t c = 0; c < centres.size(); ++c)
    of_rank[partition.ranks[nearest(centres[c] * scale)]].push_back(static_cast<PetscInt>(c));
  std::vector<PetscInt> sizes, points;
  for (const auto& mine : of_rank) {
    sizes.push_back(static_cast<PetscInt>(mine.size()));
    points.insert(points.end(), mine.begin(), mine.end());
  }
  PetscPartitioner partitioner;
  SILT_PETSC(DMPlexGetPartitioner(plex_, &partitioner));
  SILT_PETSC(PetscPartitionerSetType(partitioner, PETSCPARTITIONERSHELL));
  SILT_PETSC(PetscPartitionerShellSetPartition(partitioner, mpi_size(), sizes.data(), points.data()));
}

}  // namespace silt
