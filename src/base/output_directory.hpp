#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/csv.hpp"
#include "base/options.hpp"

namespace silt {

/// The options `-output_...` that say where and how.
struct OutputOptions {
  std::string directory = "output/run";
  double interval = 0;
  bool overwrite = true;
  std::string precision = "double";
  void options(OptionGroup& option);
};

/// Where a run writes. The rule about what is there already:
///  - a directory that holds an earlier run of Silt (it has `run.yaml`): the files of that run are removed, any others
///    stay; with `-output_overwrite no` the run is refused instead, unless it goes on from a checkpoint there;
///  - any other directory is used beside what it holds, unless a file in it bears one of our names: refused.
class OutputDirectory {
 public:
  /// Checks that the directory can be made and written, leaving nothing behind. `checkpoint`: what the run goes on
  /// from, if it does. Throws UserError on every rank. Collective.
  explicit OutputDirectory(const OutputOptions& options, const std::string& checkpoint = "");

  /// Makes the directory, removes an earlier run and writes `run.yaml`, the record of this run. Throws UserError on
  /// every rank. Collective.
  void prepare(const std::string& record);
  /// As prepare(), for a run that goes on from a checkpoint of this time: where that lies in the directory, what its
  /// run wrote up to then is kept and continued. Collective.
  void resume(const std::string& record, double time);
  /// The time that the tables and series go on from; nothing for a fresh run.
  std::optional<double> resumed() const { return resumed_; }
  /// A table in the directory; one that is there is continued, without its rows after the time of resume(). Throws
  /// RunError on every rank. Collective.
  CsvWriter table(const std::string& file, const std::vector<std::string>& columns) const;

  /// The place of a file of ours.
  std::string path(const std::string& file) const { return options_.directory + "/" + file; }
  const OutputOptions& options() const { return options_; }
  bool single_precision() const { return options_.precision == "single"; }

 private:
  std::string obstacle() const;
  /// Whether the checkpoint lies in this directory, beside the record of its run.
  bool goes_on() const;
  OutputOptions options_;
  std::string checkpoint_;
  std::optional<double> resumed_;
};

}  // namespace silt
