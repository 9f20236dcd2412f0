#include "fluid/boundary/drive.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace silt {

std::unique_ptr<Drive> Drive::create(const Mesh& mesh, Options& options, double density) {
  DriveOptions given;
  options.read("fluid_drive", given);
  const std::pair<const char*, const std::string*> ways[] = {
      {"pressure_gradient", &given.pressure_gradient}, {"velocity", &given.velocity}, {"mass_flow", &given.mass_flow}};
  int count = 0;
  for (const auto& [name, text] : ways) count += options.given(fmt::format("fluid_drive_{}", name));
  if (given.direction.empty()) {
    if (count) throw UserError("-fluid_drive_direction is missing: x, y or z, a periodic direction of the mesh");
    return nullptr;
  }
  if (count != 1)
    throw UserError(
        "-fluid_drive_direction needs exactly one of -fluid_drive_pressure_gradient, -fluid_drive_velocity and "
        "-fluid_drive_mass_flow");
  std::unique_ptr<Drive> drive(new Drive);
  const int d = drive->direction_ = given.direction[0] - 'x';
  if (d >= mesh.dimension || !mesh.periodic[d])
    throw UserError(fmt::format("option -fluid_drive_direction: the mesh is not periodic along {} (-mesh_periodic)",
                                given.direction));
  for (const auto& [name, text] : ways) {
    if (!options.given(fmt::format("fluid_drive_{}", name))) continue;
    drive->formula_ = std::make_unique<Expression>(fmt::format("fluid_drive_{}", name), *text);
    if (!drive->formula_->uniform())
      throw UserError(
          fmt::format("option -fluid_drive_{}: '{}' depends on the place; it is one number for the whole "
                      "flow",
                      name, *text));
  }
  drive->controlled_ = given.pressure_gradient.empty();
  if (!given.mass_flow.empty())  // mean over the length of int rho alpha u dA
    drive->factor_ = (mesh.upper[d] - mesh.lower[d]) / (density * mesh.volume);
  return drive;
}

void Drive::refuse(const Options& options, const std::string& reason) {
  for (const auto& name : Options::declared<DriveOptions>())
    if (options.given("fluid_drive_" + name))
      throw UserError(fmt::format("-fluid_drive_{} is not available {}", name, reason));
}

}  // namespace silt
