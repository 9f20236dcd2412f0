#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "base/options.hpp"
#include "base/text.hpp"

namespace silt {
namespace {

std::string number_text(double value) { return fmt::format("{:g}", value); }

/// Splits at commas outside parentheses, so that expressions may contain max(a, b); trims blanks.
std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  std::string part;
  int depth = 0;
  for (char c : text) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (c == ',' && depth == 0) {
      parts.push_back(part);
      part.clear();
    } else {
      part += c;
    }
  }
  parts.push_back(part);
  for (auto& p : parts) {
    const auto first = p.find_first_not_of(" \t[]"), last = p.find_last_not_of(" \t[]");
    p = first == std::string::npos ? "" : p.substr(first, last - first + 1);
  }
  if (parts.size() == 1 && parts[0].empty()) parts.clear();
  return parts;
}

}  // namespace

std::optional<std::string> OptionGroup::take(const char* name, const char* type, const char* unit,
                                             const std::string& fallback, const std::string& range, const char* help) {
  OptionEntry entry{full(name), type, unit, fallback, range, help, fallback, false};
  auto text = options_.find(entry.name);
  if (text) {
    entry.given = true;
    entry.value = *text;
  }
  options_.declare(std::move(entry));
  return text;
}

void OptionGroup::refuse(const std::string& name, const std::string& text, const std::string& allowed) const {
  throw UserError(
      fmt::format("option -{} ({}): '{}' is not allowed; it must be {}", name, options_.origin(name), text, allowed));
}

double OptionGroup::number(const std::string& name, const std::string& text, const char* unit,
                           const Range& range) const {
  const std::string limits = range.text(), unit_text = std::string(unit) == "-" ? "" : fmt::format(" in {}", unit);
  const std::string allowed = fmt::format("a number{}{}{}", unit_text, limits.empty() ? "" : " ", limits);
  double value = 0;
  try {
    size_t used = 0;
    value = std::stod(text, &used);
    if (text.find_first_not_of(" \t", used) != std::string::npos) refuse(name, text, allowed);
  } catch (const std::logic_error&) {
    refuse(name, text, allowed);
  }
  if (!std::isfinite(value) || !range.contains(value)) refuse(name, text, allowed);
  return value;
}

int OptionGroup::whole(const std::string& name, const std::string& text, const char* unit, const Range& range) const {
  const double value = number(name, text, unit, range);
  if (value != std::floor(value) || std::abs(value) > 2e9) refuse(name, text, "a whole number " + range.text());
  return static_cast<int>(value);
}

void OptionGroup::operator()(const char* name, double& value, const char* unit, const char* help, Range range) {
  if (auto text = take(name, "number", unit, number_text(value), range.text(), help))
    value = number(full(name), *text, unit, range);
}

void OptionGroup::operator()(const char* name, int& value, const char* unit, const char* help, Range range) {
  if (auto text = take(name, "integer", unit, std::to_string(value), range.text(), help))
    value = whole(full(name), *text, unit, range);
}

void OptionGroup::operator()(const char* name, bool& value, const char* help) {
  auto text = take(name, "yes/no", "", value ? "yes" : "no", "yes, no", help);
  if (!text) return;
  const std::string word = lower_case(*text);
  if (word == "yes" || word == "true" || word == "1" || word == "on" || word.empty()) {
    value = true;
  } else if (word == "no" || word == "false" || word == "0" || word == "off") {
    value = false;
  } else {
    refuse(full(name), *text, "yes or no");
  }
}

void OptionGroup::operator()(const char* name, std::string& value, const char* help) {
  if (auto text = take(name, "text", "", value, "", help)) value = *text;
}

void OptionGroup::operator()(const char* name, InputFile& value, const char* help) {
  auto text = take(name, "text", "", value, "", help);
  if (!text) return;
  value = *text;
  const std::string origin = options_.origin(full(name));  // file.yaml:12
  const std::filesystem::path given = *text, beside = std::filesystem::path(origin).parent_path() / given;
  if (!std::filesystem::exists(given) && std::filesystem::exists(beside)) value = beside.string();
  // The record of the run names the file for whoever repeats it from somewhere else.
  if (std::filesystem::exists(value.c_str()))
    options_.declare(
        {full(name), "text", "", "", "", help, std::filesystem::absolute(value.c_str()).lexically_normal(), true});
}

void OptionGroup::operator()(const char* name, std::string& value, const std::vector<std::string>& allowed,
                             const char* help) {
  auto text = take(name, "word", "", value, fmt::format("{}", fmt::join(allowed, ", ")), help);
  if (!text) return;
  if (std::find(allowed.begin(), allowed.end(), *text) == allowed.end()) {
    const std::string hint = nearest(*text, allowed);
    refuse(full(name), *text,
           fmt::format("one of {}{}", fmt::join(allowed, ", "),
                       hint.empty() ? "" : fmt::format(" (did you mean {}?)", hint)));
  }
  value = *text;
}

void OptionGroup::operator()(const char* name, Vec3& value, const char* unit, const char* help) {
  const std::string fallback = fmt::format("{:g},{:g},{:g}", value[0], value[1], value[2]);
  auto text = take(name, "vector", unit, fallback, "three numbers", help);
  if (!text) return;
  const auto parts = split_list(*text);
  if (parts.size() != 3) refuse(full(name), *text, fmt::format("three numbers in {}", unit));
  for (int d = 0; d < 3; ++d) value[d] = number(full(name), parts[d], unit, any);
}

void OptionGroup::operator()(const char* name, std::optional<double>& value, const char* unit, const char* help,
                             Range range) {
  const std::string fallback = value ? number_text(*value) : "";
  if (auto text = take(name, "number", unit, fallback, range.text(), help))
    value = number(full(name), *text, unit, range);
}

void OptionGroup::operator()(const char* name, std::optional<Vec3>& value, const char* unit, const char* help) {
  Vec3 v = value.value_or(Vec3::Zero());
  const bool had = value.has_value();
  const std::string fallback = had ? fmt::format("{:g},{:g},{:g}", v[0], v[1], v[2]) : "";
  auto text = take(name, "vector", unit, fallback, "three numbers", help);
  if (!text) return;
  const auto parts = split_list(*text);
  if (parts.size() != 3) refuse(full(name), *text, fmt::format("three numbers in {}", unit));
  for (int d = 0; d < 3; ++d) v[d] = number(full(name), parts[d], unit, any);
  value = v;
}

void OptionGroup::operator()(const char* name, std::vector<double>& value, const char* unit, const char* help,
                             Range range) {
  auto text = take(name, "list", unit, fmt::format("{:g}", fmt::join(value, ",")), range.text(), help);
  if (!text) return;
  value.clear();
  for (const auto& part : split_list(*text)) value.push_back(number(full(name), part, unit, range));
}

void OptionGroup::operator()(const char* name, std::vector<int>& value, const char* unit, const char* help,
                             Range range) {
  auto text = take(name, "list", unit, fmt::format("{}", fmt::join(value, ",")), range.text(), help);
  if (!text) return;
  value.clear();
  for (const auto& part : split_list(*text)) value.push_back(whole(full(name), part, unit, range));
}

void OptionGroup::operator()(const char* name, std::vector<std::string>& value, const char* help) {
  auto text = take(name, "list", "", fmt::format("{}", fmt::join(value, ",")), "", help);
  if (text) value = split_list(*text);
}

}  // namespace silt
