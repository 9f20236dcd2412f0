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

}  // namespace silt
