#include <fmt/format.h>
#include <hdf5.h>

#include <cmath>

#include "base/error.hpp"
#include "particles/insertion/particle_file.hpp"

namespace silt {
namespace {

/// Closes an HDF5 object at the end of its scope.
struct Hdf5 {
  hid_t id;
  herr_t (*close)(hid_t);
  Hdf5(hid_t id_, herr_t (*close_)(hid_t)) : id(id_), close(close_) {}
  Hdf5(const Hdf5&) = delete;
  Hdf5& operator=(const Hdf5&) = delete;
  ~Hdf5() {
    if (id >= 0) close(id);
  }
};

/// Keeps HDF5 from printing its error stack: errors are ours to report.
struct Silence {
  H5E_auto2_t function = nullptr;
  void* data = nullptr;
  Silence() {
    H5Eget_auto2(H5E_DEFAULT, &function, &data);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Silence() { H5Eset_auto2(H5E_DEFAULT, function, data); }
};

/// A dataset of /particles as doubles, `components` a row; empty when it is not there and need not be. `rows`: expected
/// number of rows, or < 0 to set it.
std::vector<double> read_rows(const std::string& file, hid_t group, const char* name, int components, long long& rows,
                              bool needed) {
  if (H5Lexists(group, name, H5P_DEFAULT) <= 0) {
    if (needed) throw UserError(fmt::format("{}: dataset /particles/{} is missing", file, name));
    return {};
  }
  const Hdf5 set(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  if (set.id < 0) throw UserError(fmt::format("{}: /particles/{} is not a dataset", file, name));
  const Hdf5 space(H5Dget_space(set.id), H5Sclose);
  hsize_t size[2] = {0, 1};
  const int rank = H5Sget_simple_extent_ndims(space.id);
  const bool shaped = rank == 2 || (rank == 1 && components == 1);
  if (shaped) H5Sget_simple_extent_dims(space.id, size, nullptr);
  if (!shaped || size[1] != static_cast<hsize_t>(components))
    throw UserError(fmt::format("{}: dataset /particles/{} must have the shape [n]{}", file, name,
                                components == 1 ? "" : fmt::format("[{}]", components)));
  if (rows < 0) rows = static_cast<long long>(size[0]);
  if (rows != static_cast<long long>(size[0]))
    throw UserError(
        fmt::format("{}: dataset /particles/{} has {} rows where position has {}", file, name, size[0], rows));
  std::vector<double> values(size[0] * size[1]);
  if (!values.empty() && H5Dread(set.id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw UserError(fmt::format("{}: dataset /particles/{} does not hold numbers", file, name));
  for (size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      throw UserError(
          fmt::format("{}: dataset /particles/{}, row {}: not a finite number", file, name, k / components + 1));
  return values;
}

}  // namespace

std::vector<FileParticle> read_hdf5_particles(const std::string& file, const std::vector<std::string>& materials) {
  const Silence silence;
  const Hdf5 handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (handle.id < 0) throw UserError(fmt::format("particle file '{}' is not an HDF5 file that can be read", file));
  // An output of a run has the arrays at its top.
  const bool grouped = H5Lexists(handle.id, "particles", H5P_DEFAULT) > 0;
  const bool plain = !grouped && H5Lexists(handle.id, "position", H5P_DEFAULT) > 0;
  const Hdf5 group(grouped ? H5Gopen2(handle.id, "particles", H5P_DEFAULT)
                   : plain ? H5Gopen2(handle.id, "/", H5P_DEFAULT)
                           : -1,
                   H5Gclose);
  if (group.id < 0)
    throw UserError(fmt::format("{}: there is neither a group /particles nor a dataset /position", file));
  long long rows = -1;
  const auto position = read_rows(file, group.id, "position", 3, rows, true);
  const auto radius = read_rows(file, group.id, "radius", 1, rows, true);
  const auto velocity = read_rows(file, group.id, "velocity", 3, rows, false);
  const auto spin = read_rows(file, group.id, "spin", 3, rows, false);
  const auto material = read_rows(file, group.id, "material", 1, rows, false);
  std::vector<FileParticle> particles(rows);
  for (long long k = 0; k < rows; ++k) {
    FileParticle& particle = particles[k];
    particle.line = static_cast<int>(k + 1);
    particle.position = vec3(&position[3 * k]);
    particle.radius = radius[k];
    if (!(radius[k] > 0))
      throw UserError(fmt::format("{}: dataset /particles/radius, row {}: must be above 0", file, k + 1));
    if (!velocity.empty()) particle.velocity = vec3(&velocity[3 * k]);
    if (!spin.empty()) particle.spin = vec3(&spin[3 * k]);
    if (!material.empty()) {
      if (material[k] < 0 || material[k] >= static_cast<double>(materials.size()))
        throw UserError(fmt::format("{}: dataset /particles/material, row {}: {:g} is not one of the {} materials",
                                    file, k + 1, material[k], materials.size()));
      particle.material = static_cast<int>(material[k]);
    }
  }
  return particles;
}

}  // namespace silt
