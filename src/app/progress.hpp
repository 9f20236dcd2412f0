#pragma once
#include <chrono>
#include <string>

#include "app/moment.hpp"

namespace silt {

/// The options `-progress_...`.
struct ProgressOptions {
  double interval = 5;
  bool quiet = false;
  void options(OptionGroup& option);
};

/// What the terminal shows: a header of what runs, then where the run is. On a terminal one line is rewritten in place;
/// into a file or pipe a line goes every `-progress_interval` seconds of wall time. Rank 0 speaks.
class Progress {
 public:
  explicit Progress(Options& options);
  /// Lines of text before the run.
  void header(const std::string& text);
  /// A line of text at any time; a line being rewritten is ended first.
  void line(const std::string& text);
  /// Starts the clock.
  void start(double time, double end);
  /// Called after every step: time, step, Courant number, iterations, contacts, ledger residual, speed, time left.
  void step(const Moment& moment);
  /// The last state, whatever the interval.
  void finish(const Moment& moment);

 private:
  using Clock = std::chrono::steady_clock;
  void show(const Moment& moment);
  double since_start() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  ProgressOptions options_;
  bool speaks_, terminal_, open_line_ = false;
  double from_ = 0, end_ = 0, shown_ = 0;
  long long shown_step_ = -1;
  Clock::time_point start_;
};

/// "2:05:09", "3:07" or "12 s".
std::string clock_text(double seconds);

}  // namespace silt
