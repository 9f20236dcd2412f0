#include "particles/insertion/particle_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "base/error.hpp"
#include "base/petsc.hpp"

namespace silt {
namespace {

constexpr int stride = 14;  // doubles that carry a particle to the other ranks

void pack(const std::vector<FileParticle>& particles, std::vector<double>& values) {
  for (const auto& p : particles) {
    const Vec3 v = p.velocity.value_or(Vec3::Zero()), w = p.spin.value_or(Vec3::Zero());
    const double kinds = (p.velocity ? 1 : 0) + (p.spin ? 2 : 0);
    for (double value : {p.position[0], p.position[1], p.position[2], p.radius, v[0], v[1], v[2], w[0], w[1], w[2],
                         kinds, static_cast<double>(p.material), static_cast<double>(p.line), 0.0})
      values.push_back(value);
  }
}

std::vector<FileParticle> unpack(const std::vector<double>& values) {
  std::vector<FileParticle> particles(values.size() / stride);
  for (size_t k = 0; k < particles.size(); ++k) {
    const double* p = &values[k * stride];
    particles[k].position = vec3(p);
    particles[k].radius = p[3];
    const int kinds = static_cast<int>(p[10]);
    if (kinds & 1) particles[k].velocity = vec3(p + 4);
    if (kinds & 2) particles[k].spin = vec3(p + 7);
    particles[k].material = static_cast<int>(p[11]);
    particles[k].line = static_cast<int>(p[12]);
  }
  return particles;
}

}  // namespace

std::vector<FileParticle> read_particle_file(const std::string& option, const std::string& file,
                                             const std::vector<std::string>& materials) {
  std::vector<double> values;
  std::string mistake;
  if (mpi_rank() == 0) {
    try {
      const std::string ending = std::filesystem::path(file).extension();
      if (file.empty()) throw UserError(fmt::format("option -{} is missing", option));
      if (!std::filesystem::is_regular_file(file))
        throw UserError(fmt::format("option -{}: '{}' does not exist", option, file));
      if (ending == ".csv" || ending == ".txt")
        pack(read_csv_particles(file, materials), values);
      else if (ending == ".h5" || ending == ".hdf5")
        pack(read_hdf5_particles(file, materials), values);
      else
        throw UserError(fmt::format("option -{}: '{}' must end in .csv, .txt, .h5 or .hdf5", option, file));
    } catch (const UserError& error) {
      mistake = error.what();
    }
  }
  long long sizes[2] = {static_cast<long long>(mistake.size()), static_cast<long long>(values.size())};
  MPI_Bcast(sizes, 2, MPI_LONG_LONG, 0, PETSC_COMM_WORLD);
  mistake.resize(sizes[0]);
  values.resize(sizes[1]);
  MPI_Bcast(mistake.data(), static_cast<int>(sizes[0]), MPI_CHAR, 0, PETSC_COMM_WORLD);
  if (!mistake.empty()) throw UserError(mistake);
  constexpr long long block = 1 << 28;  // MPI counts are ints
  for (long long first = 0; first < sizes[1]; first += block)
    MPI_Bcast(values.data() + first, static_cast<int>(std::min(block, sizes[1] - first)), MPI_DOUBLE, 0,
              PETSC_COMM_WORLD);
  return unpack(values);
}

}  // namespace silt
