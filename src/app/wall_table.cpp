#include "app/wall_table.hpp"

#include <fmt/format.h>

namespace silt {

WallTable::WallTable(const Particles* particles) {
  if (!particles) return;
  const auto names = particles->wall_names();
  for (std::size_t w = 0; w < names.size(); ++w) {
    const std::string& wall = names[w];
    conducts_.push_back(particles->wall_conducts(static_cast<int>(w)));
    for (const char* vector : {"wall_force", "wall_torque", "wall_displacement"})
      for (char axis : {'x', 'y', 'z'}) columns_.push_back(fmt::format("{}.{}_{}", wall, vector, axis));
    columns_.push_back(wall + ".wall_angle");
    if (conducts_.back()) columns_.push_back(wall + ".wall_heat");
  }
}

void WallTable::start(const OutputDirectory& directory) {
  if (columns_.size() > 1) table_ = directory.table("walls.csv", columns_);
}

void WallTable::sample(const Moment& moment, Quantities& quantities) {
  if (columns_.size() == 1) return;
  std::vector<double> row = {moment.time};
  const auto loads = moment.particles->wall_loads();
  for (std::size_t w = 0; w < loads.size(); ++w) {
    const auto& wall = loads[w];
    for (const Vec3* v : {&wall.force, &wall.torque, &wall.displacement})
      row.insert(row.end(), v->data(), v->data() + 3);
    row.push_back(wall.angle);
    if (conducts_[w]) row.push_back(wall.heat);
  }
  for (std::size_t k = 1; k < row.size(); ++k) quantities.set(columns_[k], row[k]);
  table_.row(row);
}

}  // namespace silt
