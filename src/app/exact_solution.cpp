#include "app/exact_solution.hpp"

#include <array>
#include <cmath>

#include "base/error.hpp"

namespace silt {

ExactSolution::ExactSolution(const Mesh& mesh, Options& options, const Fluid* fluid) : mesh_(mesh) {
  ExactOptions given;
  options.read("exact", given);
  if (!given.velocity.empty()) {
    velocity_.emplace("exact_velocity", given.velocity);
    columns_.push_back("velocity_error");
  }
  if (!given.pressure.empty()) {
    pressure_.emplace("exact_pressure", given.pressure);
    columns_.push_back("pressure_error");
  }
  if (!given.temperature.empty()) {
    temperature_.emplace("exact_temperature", given.temperature);
    columns_.emplace_back("temperature_error");
  }
  if (columns_.empty()) return;
  if (!fluid) throw UserError("-exact_... needs a fluid (-fluid_type)");
  if (temperature_ && fluid->temperature().empty())
    throw UserError("-exact_temperature needs a fluid with a temperature (-fluid_energy yes)");
  for (const auto& name : mesh.boundaries) {
    const std::string type = options.find("boundary_" + name + "_type").value_or("");
    if (type == "pressure" || type == "total_pressure" || type == "far_field") free_pressure_ = false;
  }
  if (options.find("fluid_type").value_or("") == "compressible") free_pressure_ = false;
}

void ExactSolution::start(const OutputDirectory& directory) {
  if (columns_.empty()) return;
  std::vector<std::string> names = {"time"};
  names.insert(names.end(), columns_.begin(), columns_.end());
  table_ = directory.table("errors.csv", names);
}

void ExactSolution::sample(const Moment& moment, Quantities& quantities) {
  if (columns_.empty()) return;
  std::vector<double> row = measure(moment);
  for (size_t k = 0; k < row.size(); ++k) quantities.set(columns_[k], row[k]);
  row.insert(row.begin(), moment.time);
  table_.row(row);
}

std::vector<double> ExactSolution::measure(const Moment& moment) const {
  const Quadrature rule = quadrature(mesh_.cell, 5);
  const int nv = mesh_.nodes_per_cell;
  const auto u = moment.fluid->velocity(), p = moment.fluid->pressure(), T = moment.fluid->temperature();
  const std::vector<double> finer = velocity_ ? moment.fluid->velocity_at(rule) : std::vector<double>();
  // Squares of the errors of velocity, pressure and temperature; the pressure's error itself.
  std::array<double, 4> sum{};
  for (int c = 0; c < mesh_.cells; ++c)
    for (int q = 0; q < rule.points; ++q) {
      double N[8], dN[8][3], pressure = 0, temperature = 0;
      shape(mesh_.cell, rule.point[q].data(), N, dN);
      Vec3 x = Vec3::Zero(), velocity = Vec3::Zero();
      Mat3 J = Mat3::Zero();
      for (int a = 0; a < nv; ++a) {
        const size_t corner = static_cast<size_t>(c) * nv + a, i = mesh_.cell_nodes[corner];
        const auto place = vec3(&mesh_.cell_coordinates[3 * corner]);
        x += N[a] * place;
        J += place * vec3(dN[a]).transpose();
        velocity += N[a] * vec3(&u[3 * i]);
        pressure += N[a] * p[i];
        if (!T.empty()) temperature += N[a] * T[i];
      }
      if (mesh_.dimension == 2) J(2, 2) = 1;
      if (!finer.empty()) velocity = vec3(&finer[3 * (static_cast<size_t>(c) * rule.points + q)]);
      const double weight = rule.weight[q] * J.determinant();
      if (velocity_) sum[0] += weight * (velocity - (*velocity_)(x, moment.time)).squaredNorm();
      if (pressure_) {
        const double difference = pressure - (*pressure_)(x, moment.time);
        sum[1] += weight * difference * difference;
        sum[3] += weight * difference;
      }
      if (temperature_) sum[2] += weight * std::pow(temperature - (*temperature_)(x, moment.time), 2);
    }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  if (free_pressure_) sum[1] = std::max(0.0, sum[1] - sum[3] * sum[3] / mesh_.volume);
  std::vector<double> row;
  if (velocity_) row.push_back(std::sqrt(sum[0] / mesh_.volume));
  if (pressure_) row.push_back(std::sqrt(sum[1] / mesh_.volume));
  if (temperature_) row.push_back(std::sqrt(sum[2] / mesh_.volume));
  return row;
}

}  // namespace silt
