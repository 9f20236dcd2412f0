#include "app/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/nodal_matrix.hpp"

namespace silt {
namespace {

const std::vector<std::string> step_columns = {"time", "dt", "step", "ledger_residual"};
const std::vector<std::string> fluid_columns = {"courant",
                                                "velocity_iterations",
                                                "pressure_iterations",
                                                "newton_iterations",
                                                "mass_residual",
                                                "pressure_drop",
                                                "inflow",
                                                "outflow",
                                                "fluid_kinetic_energy",
                                                "largest_fluid_speed",
                                                "least_void_fraction",
                                                "mean_void_fraction",
                                                "fluid_velocity_x",
                                                "fluid_velocity_y",
                                                "fluid_velocity_z"};
const std::vector<std::string> particle_columns = {"particles",
                                                   "removed",
                                                   "substeps",
                                                   "contacts",
                                                   "largest_overlap",
                                                   "fabric_x",
                                                   "fabric_y",
                                                   "fabric_z",
                                                   "bed_height",
                                                   "bed_height_95",
                                                   "bed_solids",
                                                   "particle_kinetic_energy",
                                                   "particle_rotational_energy",
                                                   "largest_particle_speed",
                                                   "particle_position_x",
                                                   "particle_position_y",
                                                   "particle_position_z",
                                                   "particle_velocity_x",
                                                   "particle_velocity_y",
                                                   "particle_velocity_z"};
const std::vector<std::string> drive_columns = {"drive_pressure_gradient", "drive_velocity"};
const std::vector<std::string> heat_columns = {"fluid_heat", "energy_iterations", "least_temperature",
                                               "mean_temperature", "largest_temperature"};
const std::vector<std::string> gas_columns = {"first_order"};
const std::vector<std::string> flow_columns = {"volume_flow", "mass_flow", "pressure", "force_x", "force_y", "force_z"};

constexpr int height_bins = 1024;

void append(std::vector<std::string>& to, const std::vector<std::string>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

double facet_area(const Mesh& mesh, const BoundaryFacet& facet) {
  const auto x = mesh.facet_corners(facet);
  if (mesh.dimension == 2) return (x[1] - x[0]).norm();
  const double half = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
  return mesh.cell == Cell::tetrahedron ? half : half + 0.5 * (x[2] - x[0]).cross(x[3] - x[0]).norm();
}

}  // namespace

Diagnostics::Diagnostics(const Mesh& mesh, Options& options, const Vec3& gravity, const Fluid* fluid,
                         const Particles* particles)
    : mesh_(mesh),
      up_(gravity.norm() > 0 ? Vec3(-gravity.normalized()) : Vec3::Unit(mesh.dimension - 1)),
      with_fluid_(fluid != nullptr),
      with_heat_(fluid && !fluid->temperature().empty()),
      with_gas_(fluid && fluid->total_energy()),
      with_drive_(fluid && fluid->driven()),
      with_particles_(particles != nullptr),
      columns_(step_columns) {
  if (with_fluid_) append(columns_, fluid_columns);
  if (with_drive_) append(columns_, drive_columns);
  if (with_heat_) append(columns_, heat_columns);
  if (with_gas_) append(columns_, gas_columns);
  if (particles) {
    append(columns_, particle_columns);
    const Columns& columns = particles->columns();
    for (int c = 0; c < columns.count(); ++c) {
      const ColumnRequest& column = columns.request(c);
      if (!column.output) continue;
      carried_.push_back(c);
      for (int k = 0; k < column.width; ++k)
        columns_.push_back(fmt::format("mean_{}_of_particles{}", column.name,
                                       column.width == 1   ? ""
                                       : column.width == 3 ? fmt::format("_{}", "xyz"[k])
                                                           : fmt::format("_{}", k)));
    }
  }
  bottom_ = 0;
  double top = 0;
  for (int d = 0; d < 3; ++d) {
    bottom_ += std::min(up_[d] * mesh.lower[d], up_[d] * mesh.upper[d]);
    top += std::max(up_[d] * mesh.lower[d], up_[d] * mesh.upper[d]);
  }
  height_ = top - bottom_;
  if (!with_fluid_) return;
  mass_ = lumped_mass(mesh);
  area_.assign(mesh.boundaries.size(), 0.0);
  for (const auto& facet : mesh.facets) area_[facet.boundary] += facet_area(mesh, facet);
  for (double& area : area_) area = mpi_sum(area);
  boundary_columns_ = {"time"};
  for (const auto& name : mesh.boundaries) {
    for (const auto& column : flow_columns) boundary_columns_.push_back(name + "." + column);
    if (with_heat_) boundary_columns_.push_back(name + ".heat_flow");
    const std::string type = options.find("boundary_" + name + "_type").value_or("");
    role_.push_back(type == "velocity" || type == "mass_flow" ? 1 : type == "pressure" ? -1 : 0);
  }
}

std::vector<std::string> Diagnostics::columns() const {
  std::vector<std::string> all = columns_;
  if (!boundary_columns_.empty()) all.insert(all.end(), boundary_columns_.begin() + 1, boundary_columns_.end());
  return all;
}

void Diagnostics::start(const OutputDirectory& directory) {
  table_ = directory.table("diagnostics.csv", columns_);
  if (!boundary_columns_.empty()) boundary_table_ = directory.table("boundaries.csv", boundary_columns_);
}

void Diagnostics::sample(const Moment& moment, Quantities& quantities) {
  std::vector<double> row = {moment.time, moment.dt, static_cast<double>(moment.step), moment.ledger_residual};
  std::vector<double> flows = {moment.time};
  if (with_fluid_) measure_fluid(moment, row, flows);
  if (with_particles_) {
    const ParticleStep& step = moment.particle_step;
    for (double value : {static_cast<double>(moment.particles->total()), static_cast<double>(step.removed),
                         static_cast<double>(step.substeps), static_cast<double>(step.contacts), step.largest_overlap,
                         step.fabric[0], step.fabric[1], step.fabric[2]})
      row.push_back(value);
    measure_particles(*moment.particles, row);
  }
  for (size_t k = 0; k < row.size(); ++k) quantities.set(columns_[k], row[k]);
  for (size_t k = 1; k < flows.size(); ++k) quantities.set(boundary_columns_[k], flows[k]);
  table_.row(row);
  if (flows.size() > 1) boundary_table_.row(flows);
}

void Diagnostics::measure_fluid(const Moment& moment, std::vector<double>& row, std::vector<double>& flows) const {
  const Fluid& fluid = *moment.fluid;
  const auto u = fluid.velocity();
  const auto& alpha = fluid.load().void_fraction;
  double fastest = 0, least = 1;
  std::array<double, 5> sum{};      // kinetic energy, int alpha, int alpha u
  std::span<const double> density;  // where it is no constant
  for (const auto& scalar : fluid.scalars())
    if (scalar.name == "density") density = scalar.values;
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    const Map<const Vec3> v = vec3(&u[3 * static_cast<size_t>(i)]);
    const double share = mass_[i] * alpha[i], square = v.squaredNorm();
    sum[0] += 0.5 * share * square * (density.empty() ? fluid.density() : density[i]);
    sum[1] += share;
    for (int d = 0; d < 3; ++d) sum[2 + d] += share * v[d];
    fastest = std::max(fastest, square);
    least = std::min(least, alpha[i]);
  }
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), sum.size(), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);

  const auto boundary = fluid.boundary_flow();
  double given = 0, given_area = 0, outlet = 0, outlet_area = 0, high = -infinity, low = infinity, in = 0, out = 0;
  for (size_t b = 0; b < boundary.size(); ++b) {
    const BoundaryFlow& flow = boundary[b];
    (flow.volume_flow < 0 ? in : out) += std::abs(flow.volume_flow);
    high = std::max(high, flow.mean_pressure);
    low = std::min(low, flow.mean_pressure);
    (role_[b] > 0 ? given : outlet) += role_[b] == 0 ? 0 : area_[b] * flow.mean_pressure;
    (role_[b] > 0 ? given_area : outlet_area) += role_[b] == 0 ? 0 : area_[b];
    for (double value :
         {flow.volume_flow, flow.mass_flow, flow.mean_pressure, flow.force[0], flow.force[1], flow.force[2]})
      flows.push_back(value);
    if (with_heat_) flows.push_back(flow.heat_flow);
  }
  const double drop = given_area > 0 && outlet_area > 0 ? given / given_area - outlet / outlet_area
                      : boundary.empty()                ? 0
                                                        : high - low;
  const FluidStep& step = moment.fluid_step;
  for (double value : {step.courant, static_cast<double>(step.velocity_iterations),
                       static_cast<double>(step.pressure_iterations), static_cast<double>(step.newton_iterations),
                       step.mass_residual, drop, in, out, sum[0], std::sqrt(mpi_max(fastest)), mpi_min(least),
                       sum[1] / mesh_.volume, sum[2] / sum[1], sum[3] / sum[1], sum[4] / sum[1]})
    row.push_back(value);
  if (with_drive_) row.insert(row.end(), {step.drive_gradient, step.drive_velocity});
  if (!with_heat_) return;
  const auto T = fluid.temperature();
  double low_T = infinity, mean = 0, high_T = -infinity;
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    low_T = std::min(low_T, T[i]);
    high_T = std::max(high_T, T[i]);
    mean += mass_[i] * alpha[i] * T[i];
  }
  for (double value : {step.heat, static_cast<double>(step.energy_iterations), mpi_min(low_T), mpi_sum(mean) / sum[1],
                       mpi_max(high_T)})
    row.push_back(value);
  if (with_gas_) row.push_back(step.first_order);
}

void Diagnostics::measure_particles(const Particles& particles, std::vector<double>& row) const {
  const Particles::Totals totals = particles.totals();
  std::vector<double> layers(height_bins, 0.0);  // m3, volume by height
  const double bins = height_bins / height_;
  for (int i = 0; i < particles.owned(); ++i) {
    const int bin = static_cast<int>(bins * (up_.dot(particles.position(i)) - bottom_));
    layers[std::clamp(bin, 0, height_bins - 1)] += particles.volume(i);
  }
  MPI_Allreduce(MPI_IN_PLACE, layers.data(), height_bins, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  const double mass = std::max(totals.mass, 1e-300);
  const Vec3 centre = totals.first_moment / mass, velocity = totals.momentum / mass;
  const double bed = totals.mass > 0 ? 2 * (up_.dot(centre) - bottom_) : 0;
  double below = 0, height_95 = 0;
  for (int k = 0; k < height_bins && below < 0.95 * totals.volume; ++k) {
    const double share = std::min(1.0, (0.95 * totals.volume - below) / std::max(layers[k], 1e-300));
    height_95 = height_ * (k + share) / height_bins;
    below += layers[k];
  }
  const double solids = bed > 0 ? totals.volume / (mesh_.volume / height_ * bed) : 0;
  for (double value : {bed, height_95, solids, totals.kinetic, totals.rotational, totals.fastest, centre[0], centre[1],
                       centre[2], velocity[0], velocity[1], velocity[2]})
    row.push_back(value);
  const Columns& columns = particles.columns();
  for (const int c : carried_) {
    const int width = columns.request(c).width;
    std::vector<double> mean(width, 0.0);
    for (int i = 0; i < particles.owned(); ++i)
      for (int k = 0; k < width; ++k) mean[k] += columns.row(c, i)[k] / static_cast<double>(particles.total());
    MPI_Allreduce(MPI_IN_PLACE, mean.data(), width, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
    row.insert(row.end(), mean.begin(), mean.end());
  }
}

}  // namespace silt
