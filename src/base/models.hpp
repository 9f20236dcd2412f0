#pragma once
#include <string>
#include <variant>
#include <vector>

#include "base/options.hpp"

namespace silt {

/// What `silt -models` and docs/models.md say of a model; its `static constexpr ModelNote note`.
struct ModelNote {
  const char* equation;  ///< tag of the equation, "" where it has none
  const char* source;    ///< paper
  const char* formula;   ///< in one line; it stands here and nowhere else
  const char* check;     ///< closed form it is tested against
};

/// A model that has an option of its own rather than a place in a list, as `-models` and docs/models.md show it.
struct SwitchedModel {
  const char* name;
  const char* option;  ///< that switches it on, with its value; without one where any value does
  ModelNote note;
};

/// A list of physical models among which the user picks one by name: `using Normal = Models<Linear, Tsuji>;`.
/// A model has `static constexpr const char* name`, `void options(OptionGroup&)` and, where its options depend on each
/// other, `void check() const` (throws UserError); the list's line is its
/// registration.
template <class... Model>
struct Models {
  using Any = std::variant<Model...>;
  static constexpr int count = sizeof...(Model);
  static std::vector<std::string> names() { return {Model::name...}; }

  /// Reads `-<prefix>_type` (default: `fallback`) and the options of the model chosen under `-<prefix>_...`.
  static Any read(Options& options, const std::string& prefix, const std::string& fallback, const char* help) {
    Choice choice{fallback, help};
    options.read(prefix, choice);
    Any chosen;
    ((choice.type == Model::name ? void(chosen = Model{}) : void()), ...);
    std::visit(
        [&](auto& model) {
          options.read(prefix, model);
          if constexpr (requires { model.check(); }) model.check();
        },
        chosen);
    return chosen;
  }

 private:
  struct Choice {
    std::string type;
    const char* help;
    void options(OptionGroup& option) { option("type", type, names(), help); }
  };
};

}  // namespace silt
