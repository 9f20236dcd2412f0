#pragma once
#include <string>
#include <vector>

namespace silt {

/// `silt case.yaml [more.yaml] [-option value ...]`: runs a case, or answers -help, -version, -check, -models,
/// -options_page. Returns the exit code: 0 done, 1 the run stopped or an expected figure was missed, 2 a mistake of the
/// user.
int run_program(const std::vector<std::string>& arguments);

}  // namespace silt
