#include "app/exact_solution.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"

namespace silt {
namespace {

/// Whether nothing fixes the constant in the pressure.
bool pressure_is_free(const Mesh& mesh, Options& options) {
  for (const auto& name : mesh.boundaries) {
    const std::string type = options.find("boundary_" + name + "_type").value_or("");
    if (type == "pressure" || type == "total_pressure" || type == "far_field") return false;
  }
  return options.find("fluid_type").value_or("") != "compressible";
}

}  // namespace

ExactSolution::ExactSolution(const Mesh& mesh, Options& options, const Fluid* fluid) : mesh_(mesh) {
  ExactOptions given;
  options.read("exact", given);
  mean_ = given.norm == "mean";
  if (!given.velocity.empty()) {
    velocity_.emplace("exact_velocity", given.velocity);
    columns_.emplace_back("velocity_error");
  }
  const auto add = [&](const std::string& name, const std::string& text) {
    if (text.empty()) return;
    fields_.push_back({name, Expression("exact_" + name, text), name == "pressure" && pressure_is_free(mesh, options)});
    columns_.push_back(name + "_error");
  };
  add("pressure", given.pressure);
  add("temperature", given.temperature);
  add("density", given.density);
  add("turbulent_energy", given.turbulent_energy);
  add("turbulent_dissipation", given.turbulent_dissipation);
  add("specific_dissipation", given.specific_dissipation);
  if (columns_.empty()) {
    if (options.given("exact_norm"))
      throw UserError("-exact_norm has no meaning without an exact solution (-exact_...)");
    return;
  }
  if (!fluid) throw UserError("-exact_... needs a fluid (-fluid_type)");
  for (const Field& field : fields_) {
    if (field.up_to_a_constant && mean_)
      throw UserError("-exact_norm mean needs a boundary that fixes the pressure for -exact_pressure");
    if (mpi_any(!values(*fluid, field.name).empty())) continue;
    throw UserError(fmt::format("-exact_{} needs {}", field.name,
                                field.name == "temperature" ? "a fluid with a temperature (-fluid_energy yes)"
                                : field.name == "density"   ? "-fluid_type compressible"
                                : field.name == "turbulent_dissipation" ? "-fluid_turbulence realizable_k_epsilon"
                                : field.name == "specific_dissipation"  ? "-fluid_turbulence sst_k_omega"
                                                                        : "a fluid with -fluid_turbulence"));
  }
}

std::span<const double> ExactSolution::values(const Fluid& fluid, const std::string& name) {
  if (name == "pressure") return fluid.pressure();
  if (name == "temperature") return fluid.temperature();
  for (const Fluid::Scalar& scalar : fluid.scalars())
    if (scalar.name == name) return scalar.values;
  return {};
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
  const auto u = moment.fluid->velocity();
  const std::vector<double> finer = velocity_ ? moment.fluid->velocity_at(rule) : std::vector<double>();
  std::vector<std::span<const double>> computed;
  for (const Field& field : fields_) computed.push_back(values(*moment.fluid, field.name));
  // Sums over the domain: of the velocity's error, of each field's error, of each field's difference.
  const size_t count = fields_.size();
  std::vector<double> sum(1 + 2 * count, 0.0), value(count);
  for (int c = 0; c < mesh_.cells; ++c)
    for (int q = 0; q < rule.points; ++q) {
      double N[8], dN[8][3];
      shape(mesh_.cell, rule.point[q].data(), N, dN);
      Vec3 x = Vec3::Zero(), velocity = Vec3::Zero();
      Mat3 J = Mat3::Zero();
      std::fill(value.begin(), value.end(), 0.0);
      for (int a = 0; a < nv; ++a) {
        const size_t corner = static_cast<size_t>(c) * nv + a, i = mesh_.cell_nodes[corner];
        const auto place = vec3(&mesh_.cell_coordinates[3 * corner]);
        x += N[a] * place;
        J += place * vec3(dN[a]).transpose();
        velocity += N[a] * vec3(&u[3 * i]);
        for (size_t k = 0; k < count; ++k) value[k] += N[a] * computed[k][i];
      }
      if (mesh_.dimension == 2) J(2, 2) = 1;
      if (!finer.empty()) velocity = vec3(&finer[3 * (static_cast<size_t>(c) * rule.points + q)]);
      const double weight = rule.weight[q] * J.determinant();
      const auto size = [&](double difference) { return mean_ ? std::abs(difference) : difference * difference; };
      if (velocity_) sum[0] += weight * size((velocity - (*velocity_)(x, moment.time)).norm());
      for (size_t k = 0; k < count; ++k) {
        const double difference = value[k] - fields_[k].exact(x, moment.time);
        sum[1 + k] += weight * size(difference);
        sum[1 + count + k] += weight * difference;
      }
    }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), static_cast<int>(sum.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  const auto error = [&](double total) { return mean_ ? total / mesh_.volume : std::sqrt(total / mesh_.volume); };
  std::vector<double> row;
  if (velocity_) row.push_back(error(sum[0]));
  for (size_t k = 0; k < count; ++k) {
    const double difference = sum[1 + count + k];
    row.push_back(error(fields_[k].up_to_a_constant ? std::max(0.0, sum[1 + k] - difference * difference / mesh_.volume)
                                                    : sum[1 + k]));
  }
  return row;
}

}  // namespace silt
