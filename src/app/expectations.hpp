#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/moment.hpp"
#include "base/checkpoint_file.hpp"
#include "base/output_directory.hpp"

namespace silt {

class Probes;
class Profiles;

/// `-expect_<name>_...`: a figure that the run must give.
struct ExpectationOptions {
  std::string quantity, less;
  std::optional<double> value;
  std::vector<double> values;
  std::optional<double> tolerance;
  std::string mode = "relative";
  std::string statistic;
  std::optional<double> at;
  std::vector<double> window;
  double factor = 1;
  std::string source;
  void options(OptionGroup& option);
};

/// The figures a case carries. A quantity is a column of diagnostics.csv, `<boundary>.<column>` of boundaries.csv,
/// `<probe>.<column>`, `particle.<id>.<column>`, `particles.<statistic>`, or, along a line or profile,
/// `<line>.<column>` and `<profile>.<column>`.
///
/// Through time: the value `at` a time (interpolated), or a `statistic` over a `window`: mean, minimum, maximum,
/// amplitude (half of maximum less minimum), frequency (upward crossings of the mean, Hz), rate (change per second
/// between the ends of the window); without either the last one.
/// Along a line: the mean absolute difference from `values`, or against `value` the mean, the minimum, the maximum, or
/// the distance in m from the first point where the quantity rises or falls most steeply (steepest_rise,
/// steepest_fall) or is largest or least (place_of_maximum, place_of_minimum; the first of equals).
class Expectations {
 public:
  /// Reads the options; `through_time` and `along_lines` are the quantities there are. Throws UserError with the
  /// nearest name for an unknown one.
  Expectations(Options& options, const std::vector<std::string>& through_time,
               const std::vector<std::string>& along_lines);
  bool empty() const { return items_.empty(); }
  /// Takes note of what is expected. Local.
  void sample(double time, const Quantities& quantities);
  /// Takes over what another one of the same options has noted. Local.
  void inherit(const Expectations& other);
  /// Puts what was noted until a time into a checkpoint, and goes on from what one holds (of the same quantity).
  /// Collective.
  void save(CheckpointWriter& to, double time) const;
  void load(const CheckpointReader& from);
  /// Prints a line for each figure, `case name expected computed error tolerance PASS|FAIL`, and writes
  /// `expectations.csv`; true when all are met. Collective.
  bool judge(const OutputDirectory& directory, const Probes& probes, const Profiles& profiles) const;

  /// Computed figure and error of one expectation, from a history or from values along a line, `spacing` m apart.
  struct Verdict {
    double expected, computed, error;
    bool pass;
  };
  static Verdict verdict(const ExpectationOptions& options, const std::vector<double>& times,
                         const std::vector<double>& values);
  static Verdict verdict_along(const ExpectationOptions& options, const std::vector<double>& values,
                               double spacing = 1);

 private:
  struct Item {
    std::string name;
    ExpectationOptions options;
    bool along;
    std::vector<double> times, values;
  };
  std::string case_;
  std::vector<Item> items_;
};

}  // namespace silt
