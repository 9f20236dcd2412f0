#pragma once
#include <string>

namespace silt {

/// Whether the user gave an option of PETSc (`-name`); one that default_solver_option() set does not count.
bool solver_option_given(const std::string& name);

/// Sets an option of PETSc that the user did not give. One that was set here before, for another solver, gives way:
/// what a solver gets does not depend on those made before it.
void default_solver_option(const std::string& name, const std::string& value);

}  // namespace silt
