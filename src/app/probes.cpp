#include "app/probes.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace silt {

void ProbeOptions::options(OptionGroup& option) {
  option("point", point, "m", "where the fluid is recorded every step");
}

void LineOptions::options(OptionGroup& option) {
  option("from", from, "m", "start of the line where the fluid is recorded at every output");
  option("to", to, "m", "its end");
  option("points", points, "-", "number of points, ends included", at_least(2));
}

std::vector<std::string> FluidPoints::columns(const Fluid& fluid) {
  std::vector<std::string> names = {"velocity_x", "velocity_y", "velocity_z", "pressure", "void_fraction"};
  for (const auto& scalar : fluid.scalars()) names.push_back(scalar.name);
  return names;
}

FluidPoints::FluidPoints(const Mesh& mesh, const Locator& locator, std::vector<Vec3> points, const std::string& owner)
    : mesh_(mesh), points_(std::move(points)), places_(locator.claim(points_)) {
  for (size_t k = 0; k < points_.size(); ++k)
    if (!mpi_any(places_[k].inside()))
      throw UserError(
          fmt::format("{}: the point ({:g}, {:g}, {:g}) lies outside the mesh, which spans ({:g}, {:g}, {:g}) to "
                      "({:g}, {:g}, {:g})",
                      owner, points_[k][0], points_[k][1], points_[k][2], mesh.lower[0], mesh.lower[1], mesh.lower[2],
                      mesh.upper[0], mesh.upper[1], mesh.upper[2]));
}

std::vector<double> FluidPoints::sample(const Fluid& fluid) const {
  const auto scalars = fluid.scalars();
  const size_t width = 5 + scalars.size();
  const auto u = fluid.velocity(), p = fluid.pressure();
  const auto& alpha = fluid.load().void_fraction;
  std::vector<double> values(width * points_.size(), 0.0);
  for (size_t k = 0; k < points_.size(); ++k) {
    if (!places_[k].inside()) continue;
    double N[8], dN[8][3];
    shape(mesh_.cell, places_[k].xi.data(), N, dN);
    const int* node = &mesh_.cell_nodes[static_cast<size_t>(places_[k].cell) * mesh_.nodes_per_cell];
    double* value = &values[width * k];
    for (int a = 0; a < mesh_.nodes_per_cell; ++a) {
      for (size_t d = 0; d < 3; ++d) value[d] += N[a] * u[3 * static_cast<size_t>(node[a]) + d];
      value[3] += N[a] * p[node[a]];
      value[4] += N[a] * alpha[node[a]];
      for (size_t s = 0; s < scalars.size(); ++s) value[5 + s] += N[a] * scalars[s].values[node[a]];
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  return values;
}

Probes::Probes(const Mesh& mesh, Options& options, const Fluid* fluid) {
  const auto probe_names = options.names("probe", Options::declared<ProbeOptions>());
  const auto line_names = options.names("line", Options::declared<LineOptions>());
  if (probe_names.empty() && line_names.empty()) return;
  if (!fluid) throw UserError("-probe_... and -line_... record the fluid, and -fluid_type is none");
  columns_ = FluidPoints::columns(*fluid);
  locator_ = std::make_unique<Locator>(mesh);
  for (const auto& name : probe_names) {
    ProbeOptions probe;
    options.read("probe_" + name, probe);
    probes_.push_back({name, FluidPoints(mesh, *locator_, {probe.point}, "-probe_" + name + "_point"), {}, {}});
  }
  for (const auto& name : line_names) {
    LineOptions line;
    options.read("line_" + name, line);
    std::vector<Vec3> points(line.points);
    for (int k = 0; k < line.points; ++k) points[k] = line.from + (line.to - line.from) * k / (line.points - 1.0);
    lines_.push_back({name, FluidPoints(mesh, *locator_, std::move(points), "-line_" + name), {}, {}});
  }
}

void Probes::start(const OutputDirectory& directory) {
  std::vector<std::string> head = {"time"}, line_head = {"time", "distance", "x", "y", "z"};
  head.insert(head.end(), columns_.begin(), columns_.end());
  line_head.insert(line_head.end(), columns_.begin(), columns_.end());
  for (auto& probe : probes_) probe.table = directory.table("probe_" + probe.name + ".csv", head);
  for (auto& line : lines_) line.table = directory.table("line_" + line.name + ".csv", line_head);
}

void Probes::sample(const Moment& moment, Quantities& quantities) {
  for (auto& probe : probes_) {
    probe.last = probe.points.sample(*moment.fluid);
    for (size_t c = 0; c < probe.last.size(); ++c) quantities.set(probe.name + "." + columns_[c], probe.last[c]);
    std::vector<double> row = {moment.time};
    row.insert(row.end(), probe.last.begin(), probe.last.end());
    probe.table.row(row);
  }
}

void Probes::write_lines(const Moment& moment) {
  const size_t width = columns_.size();
  for (auto& line : lines_) {
    line.last = line.points.sample(*moment.fluid);
    const auto& points = line.points.points();
    std::vector<double> rows;
    for (size_t k = 0; k < points.size(); ++k) {
      for (double value : {moment.time, (points[k] - points[0]).norm(), points[k][0], points[k][1], points[k][2]})
        rows.push_back(value);
      rows.insert(rows.end(), &line.last[width * k], &line.last[width * k] + width);
    }
    line.table.row(rows);
  }
}

std::vector<std::string> Probes::columns() const {
  std::vector<std::string> names;
  for (const auto& probe : probes_)
    for (const auto& column : columns_) names.push_back(probe.name + "." + column);
  return names;
}

std::vector<std::string> Probes::line_columns() const {
  std::vector<std::string> names;
  for (const auto& line : lines_)
    for (const auto& column : columns_) names.push_back(line.name + "." + column);
  return names;
}

std::vector<double> Probes::line(const std::string& column) const {
  const auto& names = columns_;
  std::vector<double> values;
  for (const auto& item : lines_)
    for (size_t c = 0; c < names.size(); ++c)
      if (item.name + "." + names[c] == column)
        for (size_t k = c; k < item.last.size(); k += names.size()) values.push_back(item.last[k]);
  return values;
}

double Probes::spacing(const std::string& column) const {
  for (const auto& item : lines_)
    if (column.starts_with(item.name + ".")) return (item.points.points()[1] - item.points.points()[0]).norm();
  return 0;
}

}  // namespace silt
