#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/vector.hpp"

namespace silt {

/// One particle as a file gives it.
struct FileParticle {
  Vec3 position = Vec3::Zero();
  double radius = 0;
  std::optional<Vec3> velocity, spin;
  int material = -1;  ///< index into the materials, -1 when the file does not say
  int line = 0;       ///< of a text file, else the number of the particle, from 1
};

/// Reads a CSV file. Its first line that is neither empty nor a comment (#) names the columns, in any order: x, y, z,
/// diameter or radius, and possibly vx, vy, vz, wx, wy, wz, material (a name). SI units. Throws UserError naming file,
/// line and column. Local.
std::vector<FileParticle> read_csv_particles(const std::string& file, const std::vector<std::string>& materials);

/// Reads the group /particles of an HDF5 file: position [n][3], radius [n], and possibly velocity [n][3], spin [n][3],
/// material [n] (index), as particle output has them. Throws UserError naming file, dataset and row. Local.
std::vector<FileParticle> read_hdf5_particles(const std::string& file, const std::vector<std::string>& materials);

/// Reads a file of either kind (by its ending: .csv, .txt; .h5, .hdf5) on one rank and gives it to all. Collective.
std::vector<FileParticle> read_particle_file(const std::string& option, const std::string& file,
                                             const std::vector<std::string>& materials);

}  // namespace silt
