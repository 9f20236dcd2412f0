#pragma once
#include <string>

namespace silt {

/// What is wrong with a Gmsh file, and where; empty when it is whole: format 2.2 or 4.1, text or binary, every count as
/// said, every node of an element and every entity there, linear cells only. PETSc's reader trusts all of that. Local.
std::string fault_of_gmsh_file(const std::string& path);

}  // namespace silt
