#pragma once
#include <string>

#include "base/options.hpp"

namespace silt {

struct LawTableOptions;

/// What the fields of a case (`-magnetic_...`, `-electric_...`) do between two equal particles whose line of centres
/// makes `-law_table_angle` with z, as `distance,radial,across,torque` from touching on: the force on one of them away
/// from the other (N, > 0 repulsive) and across to greater angles (N), and its torque about y (N m). Throws UserError
/// without a field.
std::string field_table(Options& options, const LawTableOptions& chosen);

}  // namespace silt
