#include "app/expectations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include "app/probes.hpp"
#include "app/profiles.hpp"
#include "base/error.hpp"
#include "base/hdf5_file.hpp"

namespace silt {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Whether all are: the largest of values one of which is not a number would be anything.
bool numbers(const std::vector<double>& values) {
  return std::none_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

double interpolate(const std::vector<double>& times, const std::vector<double>& values, double at) {
  const double slack = 1e-9 * std::max(1e-300, std::abs(at));
  if (times.empty() || at < times.front() - slack || at > times.back() + slack) return unknown;
  const auto above = std::lower_bound(times.begin(), times.end(), at);
  if (above == times.begin()) return values.front();
  if (above == times.end()) return values.back();
  const auto k = static_cast<size_t>(above - times.begin());
  const double share = (at - times[k - 1]) / (times[k] - times[k - 1]);
  return (1 - share) * values[k - 1] + share * values[k];
}

/// Mean over time by the trapezoidal rule.
double mean(const std::vector<double>& times, const std::vector<double>& values) {
  if (values.size() < 2) return values.empty() ? unknown : values[0];
  double sum = 0;
  for (size_t k = 1; k < values.size(); ++k) sum += 0.5 * (values[k] + values[k - 1]) * (times[k] - times[k - 1]);
  return sum / (times.back() - times.front());
}

double frequency(const std::vector<double>& times, const std::vector<double>& values) {
  const double middle = mean(times, values);
  std::vector<double> crossings;
  for (size_t k = 1; k < values.size(); ++k)
    if (values[k - 1] < middle && values[k] >= middle)
      crossings.push_back(times[k - 1] +
                          (middle - values[k - 1]) / (values[k] - values[k - 1]) * (times[k] - times[k - 1]));
  if (crossings.size() < 2) return unknown;
  return static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
}

/// Distance from the first point, m, of the middle of the steepest rise (sign 1) or fall (-1) of values `spacing` m
/// apart. Between the nodes of a mesh a field is linear: all intervals of that slope count as one.
double steepest(const std::vector<double>& values, double spacing, double sign) {
  double most = 0;
  size_t first = 0, last = 0;
  for (size_t k = 0; k + 1 < values.size(); ++k) {
    const double rise = sign * (values[k + 1] - values[k]);
    if (rise > most * (1 + 1e-3)) {
      most = rise;
      first = last = k;
    } else if (most > 0 && k == last + 1 && rise > most * (1 - 1e-3)) {
      last = k;
    }
  }
  return most > 0 ? spacing * (0.5 * static_cast<double>(first + last) + 0.5) : unknown;
}

/// Distance from the first point, m, of the first of the largest (sign 1) or least (-1) of values `spacing` m apart.
double place(const std::vector<double>& values, double spacing, double sign) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto extreme = sign > 0 ? *high : *low;
  return *low < *high ? spacing * static_cast<double>(std::find(values.begin(), values.end(), extreme) - values.begin())
                      : unknown;
}

Expectations::Verdict judged(const ExpectationOptions& options, double expected, double computed, double difference) {
  const double size = options.mode == "relative" ? std::abs(expected) : 1;
  double error = std::abs(difference) / size;
  if (options.mode == "at_least") error = std::max(0.0, expected - computed);
  if (options.mode == "at_most") error = std::max(0.0, computed - expected);
  if (std::isnan(computed)) error = unknown;
  return {expected, computed, error, error <= options.tolerance.value_or(0)};
}

std::string quoted(std::string text) {
  for (size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
  return fmt::format("\"{}\"", text);
}

}  // namespace

void ExpectationOptions::options(OptionGroup& option) {
  option(
      "quantity", quantity,
      "what is compared: a column of diagnostics.csv, <boundary>.<column>, <probe>.<column>, particle.<id>.<column>, "
      "particles.<statistic>, <line>.<column> or <profile>.<column>");
  option("less", less, "a quantity through time that is subtracted from the first before anything else");
  option("value", value, "", "figure expected, in the quantity's unit times the factor");
  option("values", values, "", "figures expected at the points of a line or profile");
  option("tolerance", tolerance, "", "largest error allowed", non_negative);
  option("mode", mode, {"relative", "absolute", "at_least", "at_most"},
         "how the error is taken; at_least and at_most: only what falls short or exceeds counts");
  option(
      "statistic", statistic,
      {"last", "mean", "minimum", "maximum", "amplitude", "frequency", "rate", "steepest_rise", "steepest_fall",
       "place_of_maximum", "place_of_minimum"},
      "what is taken over the window (without window: of the whole run), or along a line: mean, minimum, maximum, or "
      "the distance in m from its start where the quantity rises or falls most steeply (where a shock stands) or is "
      "largest or least");
  option("at", at, "s", "time at which the quantity is taken, interpolated between steps");
  option("window", window, "s", "from, to: stretch of time over which the statistic (default: mean) is taken");
  option("factor", factor, "-", "what the computed figure is multiplied with before it is compared");
  option("source", source, "where the expected figure comes from");
}

Expectations::Expectations(Options& options, const std::vector<std::string>& through_time,
                           const std::vector<std::string>& along_lines) {
  for (const auto& name : options.names("expect", Options::declared<ExpectationOptions>())) {
    const std::string prefix = "expect_" + name;
    if (case_.empty()) {
      const std::string origin = options.origin(prefix + "_quantity");
      case_ = origin.find(':') == std::string::npos
                  ? "case"
                  : std::filesystem::path(origin.substr(0, origin.rfind(':'))).stem().string();
    }
    Item item{name, {}, false, {}, {}};
    options.read(prefix, item.options);
    const auto& given = item.options;
    const auto has = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), given.quantity) != list.end();
    };
    item.along = has(along_lines);
    if (!item.along && !has(through_time)) {
      std::vector<std::string> all = through_time;
      all.insert(all.end(), along_lines.begin(), along_lines.end());
      const std::string hint = nearest(given.quantity, all);
      throw UserError(
          fmt::format("-{}_quantity: '{}' is not a quantity of this case{}", prefix, given.quantity,
                      hint.empty() ? "; see the columns of diagnostics.csv and the names of probes, lines and profiles"
                                   : fmt::format(", did you mean {}?", hint)));
    }
    const auto of_name = [&](const std::vector<std::string>& list) {
      return std::count(list.begin(), list.end(), given.quantity);
    };
    if (of_name(through_time) + of_name(along_lines) > 1)
      throw UserError(
          fmt::format("-{}_quantity: '{}' is the name of two things; give one of the boundaries, walls, probes, lines "
                      "and profiles another",
                      prefix, given.quantity));
    if (!given.less.empty() && (item.along || !has(through_time) ||
                                std::find(through_time.begin(), through_time.end(), given.less) == through_time.end()))
      throw UserError(fmt::format("-{}_less: '{}' and '{}' are not both quantities through time", prefix,
                                  given.quantity, given.less));
    if (given.value.has_value() == !given.values.empty())
      throw UserError(fmt::format("-{}: one of value and values must be given", prefix));
    if (!given.values.empty() && !item.along)
      throw UserError(fmt::format("-{}_values: '{}' is one number, use value", prefix, given.quantity));
    const bool where = given.statistic.starts_with("steepest") || given.statistic.starts_with("place");
    if (!item.along && where)
      throw UserError(fmt::format("-{}_statistic {}: '{}' is not a quantity along a line", prefix, given.statistic,
                                  given.quantity));
    if (!given.tolerance) throw UserError(fmt::format("-{}_tolerance must be given", prefix));
    if (!given.window.empty() && (given.window.size() != 2 || given.window[0] >= given.window[1]))
      throw UserError(fmt::format("-{}_window must be two increasing times in s", prefix));
    if (given.at && !given.window.empty())
      throw UserError(fmt::format("-{}: at and window exclude each other", prefix));
    if (item.along && (given.at || !given.window.empty()))
      throw UserError(fmt::format("-{}: '{}' is taken at the last output of the run; it has no at and no window",
                                  prefix, given.quantity));
    if (given.at && !given.statistic.empty())
      throw UserError(fmt::format("-{}: at is one moment and has no statistic; give a window", prefix));
    if (item.along && !given.statistic.empty() &&
        (!given.values.empty() ||
         !(where || given.statistic == "mean" || given.statistic == "minimum" || given.statistic == "maximum")))
      throw UserError(fmt::format(
          "-{}_statistic: '{}' lies along a line; of it there are the mean, minimum and maximum, the place of "
          "the steepest_rise, steepest_fall, maximum and minimum, and the values themselves without a statistic",
          prefix, given.quantity));
    if (given.mode == "relative" && given.value && *given.value == 0)
      throw UserError(fmt::format("-{}: a relative error from 0 has no meaning, use mode: absolute", prefix));
    items_.push_back(std::move(item));
  }
}

void Expectations::sample(double time, const Quantities& quantities) {
  for (auto& item : items_) {
    if (item.along) continue;
    const auto value = quantities.find(item.options.quantity);
    const auto less = item.options.less.empty() ? std::optional<double>(0) : quantities.find(item.options.less);
    if (value && less) {
      item.times.push_back(time);
      item.values.push_back(*value - *less);
    }
  }
}

void Expectations::save(CheckpointWriter& to, double time) const {
  for (const auto& item : items_) {
    std::vector<double> rows;
    for (size_t k = 0; k < item.times.size() && item.times[k] <= time && mpi_rank() == 0; ++k)
      rows.insert(rows.end(), {item.times[k], item.values[k]});
    to.add("expect_" + item.name, 2, rows);
    to.note("expect_" + item.name + "_quantity", item.options.quantity);
  }
}

void Expectations::load(const CheckpointReader& from) {
  for (auto& item : items_) {
    const std::string name = "expect_" + item.name;
    if (!from.has(name) || from.text(name + "_quantity") != item.options.quantity) continue;
    const auto rows = from.numbers(name);
    item.times.clear();
    item.values.clear();
    for (size_t k = 0; k + 1 < rows.size(); k += 2) {
      item.times.push_back(rows[k]);
      item.values.push_back(rows[k + 1]);
    }
  }
}

void Expectations::inherit(const Expectations& other) {
  for (size_t k = 0; k < items_.size(); ++k) {
    items_[k].times = other.items_[k].times;
    items_[k].values = other.items_[k].values;
  }
}

Expectations::Verdict Expectations::verdict(const ExpectationOptions& options, const std::vector<double>& times,
                                            const std::vector<double>& values) {
  double computed = unknown;
  if (options.at) {
    computed = interpolate(times, values, *options.at);
  } else if (!values.empty()) {
    std::vector<double> t, v;
    for (size_t k = 0; k < times.size(); ++k)
      if (options.window.empty() ||
          (times[k] >= options.window[0] * (1 - 1e-9) && times[k] <= options.window[1] * (1 + 1e-9))) {
        t.push_back(times[k]);
        v.push_back(values[k]);
      }
    const bool covered = options.window.empty() || times.back() >= options.window[1] * (1 - 1e-9);
    const std::string statistic = !options.statistic.empty() ? options.statistic
                                  : options.window.empty()   ? "last"
                                                             : "mean";
    if (covered && !v.empty() && (statistic == "last" || statistic == "rate" || numbers(v))) {
      const auto [low, high] = std::minmax_element(v.begin(), v.end());
      computed = statistic == "mean"        ? mean(t, v)
                 : statistic == "minimum"   ? *low
                 : statistic == "maximum"   ? *high
                 : statistic == "amplitude" ? 0.5 * (*high - *low)
                 : statistic == "frequency" ? frequency(t, v)
                 : statistic == "rate"      ? (v.size() < 2 ? unknown : (v.back() - v.front()) / (t.back() - t.front()))
                                            : v.back();
    }
  }
  computed *= options.factor;
  return judged(options, *options.value, computed, computed - *options.value);
}

Expectations::Verdict Expectations::verdict_along(const ExpectationOptions& options, const std::vector<double>& values,
                                                  double spacing) {
  if (values.empty() || !numbers(values)) return judged(options, options.value.value_or(0), unknown, unknown);
  const double count = static_cast<double>(values.size());
  const double average = options.factor * std::accumulate(values.begin(), values.end(), 0.0) / count;
  if (options.value) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double computed = options.statistic == "minimum"            ? options.factor * *low
                            : options.statistic == "maximum"          ? options.factor * *high
                            : options.statistic == "steepest_rise"    ? options.factor * steepest(values, spacing, 1)
                            : options.statistic == "steepest_fall"    ? options.factor * steepest(values, spacing, -1)
                            : options.statistic == "place_of_maximum" ? options.factor * place(values, spacing, 1)
                            : options.statistic == "place_of_minimum" ? options.factor * place(values, spacing, -1)
                                                                      : average;
    return judged(options, *options.value, computed, computed - *options.value);
  }
  const double expected = std::accumulate(options.values.begin(), options.values.end(), 0.0) / options.values.size();
  if (options.values.size() != values.size()) return judged(options, expected, unknown, unknown);
  double difference = 0;
  for (size_t k = 0; k < values.size(); ++k)
    difference += std::abs(options.factor * values[k] - options.values[k]) / count;
  return judged(options, expected, average, difference);
}

bool Expectations::judge(const OutputDirectory& directory, const Probes& probes, const Profiles& profiles) const {
  if (items_.empty()) return true;
  bool all = true;
  std::string table = "case,name,quantity,expected,computed,error,tolerance,mode,result,source\n";
  for (const auto& item : items_) {
    std::vector<double> along;
    double spacing = 0;
    if (item.along) {
      along = probes.line(item.options.quantity);
      spacing = probes.spacing(item.options.quantity);
      if (along.empty()) {
        along = profiles.values(item.options.quantity);
        spacing = profiles.spacing(item.options.quantity);
      }
    }
    const Verdict v =
        item.along ? verdict_along(item.options, along, spacing) : verdict(item.options, item.times, item.values);
    all = all && v.pass;
    const char* result = v.pass ? "PASS" : "FAIL";
    if (mpi_rank() == 0)
      fmt::print("{} {} {:.6g} {:.6g} {:.3g} {:.3g} {}\n", case_, item.name, v.expected, v.computed, v.error,
                 *item.options.tolerance, result);
    table += fmt::format("{},{},{},{:.9g},{:.9g},{:.4g},{:.4g},{},{},{}\n", case_, item.name, item.options.quantity,
                         v.expected, v.computed, v.error, *item.options.tolerance, item.options.mode, result,
                         quoted(item.options.source));
  }
  std::fflush(stdout);
  write_text(directory.path("expectations.csv"), table);
  return all;
}

}  // namespace silt
