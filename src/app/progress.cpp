#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace silt {

void ProgressOptions::options(OptionGroup& option) {
  option("interval", interval, "s", "wall time between two progress lines when the output is not a terminal",
         non_negative);
  option("quiet", quiet, "no header and no progress lines");
}

std::string clock_text(double seconds) {
  if (!(seconds < 360000)) return "days";
  const long long s = std::llround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02d}", s / 60, s % 60);
  return fmt::format("{}:{:02d}:{:02d}", s / 3600, s / 60 % 60, s % 60);
}

Progress::Progress(Options& options) : start_(Clock::now()) {
  options.read("progress", options_);
  speaks_ = mpi_rank() == 0 && !options_.quiet;
  // mpiexec gives its ranks a terminal of their own, wherever their output goes in the end.
  const bool launched = std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMI_SIZE");
  terminal_ = !launched && isatty(STDOUT_FILENO) != 0;
}

void Progress::header(const std::string& text) { line(text); }

void Progress::line(const std::string& text) {
  if (!speaks_) return;
  if (open_line_) fmt::print("\n");
  open_line_ = false;
  fmt::print("{}{}", text, text.empty() || text.back() != '\n' ? "\n" : "");
  std::fflush(stdout);
}

void Progress::start(double time, double end) {
  start_ = Clock::now();
  from_ = time;
  end_ = end;
  shown_ = 0;
}

void Progress::step(const Moment& moment) {
  if (!speaks_ || since_start() - shown_ < (terminal_ ? 0.2 : options_.interval)) return;
  show(moment);
}

void Progress::finish(const Moment& moment) {
  if (!speaks_) return;
  if (moment.step != shown_step_) show(moment);
  if (open_line_) fmt::print("\n");
  open_line_ = false;
  std::fflush(stdout);
}

void Progress::show(const Moment& moment) {
  shown_ = since_start();
  shown_step_ = moment.step;
  std::string text = fmt::format("t {:.6g}/{:g} s  step {}  dt {:.3g}", moment.time, end_, moment.step, moment.dt);
  if (moment.fluid) {
    const FluidStep& s = moment.fluid_step;
    text += fmt::format("  CFL {:.2f}", s.courant);
    if (s.newton_iterations) text += fmt::format("  Newton {}", s.newton_iterations);
    text += fmt::format("  it {}+{}", s.velocity_iterations, s.pressure_iterations);
    if (s.first_order) text += "  first order";
  }
  if (moment.particles) text += fmt::format("  contacts {}", moment.particle_step.contacts);
  if (moment.ledger_residual > 0) text += fmt::format("  ledger {:.0e}", moment.ledger_residual);
  const double done = moment.time - from_;
  if (done > 0 && shown_ > 0)
    text += fmt::format("  {:.3g} s/s  left {}", shown_ / done,
                        clock_text(shown_ / done * std::max(0.0, end_ - moment.time)));
  if (terminal_)
    fmt::print("\r\033[K{}", text);
  else
    fmt::print("{}\n", text);
  open_line_ = terminal_;
  std::fflush(stdout);
}

}  // namespace silt
