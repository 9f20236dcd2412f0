#include "particles/field_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "particles/force_field.hpp"
#include "particles/law_table.hpp"

namespace silt {

std::string field_table(Options& options, const LawTableOptions& chosen) {
  const Materials materials(options);
  if (materials.count() == 0) throw UserError("-law_table_motion needs a material: give -material_<name>_density");
  const double radius = chosen.radius, far = 2 * radius + chosen.gap.value_or(8 * radius);
  MeshOptions box;
  box.cells = {2, 2, 2};
  box.lower = Vec3::Constant(-2 * far), box.upper = Vec3::Constant(2 * far);
  const Mesh mesh(box);
  Store store;
  const auto fields = make_force_fields(options, mesh, store.columns, "plain");
  if (fields.empty()) throw UserError("-law_table_motion field needs -magnetic_type or -electric_type");
  store.owned = 2;
  store.reserve(2);
  store.id = {0, 1};
  store.cell = {0, 0};
  for (int p = 0; p < 2; ++p) {
    Seed seed;
    seed.radius = radius;
    Motion& motion = store.motion[p];
    motion = Motion{};
    store.rotation[p] = Rotation{};
    motion.radius = radius;
    motion.inverse_mass = 1 / (*materials[0].density * 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3));
    store.columns.start(p, seed);
  }
  store.place_padding();
  const double angle = chosen.angle * std::numbers::pi / 180;
  const Vec3 along(std::sin(angle), 0, std::cos(angle)), across(std::cos(angle), 0, -std::sin(angle));
  std::string text = "distance,radial,across,torque\n";
  for (int k = 0; k < chosen.rows; ++k) {
    const double distance = 2 * radius * std::pow(far / (2 * radius), k / (chosen.rows - 1.0));
    vec3(store.motion[0].position) = distance * along;
    store.present[0] = store.present[1] = store.previous[0] = store.previous[1] = Load{};
    FieldStep step{store, Periods{}, materials, MPI_COMM_SELF, 0, 0};
    for (const auto& field : fields) field->act(step);
    const Vec3 force = vec3(store.present[0].force), torque = vec3(store.present[0].torque);
    text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}\n", distance, force.dot(along), force.dot(across), torque[1]);
  }
  return text;
}

}  // namespace silt
