#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/vector.hpp"

namespace silt {

/// Closed or open interval that a number must lie in; its text stands in the help and in the error.
struct Range {
  double low, high;
  bool low_open, high_open;
  bool contains(double value) const;
  std::string text() const;
};
inline constexpr double infinity = 1e300;
inline constexpr Range any{-infinity, infinity, true, true};
inline constexpr Range positive{0, infinity, true, true};
inline constexpr Range non_negative{0, infinity, false, true};
inline constexpr Range fraction{0, 1, false, false};
inline constexpr Range between(double low, double high) { return {low, high, false, false}; }
inline constexpr Range at_least(double low) { return {low, infinity, false, true}; }

/// What was declared of one option: drives `-help`, docs/options.md, the nearest-name search and the record of the run.
struct OptionEntry {
  std::string name;      ///< full name without the dash, `<name>` where the user chooses a word
  std::string type;      ///< number, integer, yes/no, word, text, vector, list, expression
  std::string unit;      ///< SI, "-" when it has none
  std::string fallback;  ///< default as text
  std::string range;     ///< allowed values as text, empty when any
  std::string help;      ///< one sentence
  std::string value;     ///< value in this run
  bool given = false;    ///< the user gave it
};

/// Name of a file to be read. One that is not there seen from the working directory is looked for beside the options
/// file that names it.
class InputFile : public std::string {
 public:
  using std::string::string;
  using std::string::operator=;
};

class OptionGroup;

/// The options of a run: what the user gave (files, then command line; later wins), and what was declared of them.
///
/// An option is declared in one line beside the member it fills:
/// `void options(OptionGroup& option) { option("density", density, "kg/m3", "density of the fluid", positive); }`
/// and read by `options.read("fluid", fluid)`, which looks for `-fluid_density`. Nested YAML maps join by `_`.
class Options {
 public:
  Options() = default;
  /// Parses `file.yaml ... -name value ...`; throws UserError for a missing or malformed file.
  static Options from_arguments(const std::vector<std::string>& arguments);

  /// Adds one option as if given; `origin` (file:line or "command line") is quoted in errors. Later wins.
  void set(const std::string& name, const std::string& value, const std::string& origin = "command line");
  bool given(const std::string& name) const;
  /// The text given, if any; marks the option as used.
  std::optional<std::string> find(const std::string& name);
  std::string origin(const std::string& name) const;

  /// Fills `object` (anything with `void options(OptionGroup&)`) from the options `-<prefix>_<name>`.
  template <class T>
  void read(const std::string& prefix, T& object);

  /// The words W for which any `-<prefix>_W_<property>` was given, `property` being one of `properties` (sorted).
  /// Throws UserError for a `-<prefix>_...` that ends in none of them.
  std::vector<std::string> names(const std::string& prefix, const std::vector<std::string>& properties) const;

  /// The property names a type declares, for names(): `declared<Material>()`.
  template <class T>
  static std::vector<std::string> declared();

  /// Hands everything given to PETSc's own options database (solver options are PETSc's).
  void insert_into_petsc() const;
  /// Throws UserError with the nearest known name for an option given that nobody declared and PETSc did not use.
  /// `catalogue` declares every option there is, with `<name>` for the user's words: one that is in it but belongs to a
  /// feature that is off in this run is let through.
  void refuse_unknown(const Options* catalogue = nullptr) const;

  const std::vector<OptionEntry>& entries() const { return entries_; }
  /// Names and values of what was given and nobody declared: options of PETSc and of features that are off.
  std::vector<std::pair<std::string, std::string>> undeclared() const;
  void declare(OptionEntry entry);
  /// Text for `-help`, and the body of docs/options.md.
  std::string help_text() const;
  std::string markdown() const;

 private:
  struct Given {
    std::string value, origin;
    mutable bool used = false;
  };
  std::map<std::string, Given> given_;
  std::vector<OptionEntry> entries_;
};

/// Declares and reads options under one prefix. Every overload throws UserError naming option, value, unit and range.
class OptionGroup {
 public:
  OptionGroup(Options& options, std::string prefix) : options_(options), prefix_(std::move(prefix)) {}

  void operator()(const char* name, double& value, const char* unit, const char* help, Range range = any);
  void operator()(const char* name, int& value, const char* unit, const char* help, Range range = any);
  void operator()(const char* name, bool& value, const char* help);
  /// Free text: names, files, expressions.
  void operator()(const char* name, std::string& value, const char* help);
  void operator()(const char* name, InputFile& value, const char* help);
  /// One of a list of words.
  void operator()(const char* name, std::string& value, const std::vector<std::string>& allowed, const char* help);
  void operator()(const char* name, Vec3& value, const char* unit, const char* help);
  void operator()(const char* name, std::optional<double>& value, const char* unit, const char* help,
                  Range range = any);
  void operator()(const char* name, std::optional<Vec3>& value, const char* unit, const char* help);
  void operator()(const char* name, std::vector<double>& value, const char* unit, const char* help, Range range = any);
  void operator()(const char* name, std::vector<int>& value, const char* unit, const char* help, Range range = any);
  void operator()(const char* name, std::vector<std::string>& value, const char* help);

  /// Declares the options of a member struct under `<prefix>_<name>`.
  template <class T>
  void group(const char* name, T& object) {
    OptionGroup inner(options_, full(name));
    object.options(inner);
  }
  /// Whether the user gave `<prefix>_<name>`.
  bool given(const char* name) const { return options_.given(full(name)); }
  std::string full(const std::string& name) const { return prefix_.empty() ? name : prefix_ + "_" + name; }

 private:
  /// Registers the entry and returns the text given, if any.
  std::optional<std::string> take(const char* name, const char* type, const char* unit, const std::string& fallback,
                                  const std::string& range, const char* help);
  [[noreturn]] void refuse(const std::string& name, const std::string& text, const std::string& allowed) const;
  double number(const std::string& name, const std::string& text, const char* unit, const Range& range) const;
  int whole(const std::string& name, const std::string& text, const char* unit, const Range& range) const;

  Options& options_;
  std::string prefix_;
};

/// The entry of `known` nearest to `word` by edit distance; empty when none is near enough to be meant.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

template <class T>
void Options::read(const std::string& prefix, T& object) {
  OptionGroup group(*this, prefix);
  object.options(group);
}

template <class T>
std::vector<std::string> Options::declared() {
  Options scratch;
  T object{};
  scratch.read("", object);
  std::vector<std::string> result;
  for (const auto& entry : scratch.entries_) result.push_back(entry.name);
  return result;
}

}  // namespace silt
