#pragma once
#include <string>

#include "base/options.hpp"

namespace silt {

/// Every option there is, with `<name>` where the user chooses a word: the source of -help and docs/options.md.
const Options& catalogue();

/// The laws that can be chosen, a line each: slot, name, equation and source.
std::string model_list();

/// The same with formulas, parameters and checks: the body of docs/models.md.
std::string model_page();

}  // namespace silt
