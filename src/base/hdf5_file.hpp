#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace silt {

/// One array of a file: this rank's rows of `components` numbers each. The rows of all ranks stand in the file one
/// after the other, in the order of ranks; a rank may have none.
struct Dataset {
  std::string name;
  int components = 1;
  std::variant<std::span<const double>, std::span<const std::int64_t>> values;
  bool single_precision = false;  ///< store doubles as 4-byte numbers

  std::size_t local_rows() const;
  bool whole_numbers() const { return values.index() == 1; }
  int bytes() const { return whole_numbers() || !single_precision ? 8 : 4; }
};

/// A value that describes the file as a whole.
struct Attribute {
  std::string name;
  std::variant<double, std::string> value;
};

/// Writes a whole HDF5 file, by all ranks together, so that it is there complete or not at all: under a temporary name,
/// to the disk, then renamed. Throws RunError on every rank (disk full, no permission ...); a file of that name from
/// before is then untouched. Returns the rows of each dataset over all ranks. Collective.
std::vector<long long> write_hdf5(const std::string& path, const std::vector<Dataset>& datasets,
                                  const std::vector<Attribute>& attributes);

/// Writes a whole text file in the same way, by rank 0. Throws RunError on every rank. Collective.
void write_text(const std::string& path, const std::string& text);

}  // namespace silt
