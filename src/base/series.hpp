#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/hdf5_file.hpp"
#include "base/mesh.hpp"
#include "base/output_directory.hpp"

namespace silt {

/// The index of a time series: `<name>.xdmf`, one file that ParaView opens; the numbers stand in `<name>/<count>.h5`,
/// one file an output. It is rewritten whole after each output, so that it names complete files only.
class SeriesIndex {
 public:
  /// With `resumed`, an index that is there goes on after its outputs up to that time. Collective.
  SeriesIndex(std::string path, std::string name, std::optional<double> resumed = {});
  /// "fluid/000012.h5" of the output that comes next.
  std::string next_file() const;
  int count() const { return static_cast<int>(grids_.size()); }
  /// Adds an output: the XDMF text of topology, geometry and attributes. Collective.
  void add(double time, const std::string& body);

 private:
  std::string path_, name_;
  std::vector<std::string> grids_;
};

/// A field at the mesh nodes: [nodes][components], consistent on shared nodes. Vectors have 3 components, symmetric
/// tensors 6, tensors 9.
struct NodeField {
  std::string name;
  int components;
  std::span<const double> values;
};

/// The fields on the mesh through time: `fluid.xdmf`, mesh in `fluid/mesh.h5`. Shared nodes are written once; on a
/// periodic mesh every cell has nodes of its own, since a node there stands for several places.
class FluidSeries {
 public:
  /// Writes the mesh. Collective.
  FluidSeries(const OutputDirectory& directory, const Mesh& mesh, const std::string& record = "");
  /// Collective; throws RunError on every rank, leaving the earlier outputs in order.
  void write(double time, const std::vector<NodeField>& fields);

 private:
  const Mesh& mesh_;
  const OutputDirectory& directory_;
  SeriesIndex index_;
  bool cellwise_;
  std::string mesh_file_ = "fluid/mesh.h5";  ///< a run that went on has its mesh, perhaps in another order, in another
  long long points_ = 0;
};

/// The particles through time: `particles.xdmf`, any number of them, also none. The arrays are this rank's particles;
/// one of them is `position`, with 3 components.
class ParticleSeries {
 public:
  /// Makes the folder of the files. Collective.
  explicit ParticleSeries(const OutputDirectory& directory, std::string record = "");
  /// Collective; throws RunError on every rank, leaving the earlier outputs in order.
  void write(double time, std::vector<Dataset> arrays);

 private:
  const OutputDirectory& directory_;
  SeriesIndex index_;
  std::string record_;
};

}  // namespace silt
