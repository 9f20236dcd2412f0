#pragma once
#include <memory>
#include <string>

#include "app/moment.hpp"
#include "base/mesh.hpp"
#include "base/series.hpp"

namespace silt {

/// The series that ParaView opens, `fluid.xdmf` and `particles.xdmf`, written at the start, every
/// `-output_interval` and at the end.
class Output {
 public:
  /// Reads `-output_...` and checks the directory; writes nothing. `checkpoint`: what the run goes on from, if it does.
  /// Collective.
  Output(const Mesh& mesh, Options& options, bool with_fluid, bool with_particles, const std::string& checkpoint = "");
  /// Makes the directory, with `record` (the options of the run, YAML) in it. Collective.
  void start(const std::string& record);
  /// As start(), for a run that goes on from a checkpoint of this time. Collective.
  void resume(const std::string& record, double time);
  double last() const { return last_; }
  const OutputDirectory& directory() const { return *directory_; }

  /// First time of output after `time`, infinity when there is none but the end.
  double next(double time) const;
  /// True when an output belongs to this time: the first one, and one of the instants k interval.
  bool due(double time) const;
  /// Writes both series unless this moment's output is written already. Collective.
  void write(const Moment& moment);

 private:
  void open_series(const std::string& record);
  const Mesh& mesh_;
  bool with_fluid_, with_particles_;
  std::unique_ptr<OutputDirectory> directory_;
  std::unique_ptr<FluidSeries> fluid_;
  std::unique_ptr<ParticleSeries> particles_;
  double last_ = -1;
};

/// The options given, and as comments the defaults of the others that this run read: YAML that a run can be repeated
/// from. (A default that is given may mean something else: a pressure on a wall is refused.)
std::string record_of(const Options& options);

}  // namespace silt
