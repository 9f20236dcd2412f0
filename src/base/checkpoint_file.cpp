#include "base/checkpoint_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "base/error.hpp"
#include "base/petsc.hpp"

namespace silt {
namespace {

constexpr const char* format_name = "silt checkpoint 2";

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

/// Sum over rows, so that it does not depend on who holds which.
std::uint64_t checksum(const void* values, long long first, long long rows, int components) {
  std::uint64_t sum = 0, word;
  const char* at = static_cast<const char*>(values);
  for (long long r = 0; r < rows; ++r) {
    std::uint64_t hash = mix(static_cast<std::uint64_t>(first + r) + 0x9E3779B97F4A7C15ull);
    for (int c = 0; c < components; ++c, at += sizeof word) {
      std::memcpy(&word, at, sizeof word);
      hash = mix(hash ^ word) + 0x9E3779B97F4A7C15ull;
    }
    sum += hash;
  }
  return sum;
}

std::uint64_t sum_of_all(std::uint64_t mine) {
  MPI_Allreduce(MPI_IN_PLACE, &mine, 1, MPI_UINT64_T, MPI_SUM, PETSC_COMM_WORLD);
  return mine;
}

/// Closes an HDF5 object at the end of its scope.
struct Object {
  hid_t id;
  herr_t (*close)(hid_t);
  Object(hid_t i, herr_t (*c)(hid_t)) : id(i), close(c) {}
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  ~Object() {
    if (id >= 0) close(id);
  }
  operator hid_t() const { return id; }
};

/// A text of the file; nothing when it is not there.
std::string text_of(hid_t file, const std::string& name) {
  if (H5Lexists(file, name.c_str(), H5P_DEFAULT) <= 0) return {};
  const Object set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (set < 0) return {};
  const Object type(H5Dget_type(set), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING) return {};
  std::string text(H5Tget_size(type), ' ');
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return {};
  return text.substr(0, text.find('\0'));
}

}  // namespace

void CheckpointWriter::add(const std::string& name, int components, std::vector<double> values) {
  numbers_.push_back(std::move(values));
  sets_.push_back({name, components, std::span<const double>(numbers_.back())});
}

void CheckpointWriter::add(const std::string& name, int components, std::vector<std::int64_t> values) {
  wholes_.push_back(std::move(values));
  sets_.push_back({name, components, std::span<const std::int64_t>(wholes_.back())});
}

void CheckpointWriter::write(const std::string& path) const {
  std::string manifest = std::string(format_name) + "\n";
  for (const Dataset& set : sets_) {
    const auto mine = static_cast<long long>(set.local_rows());
    long long first = 0;
    MPI_Exscan(&mine, &first, 1, MPI_LONG_LONG, MPI_SUM, PETSC_COMM_WORLD);
    if (mpi_rank() == 0) first = 0;
    const void* data = std::visit([](const auto& span) { return static_cast<const void*>(span.data()); }, set.values);
    const std::uint64_t sum = sum_of_all(checksum(data, first, mine, set.components));
    manifest += fmt::format("{} {} {} {} {:016x}\n", set.name, set.whole_numbers() ? "whole" : "number", set.components,
                            mpi_sum(mine), sum);
  }
  std::vector<Attribute> notes = notes_;
  notes.push_back({"manifest", manifest});
  write_hdf5(path, sets_, notes);
}

void CheckpointReader::refuse(const std::string& what) const {
  throw UserError(fmt::format("option -restart: '{}' {}", path_, what));
}

CheckpointReader::CheckpointReader(const std::string& path) : path_(path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  if (mpi_any(!std::filesystem::is_regular_file(path))) refuse("does not exist");
  std::string manifest;
  bool opened = false;
  {
    const Object file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    opened = file >= 0;
    if (opened) manifest = text_of(file, "manifest");
  }
  if (mpi_any(!opened)) refuse("is no HDF5 file, or a damaged one");
  std::istringstream lines(manifest);
  std::string line;
  std::getline(lines, line);
  if (mpi_any(line != format_name)) refuse("is no checkpoint of this version of Silt");
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    Array array;
    words >> array.name >> array.kind >> array.components >> array.rows >> std::hex >> array.checksum;
    if (!words) refuse("is damaged: its list of arrays cannot be read");
    arrays_.push_back(array);
  }
  check_sums();
}

void CheckpointReader::check_sums() const {
  const long long size = mpi_size(), rank = mpi_rank();
  for (const Array& array : arrays_) {
    const long long first = array.rows * rank / size, count = array.rows * (rank + 1) / size - first;
    std::vector<std::uint64_t> words(static_cast<std::size_t>(count) * array.components);
    read(array, first, count, words.data());
    if (sum_of_all(checksum(words.data(), first, count, array.components)) != array.checksum)
      refuse(fmt::format("is damaged: the numbers of {} are not those that were written", array.name));
  }
}

const CheckpointReader::Array& CheckpointReader::array(const std::string& name) const {
  for (const Array& array : arrays_)
    if (array.name == name) return array;
  refuse(fmt::format("has no array {}", name));
}

bool CheckpointReader::has(const std::string& name) const {
  for (const Array& array : arrays_)
    if (array.name == name) return true;
  return false;
}

long long CheckpointReader::rows(const std::string& name) const { return array(name).rows; }
int CheckpointReader::components(const std::string& name) const { return array(name).components; }

void CheckpointReader::read(const Array& array, long long first, long long count, void* to) const {
  bool good = false;
  {
    const Object file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const Object set(file < 0 ? -1 : H5Dopen2(file, array.name.c_str(), H5P_DEFAULT), H5Dclose);
    const Object space(set < 0 ? -1 : H5Dget_space(set), H5Sclose);
    hsize_t size[2] = {0, 1};
    const int dimensions = space < 0 ? 0 : H5Sget_simple_extent_ndims(space);
    if (dimensions == 1 || dimensions == 2) H5Sget_simple_extent_dims(space, size, nullptr);
    good = size[0] == static_cast<hsize_t>(array.rows) && size[1] == static_cast<hsize_t>(array.components);
    if (good && count > 0) {
      const hsize_t start[2] = {static_cast<hsize_t>(first), 0}, extent[2] = {static_cast<hsize_t>(count), size[1]};
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, extent, nullptr);
      const Object memory(H5Screate_simple(dimensions, extent, nullptr), H5Sclose);
      good = H5Dread(set, array.kind == "whole" ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT,
                     to) >= 0;
    }
  }
  if (mpi_any(!good)) refuse(fmt::format("is damaged: {} cannot be read", array.name));
}

std::vector<double> CheckpointReader::numbers(const std::string& name, long long first, long long count) const {
  const Array& from = array(name);
  std::vector<double> values(static_cast<std::size_t>(count) * from.components);
  if (from.kind != "number") refuse(fmt::format("is damaged: {} should hold numbers", name));
  read(from, first, count, values.data());
  return values;
}

std::vector<std::int64_t> CheckpointReader::wholes(const std::string& name, long long first, long long count) const {
  const Array& from = array(name);
  std::vector<std::int64_t> values(static_cast<std::size_t>(count) * from.components);
  if (from.kind != "whole") refuse(fmt::format("is damaged: {} should hold whole numbers", name));
  read(from, first, count, values.data());
  return values;
}

double CheckpointReader::number(const std::string& note) const {
  double value = 0;
  bool good = false;
  {
    const Object file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const Object attribute(
        file < 0 || H5Aexists(file, note.c_str()) <= 0 ? -1 : H5Aopen(file, note.c_str(), H5P_DEFAULT), H5Aclose);
    good = attribute >= 0 && H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;
  }
  if (mpi_any(!good)) refuse(fmt::format("is damaged: {} is missing", note));
  return value;
}

std::string CheckpointReader::text(const std::string& note) const {
  const Object file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  return file < 0 ? "" : text_of(file, note);
}

}  // namespace silt
