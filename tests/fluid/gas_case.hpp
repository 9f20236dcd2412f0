#pragma once
#include <algorithm>

#include "flow_case.hpp"
#include "fluid/compressible/compressible.hpp"

namespace silt::test {

inline bool flat(const std::string& cell) { return cell == "quadrilateral" || cell == "triangle"; }

/// A gas with R = 1 in a unit box.
inline FlowCase::Settings gas(const std::string& cell, const std::string& cells) {
  return {{"mesh_cell", cell},         {"mesh_upper", flat(cell) ? "1, 1, 0" : "1, 1, 1"},
          {"mesh_cells", cells},       {"fluid_type", "compressible"},
          {"fluid_gas_constant", "1"}, {"fluid_viscosity", "0"}};
}

/// -boundary_<name>_<property> for every name of a list.
inline void set(FlowCase::Settings& settings, const std::string& names, const std::string& property,
                const std::string& value) {
  size_t start = 0;
  while (start < names.size()) {
    const size_t end = std::min(names.find(' ', start), names.size());
    settings.push_back({"boundary_" + names.substr(start, end - start) + "_" + property, value});
    start = end + 1;
  }
}

inline Compressible& gas_of(FlowCase& flow) { return dynamic_cast<Compressible&>(*flow.fluid); }

}  // namespace silt::test
