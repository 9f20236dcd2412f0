#include <fmt/format.h>

#include <cmath>

#include "particles/field/electric.hpp"
#include "particles/field/magnetic.hpp"
#include "particles/force_field.hpp"

namespace silt {

std::vector<std::unique_ptr<ForceField>> make_force_fields(Options& options, const Mesh& mesh, Columns& columns,
                                                           const std::string& instructions) {
  std::vector<std::unique_ptr<ForceField>> fields;
  const auto add = [&](std::unique_ptr<ForceField> field) {
    if (field) fields.push_back(std::move(field));
  };
  add(Magnetic::create(options, mesh, columns, instructions));
  add(Electric::create(options, mesh, columns, instructions));
  return fields;
}

std::vector<std::string> cutoff_warnings(const std::string& name, double cutoff, double power,
                                         const Materials& materials, const SmallestRadii& smallest) {
  std::vector<std::string> warnings;
  for (int a = 0; a < materials.count() && cutoff > 0; ++a) {
    if (smallest.radius[a] >= infinity) continue;
    const double left = std::pow(2 * smallest.radius[a] / cutoff, power);
    if (left > 1e-3)
      warnings.push_back(
          fmt::format("the force between particles of {} is cut off at {:.2g} of its size in contact (-{} {:g} m); "
                      "allowed without this line: 0.001",
                      materials[a].name, left, name, cutoff));
  }
  return warnings;
}

}  // namespace silt
