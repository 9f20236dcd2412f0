#include "base/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <petscsys.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

#include "base/error.hpp"
#include "base/text.hpp"

namespace silt {
namespace {

std::string number_text(double value) { return fmt::format("{:g}", value); }

bool is_number_start(std::string_view text) {
  return text.size() > 1 && (std::isdigit(static_cast<unsigned char>(text[1])) || text[1] == '.');
}

/// PETSc's own option families: a name under one of them that no solver has used yet is not an error of the user
/// (solvers inside preconditioners are created late, if at all).
bool belongs_to_petsc(const std::string& name) {
  static const std::vector<std::string> starts = {
      "log_", "dm_plex_", "options_",          "malloc",  "on_error", "info", "memory_", "start_in_debugger",
      "mat_", "vec_",     "petscpartitioner_", "fp_trap", "viewer_"};
  static const std::vector<std::string> middles = {"_ksp_", "_pc_", "_snes_", "_mg_", "_sub_", "_fieldsplit_", "_mat_"};
  for (const auto& start : starts)
    if (name.rfind(start, 0) == 0) return true;
  for (const auto& middle : middles)
    if (name.find(middle) != std::string::npos) return true;
  return false;
}

/// Whether a name is the pattern with a word in place of each `<...>`.
bool matches(std::string_view name, std::string_view pattern) {
  const auto open = pattern.find('<');
  if (open == std::string_view::npos) return name == pattern;
  const auto close = pattern.find('>', open);
  if (name.substr(0, open) != pattern.substr(0, open)) return false;
  for (size_t k = open + 1; k <= name.size(); ++k)
    if (matches(name.substr(k), pattern.substr(close + 1))) return true;
  return false;
}

/// The pattern with the user's own word for its `<...>`, so that `boundary_lid_velocty` is near
/// `boundary_lid_velocity`.
std::string with_words_of(const std::string& pattern, const std::string& name) {
  const auto open = pattern.find('<'), close = pattern.rfind('>');
  if (open == std::string::npos || name.compare(0, open, pattern, 0, open) != 0) return pattern;
  const std::string property = pattern.substr(close + 1);
  auto end = name.size();
  for (auto left = std::count(property.begin(), property.end(), '_'); left > 0 && end != std::string::npos; --left)
    end = end == 0 ? std::string::npos : name.rfind('_', end - 1);
  return end == std::string::npos || end <= open ? pattern : name.substr(0, end) + property;
}

void flatten(const YAML::Node& node, const std::string& prefix, const std::string& file, Options& options) {
  const std::string origin = fmt::format("{}:{}", file, node.Mark().line + 1);
  if (node.IsMap()) {
    for (const auto& pair : node) {
      const auto key = pair.first.as<std::string>();
      flatten(pair.second, prefix.empty() ? key : prefix + "_" + key, file, options);
    }
  } else if (node.IsSequence()) {
    std::vector<std::string> items;
    for (const auto& item : node) {
      if (!item.IsScalar()) throw UserError(fmt::format("{}: '{}' must be a list of plain values", origin, prefix));
      items.push_back(item.as<std::string>());
    }
    options.set(prefix, fmt::format("{}", fmt::join(items, ",")), origin);
  } else if (node.IsScalar()) {
    options.set(prefix, node.as<std::string>(), origin);
  } else {
    throw UserError(fmt::format("{}: '{}' has no value", origin, prefix));
  }
}

/// Reads a file into the options; `include: other.yaml` (or a list) at its top is read first, relative to the file.
void read_yaml(const std::string& file, Options& options, int depth = 0) {
  if (depth > 8) throw UserError(fmt::format("{}: include: the files include each other in a circle", file));
  if (!std::filesystem::is_regular_file(file)) throw UserError(fmt::format("options file '{}' does not exist", file));
  try {
    const YAML::Node root = YAML::LoadFile(file);
    if (root.IsNull()) return;
    if (!root.IsMap()) throw UserError(fmt::format("{}: an options file is a map of names and values", file));
    for (const auto& pair : root) {
      const auto key = pair.first.as<std::string>();
      if (key != "include") continue;
      const auto folder = std::filesystem::path(file).parent_path();
      const YAML::Node& names = pair.second;
      for (size_t k = 0; k < (names.IsSequence() ? names.size() : 1); ++k)
        read_yaml((folder / (names.IsSequence() ? names[k] : names).as<std::string>()).string(), options, depth + 1);
    }
    for (const auto& pair : root)
      if (const auto key = pair.first.as<std::string>(); key != "include") flatten(pair.second, key, file, options);
  } catch (const YAML::Exception& e) {
    throw UserError(fmt::format("{}:{}: not valid YAML: {}", file, e.mark.line + 1, e.msg));
  }
}

}  // namespace

bool Range::contains(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::text() const {
  const bool below = low <= -infinity, above = high >= infinity;
  if (below && above) return "";
  if (above) return fmt::format("{} {}", low_open ? ">" : ">=", number_text(low));
  if (below) return fmt::format("{} {}", high_open ? "<" : "<=", number_text(high));
  return fmt::format("{}{}, {}{}", low_open ? "(" : "[", number_text(low), number_text(high), high_open ? ")" : "]");
}

Options Options::from_arguments(const std::vector<std::string>& arguments) {
  Options options;
  std::vector<std::pair<std::string, std::string>> command_line;
  for (size_t k = 0; k < arguments.size(); ++k) {
    const std::string& word = arguments[k];
    if (word.size() > 1 && word[0] == '-' && !is_number_start(word)) {
      const std::string name = word.substr(word[1] == '-' ? 2 : 1);
      const bool has_value = k + 1 < arguments.size() && (arguments[k + 1].empty() || arguments[k + 1][0] != '-' ||
                                                          is_number_start(arguments[k + 1]));
      static const std::set<std::string> switches = {"check", "help", "version", "models", "options_page", "log_view"};
      const bool is_switch = switches.count(name) > 0;
      command_line.emplace_back(name, has_value && !is_switch ? arguments[++k] : "");
    } else {
      read_yaml(word, options);
    }
  }
  for (const auto& [name, value] : command_line) options.set(name, value, "command line");
  return options;
}

void Options::set(const std::string& name, const std::string& value, const std::string& origin) {
  given_[lower_case(name)] = {value, origin, false};
}

bool Options::given(const std::string& name) const { return given_.count(name) > 0; }

std::optional<std::string> Options::find(const std::string& name) {
  const auto it = given_.find(name);
  if (it == given_.end()) return std::nullopt;
  it->second.used = true;
  return it->second.value;
}

std::string Options::origin(const std::string& name) const {
  const auto it = given_.find(name);
  return it == given_.end() ? "" : it->second.origin;
}

std::vector<std::string> Options::names(const std::string& prefix, const std::vector<std::string>& properties) const {
  std::set<std::string> found;
  const std::string start = prefix + "_";
  for (const auto& [name, given] : given_) {
    if (name.rfind(start, 0) != 0) continue;
    const std::string rest = name.substr(start.size());
    std::string best;  // the longest matching property: "a_velocity" must not be taken for property "y"
    for (const auto& property : properties)
      if (rest.size() > property.size() + 1 &&
          rest.compare(rest.size() - property.size() - 1, std::string::npos, "_" + property) == 0 &&
          property.size() > best.size())
        best = property;
    if (best.empty()) {
      const auto split = rest.find('_');
      const std::string word = split == std::string::npos ? "" : rest.substr(split + 1);
      const std::string hint = nearest(word, properties);
      throw UserError(fmt::format(
          "unknown option -{} ({}){}", name, given.origin,
          hint.empty() ? fmt::format(": -{}_<name>_ must be followed by one of {}", prefix, fmt::join(properties, ", "))
                       : fmt::format(", did you mean -{}_{}_{}?", prefix, rest.substr(0, split), hint)));
    }
    found.insert(rest.substr(0, rest.size() - best.size() - 1));
  }
  return {found.begin(), found.end()};
}

void Options::insert_into_petsc() const {
  for (const auto& [name, given] : given_)
    PetscOptionsSetValue(nullptr, ("-" + name).c_str(), given.value.empty() ? nullptr : given.value.c_str());
}

void Options::refuse_unknown(const Options* catalogue) const {
  std::vector<std::string> known;
  for (const auto& entry : entries_) known.push_back(entry.name);
  std::vector<std::string> patterns;
  if (catalogue)
    for (const auto& entry : catalogue->entries_) patterns.push_back(entry.name);
  for (const auto& [name, given] : given_) {
    if (given.used || belongs_to_petsc(name)) continue;
    PetscBool used = PETSC_FALSE;
    PetscOptionsUsed(nullptr, ("-" + name).c_str(), &used);
    const auto fits = [&word = name](const std::string& pattern) { return matches(word, pattern); };
    if (used || std::find(known.begin(), known.end(), name) != known.end() ||
        std::any_of(patterns.begin(), patterns.end(), fits))
      continue;
    for (const auto& pattern : patterns) known.push_back(with_words_of(pattern, name));
    const std::string hint = nearest(name, known);
    throw UserError(fmt::format("unknown option -{} ({}){}", name, given.origin,
                                hint.empty() ? "; -help lists all" : fmt::format(", did you mean -{}?", hint)));
  }
}

std::vector<std::pair<std::string, std::string>> Options::undeclared() const {
  std::vector<std::pair<std::string, std::string>> result;
  for (const auto& [name, given] : given_)
    if (std::none_of(entries_.begin(), entries_.end(),
                     [&word = name](const auto& entry) { return entry.name == word; }))
      result.emplace_back(name, given.value);
  return result;
}

void Options::declare(OptionEntry entry) {
  for (auto& known : entries_)
    if (known.name == entry.name) {
      known = std::move(entry);
      return;
    }
  entries_.push_back(std::move(entry));
}

std::string Options::help_text() const {
  std::string text;
  for (const auto& e : entries_)
    text += fmt::format("  -{:<40} {:<10} {}{}\n", e.name, e.fallback.empty() ? "(none)" : e.fallback, e.help,
                        e.unit.empty() || e.unit == "-"
                            ? (e.range.empty() ? "" : fmt::format(" [{}]", e.range))
                            : fmt::format(" [{}{}{}]", e.unit, e.range.empty() ? "" : ", ", e.range));
  return text;
}

std::string Options::markdown() const {
  std::string text, section;
  for (const auto& e : entries_) {
    const std::string head = e.name.substr(0, e.name.find('_'));
    if (head != section) {
      section = head;
      text +=
          fmt::format("\n## {}\n\n| option | default | unit | allowed | meaning |\n|---|---|---|---|---|\n", section);
    }
    std::string range = e.range;
    for (size_t k = 0; (k = range.find('|', k)) != std::string::npos; k += 2) range.replace(k, 1, "\\|");
    text += fmt::format("| `-{}` | {} | {} | {} | {} |\n", e.name, e.fallback, e.unit.empty() ? "-" : e.unit, range,
                        e.help);
  }
  return text;
}

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  std::string best;
  size_t best_distance = std::max<size_t>(2, word.size() / 4) + 1;
  for (const auto& candidate : known) {
    std::vector<size_t> row(candidate.size() + 1);
    std::iota(row.begin(), row.end(), size_t{0});
    for (size_t i = 1; i <= word.size(); ++i) {
      size_t corner = row[0];
      row[0] = i;
      for (size_t j = 1; j <= candidate.size(); ++j) {
        const size_t above = row[j];
        row[j] = std::min({above + 1, row[j - 1] + 1, corner + (word[i - 1] != candidate[j - 1])});
        corner = above;
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = candidate;
    }
  }
  return best;
}

}  // namespace silt
