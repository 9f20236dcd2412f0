#pragma once
#include <memory>
#include <string>
#include <vector>

#include "app/moment.hpp"
#include "base/csv.hpp"
#include "base/locator.hpp"
#include "base/output_directory.hpp"

namespace silt {

/// `-probe_<name>_...`: a point where the fluid is recorded at every step.
struct ProbeOptions {
  Vec3 point = Vec3::Zero();
  void options(OptionGroup& option);
};

/// `-line_<name>_...`: points along a line where the fluid is recorded at every output.
struct LineOptions {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();
  int points = 50;
  void options(OptionGroup& option);
};

/// The fluid at fixed points: velocity, pressure, void fraction and what else the fluid has, by the mesh's own shape
/// functions.
class FluidPoints {
 public:
  static std::vector<std::string> columns(const Fluid& fluid);
  /// Throws UserError naming `owner` when a point lies outside the mesh. Collective.
  FluidPoints(const Mesh& mesh, const Locator& locator, std::vector<Vec3> points, const std::string& owner);
  /// columns(fluid).size() values a point, on every rank. Collective.
  std::vector<double> sample(const Fluid& fluid) const;
  const std::vector<Vec3>& points() const { return points_; }

 private:
  const Mesh& mesh_;
  std::vector<Vec3> points_;
  std::vector<Place> places_;
};

/// All probes and lines of a run: `probe_<name>.csv`, a row a step; `line_<name>.csv`, a row a point and output.
class Probes {
 public:
  /// `fluid` is null in a run without one.
  Probes(const Mesh& mesh, Options& options, const Fluid* fluid);
  /// Opens the files. Collective.
  void start(const OutputDirectory& directory);
  /// Writes a row for every probe and adds `<probe>.<column>` to `quantities`. Collective.
  void sample(const Moment& moment, Quantities& quantities);
  /// Appends every line's points. Collective.
  void write_lines(const Moment& moment);
  /// `<probe>.<column>` of every probe.
  std::vector<std::string> columns() const;
  /// `<line>.<column>` of every line.
  std::vector<std::string> line_columns() const;
  /// The values along a line as last written; empty when there is no such `<line>.<column>`.
  std::vector<double> line(const std::string& column) const;
  /// m between the points of that line; 0 when there is none.
  double spacing(const std::string& column) const;

 private:
  struct Item {
    std::string name;
    FluidPoints points;
    CsvWriter table;
    std::vector<double> last;
  };
  std::vector<std::string> columns_;
  std::unique_ptr<Locator> locator_;
  std::vector<Item> probes_, lines_;
};

}  // namespace silt
