#pragma once
#include <string>
#include <vector>

#include "app/moment.hpp"
#include "base/csv.hpp"
#include "base/output_directory.hpp"

namespace silt {

/// What the particles did to the walls, `walls.csv`, a row a step: of every wall the mean force (N) and torque (N m; of
/// the mesh's boundaries about the origin, of rigid walls about their centre of rotation) over the step, of moving
/// walls also displacement (m) and angle (rad), of those that conduct heat what the particles take (W).
class WallTable {
 public:
  /// Of a run without particles when null.
  explicit WallTable(const Particles* particles);
  /// Names of the quantities, without the time.
  std::vector<std::string> columns() const { return {columns_.begin() + 1, columns_.end()}; }
  /// Opens the file. Collective.
  void start(const OutputDirectory& directory);
  /// Collective.
  void sample(const Moment& moment, Quantities& quantities);

 private:
  std::vector<std::string> columns_{"time"};
  std::vector<bool> conducts_;  ///< by wall
  CsvWriter table_;
};

}  // namespace silt
