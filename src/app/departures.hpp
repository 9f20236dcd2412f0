#pragma once
#include "app/moment.hpp"
#include "base/csv.hpp"
#include "base/output_directory.hpp"

namespace silt {

/// The particles that left the domain, each with its last state: `removed.csv`, a row a particle in the order of their
/// going: time, id, position (m), velocity (m/s), mass (kg), boundary (its place in `boundaries` of run.yaml's mesh,
/// counted from 0 in the order of boundaries.csv).
class Departures {
 public:
  /// Opens the file. Collective.
  void start(const OutputDirectory& directory);
  /// Writes those of the last step, of all ranks, by id. Collective.
  void record(const Moment& moment);

 private:
  CsvWriter table_;
};

}  // namespace silt
