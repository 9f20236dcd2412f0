#pragma once
#include <string>
#include <vector>

#include "app/moment.hpp"
#include "base/csv.hpp"
#include "base/output_directory.hpp"

namespace silt {

/// The energy of the particles and the work done on them since the start, `energy.csv`, a row a step (J), when
/// `-particles_energy` asks for it: kinetic, rotational, stored (in normal springs), the work of every mechanism, and
/// the residual, what nothing accounts for.
class EnergyTable {
 public:
  /// Of a run without such an account when null.
  explicit EnergyTable(const Particles* particles);
  /// Names of the quantities ("energy.friction"), without the time.
  std::vector<std::string> quantities() const;
  /// Opens the file. Collective.
  void start(const OutputDirectory& directory);
  /// Collective.
  void sample(const Moment& moment, Quantities& quantities);

 private:
  std::vector<std::string> columns_;
  CsvWriter table_;
};

}  // namespace silt
