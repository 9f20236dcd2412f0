#include "app/output.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/version.hpp"

namespace silt {

Output::Output(const Mesh& mesh, Options& options, bool with_fluid, bool with_particles, const std::string& checkpoint)
    : mesh_(mesh), with_fluid_(with_fluid), with_particles_(with_particles) {
  OutputOptions output;
  options.read("output", output);
  directory_ = std::make_unique<OutputDirectory>(output, checkpoint);
}

void Output::start(const std::string& record) {
  directory_->prepare(record);
  open_series(record);
}

void Output::resume(const std::string& record, double time) {
  directory_->resume(record, time);
  open_series(record);
  last_ = time;
}

void Output::open_series(const std::string& record) {
  if (with_fluid_) fluid_ = std::make_unique<FluidSeries>(*directory_, mesh_, record);
  if (with_particles_) particles_ = std::make_unique<ParticleSeries>(*directory_, record);
}

double Output::next(double time) const {
  const double interval = directory_->options().interval;
  if (interval <= 0) return infinity;
  return interval * (std::floor(time / interval * (1 + 1e-12) + 1e-9) + 1);
}

bool Output::due(double time) const {
  const double interval = directory_->options().interval;
  if (last_ < 0) return true;  // the first
  if (interval <= 0) return false;
  return std::abs(time / interval - std::round(time / interval)) < 1e-9 * std::max(1.0, time / interval);
}

void Output::write(const Moment& moment) {
  if (moment.time == last_) return;
  last_ = moment.time;
  if (fluid_) {
    std::vector<NodeField> fields = {{"velocity", 3, moment.fluid->velocity()},
                                     {"pressure", 1, moment.fluid->pressure()}};
    for (const auto& scalar : moment.fluid->scalars()) fields.push_back({scalar.name, 1, scalar.values});
    if (with_particles_) fields.push_back({"void_fraction", 1, moment.fluid->load().void_fraction});
    fluid_->write(moment.time, fields);
  }
  if (!particles_) return;
  const Particles& particles = *moment.particles;
  const int count = particles.owned();
  std::vector<double> position, velocity, spin, radius;
  std::vector<std::int64_t> id, material, rank(static_cast<size_t>(count), mpi_rank());
  for (int i = 0; i < count; ++i) {
    for (int d = 0; d < 3; ++d) {
      position.push_back(particles.position(i)[d]);
      velocity.push_back(particles.velocity(i)[d]);
      spin.push_back(particles.spin(i)[d]);
    }
    radius.push_back(particles.radius(i));
    id.push_back(particles.id(i));
    material.push_back(particles.material(i));
  }
  const auto reals = [](const char* name, int components, const std::vector<double>& values) {
    return Dataset{name, components, std::span<const double>(values)};
  };
  const auto wholes = [](const char* name, const std::vector<std::int64_t>& values) {
    return Dataset{name, 1, std::span<const std::int64_t>(values)};
  };
  std::vector<Dataset> arrays = {reals("position", 3, position),
                                 reals("velocity", 3, velocity),
                                 reals("spin", 3, spin),
                                 reals("radius", 1, radius),
                                 wholes("id", id),
                                 wholes("material", material),
                                 wholes("rank", rank)};
  const Columns& columns = particles.columns();
  for (int c = 0; c < columns.count(); ++c) {
    const ColumnRequest& column = columns.request(c);
    if (column.output)
      arrays.push_back(
          {column.name, column.width, std::span(columns.values(c), static_cast<size_t>(count) * column.width)});
  }
  particles_->write(moment.time, std::move(arrays));
}

std::string record_of(const Options& options) {
  std::string text = fmt::format("# silt {}, {} rank{}; what stands behind # was not given and is the default\n",
                                 version, mpi_size(), mpi_size() == 1 ? "" : "s");
  const auto quoted = [](std::string value) {
    for (size_t at = 0; (at = value.find('\'', at)) != std::string::npos; at += 2) value.insert(at, 1, '\'');
    return fmt::format("'{}'", value);
  };
  for (const auto& entry : options.entries()) {
    std::string value = entry.given ? entry.value : entry.fallback;
    if (entry.given && entry.type == "yes/no" && value.empty()) value = "yes";  // a switch
    if (value.empty() && !entry.given) continue;
    const bool plain =
        entry.type == "number" || entry.type == "integer" || entry.type == "yes/no" || entry.type == "word";
    text += fmt::format("{}{}: {}\n", entry.given ? "" : "# ", entry.name, plain ? value : quoted(value));
  }
  for (const auto& [name, value] : options.undeclared()) text += fmt::format("{}: {}\n", name, quoted(value));
  return text;
}

}  // namespace silt
