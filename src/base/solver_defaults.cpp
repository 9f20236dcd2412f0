#include "base/solver_defaults.hpp"

#include <map>

#include "base/petsc.hpp"

namespace silt {
namespace {

/// Names and values of the defaults in PETSc's database.
std::map<std::string, std::string>& defaults() {
  static std::map<std::string, std::string> set;
  return set;
}

}  // namespace

bool solver_option_given(const std::string& name) {
  PetscBool found = PETSC_FALSE;
  char text[256] = "";
  SILT_PETSC(PetscOptionsGetString(nullptr, nullptr, name.c_str(), text, sizeof text, &found));
  const auto known = defaults().find(name);
  return found && (known == defaults().end() || known->second != text);
}

void default_solver_option(const std::string& name, const std::string& value) {
  if (solver_option_given(name)) return;
  SILT_PETSC(PetscOptionsSetValue(nullptr, name.c_str(), value.c_str()));
  defaults()[name] = value;
}

}  // namespace silt
