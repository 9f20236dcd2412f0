#include "base/hdf5_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.hpp"
#include "base/petsc.hpp"

namespace silt {
namespace {

/// Owner of an HDF5 identifier.
class Id {
 public:
  Id(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  ~Id() { close(); }
  /// Closes now; false when that failed (a write that was still in a buffer).
  bool close() {
    const bool good = id_ < 0 || close_(id_) >= 0;
    id_ = -1;
    return good;
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Throws on every rank when any rank has something to complain of; the lowest of those ranks gives the words.
void agree(const std::string& path, const std::string& complaint) {
  const int mine = complaint.empty() ? mpi_size() : mpi_rank();
  int first = mine;
  MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  if (first == mpi_size()) return;
  char words[256] = {};
  complaint.copy(words, sizeof words - 1);
  MPI_Bcast(words, sizeof words, MPI_CHAR, first, PETSC_COMM_WORLD);
  throw RunError(fmt::format("cannot write {}: {}; every output before it is complete", path, words));
}

/// The words of the system in HDF5's pile of messages, or its innermost message.
std::string hdf5_complaint() {
  std::string words;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
        auto& text = *static_cast<std::string*>(data);
        if (text.empty()) text = error->desc ? error->desc : "HDF5 failed";
        return 0;
      },
      &words);
  const std::string mark = "error message = '";
  if (const auto at = words.find(mark); at != std::string::npos)
    words = words.substr(at + mark.size(), words.find('\'', at + mark.size()) - at - mark.size());
  return words.empty() ? "HDF5 failed" : words;
}

/// Sees, before HDF5 is asked, that the file system takes a new file of that size: HDF5 and MPI-IO do not leave a
/// failed file in order, and a full disk is no rare thing.
std::string reserve(const std::string& path, long long bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return std::strerror(errno);
  std::string complaint;
  if (::fallocate(file, 0, 0, bytes) != 0 && errno != EOPNOTSUPP && errno != ENOSYS) complaint = std::strerror(errno);
  ::close(file);
  if (!complaint.empty()) ::unlink(path.c_str());
  return complaint;
}

/// Brings what was written to the disk and gives the file its name.
std::string commit(const std::string& temporary, const std::string& path) {
  const int file = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::strerror(errno);
  std::string complaint;
  if (::fsync(file) != 0) complaint = std::strerror(errno);
  ::close(file);
  if (complaint.empty() && ::rename(temporary.c_str(), path.c_str()) != 0) complaint = std::strerror(errno);
  if (!complaint.empty()) ::unlink(temporary.c_str());
  return complaint;
}

bool write_attribute(hid_t file, const Attribute& attribute) {
  Id space(H5Screate(H5S_SCALAR), H5Sclose);
  if (const double* number = std::get_if<double>(&attribute.value)) {
    Id id(H5Acreate2(file, attribute.name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    return id >= 0 && H5Awrite(id, H5T_NATIVE_DOUBLE, number) >= 0;
  }
  // Text is a dataset: attributes end at 64 kB.
  const auto& text = std::get<std::string>(attribute.value);
  Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(text.size(), 1));
  H5Tset_cset(type, H5T_CSET_UTF8);
  Id id(H5Dcreate2(file, attribute.name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  if (id < 0) return false;
  if (mpi_rank() != 0) H5Sselect_none(space);
  return text.empty() || H5Dwrite(id, type, space, space, H5P_DEFAULT, text.data()) >= 0;
}

bool write_dataset(hid_t file, const Dataset& set, long long first, long long rows, hid_t transfer) {
  const auto width = static_cast<hsize_t>(set.components);
  const hsize_t all[2] = {static_cast<hsize_t>(rows), width}, here[2] = {set.local_rows(), width};
  const hsize_t start[2] = {static_cast<hsize_t>(first), 0};
  const int rank = set.components == 1 ? 1 : 2;
  Id space(H5Screate_simple(rank, all, nullptr), H5Sclose), memory(H5Screate_simple(rank, here, nullptr), H5Sclose);
  Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  const hid_t type = set.whole_numbers() ? H5T_STD_I64LE : set.single_precision ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  Id id(H5Dcreate2(file, set.name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
  if (id < 0) return false;
  if (rows == 0) return true;
  if (here[0] == 0) {
    H5Sselect_none(space);
    H5Sselect_none(memory);
  } else {
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, here, nullptr);
  }
  std::vector<float> shortened;
  const void* values = nullptr;
  hid_t memory_type = H5T_NATIVE_INT64;
  if (set.whole_numbers()) {
    values = std::get<1>(set.values).data();
  } else if (set.single_precision) {
    const auto& numbers = std::get<0>(set.values);
    shortened.assign(numbers.begin(), numbers.end());
    values = shortened.data();
    memory_type = H5T_NATIVE_FLOAT;
  } else {
    values = std::get<0>(set.values).data();
    memory_type = H5T_NATIVE_DOUBLE;
  }
  static const double nothing = 0;
  return H5Dwrite(id, memory_type, memory, space, transfer, values ? values : &nothing) >= 0;
}

}  // namespace

std::size_t Dataset::local_rows() const {
  return std::visit([this](const auto& span) { return span.size() / static_cast<std::size_t>(components); }, values);
}

std::vector<long long> write_hdf5(const std::string& path, const std::vector<Dataset>& datasets,
                                  const std::vector<Attribute>& attributes) {
  const std::string temporary = path + ".part";
  std::vector<long long> local, first(datasets.size()), rows(datasets.size());
  for (const auto& set : datasets) local.push_back(static_cast<long long>(set.local_rows()));
  const int count = static_cast<int>(datasets.size());
  MPI_Exscan(local.data(), first.data(), count, MPI_LONG_LONG, MPI_SUM, PETSC_COMM_WORLD);
  if (mpi_rank() == 0) std::fill(first.begin(), first.end(), 0);
  MPI_Allreduce(local.data(), rows.data(), count, MPI_LONG_LONG, MPI_SUM, PETSC_COMM_WORLD);

  long long bytes = 65536;
  for (int k = 0; k < count; ++k) bytes += rows[k] * datasets[k].components * datasets[k].bytes() + 2048;
  for (const auto& attribute : attributes)
    if (const auto* text = std::get_if<std::string>(&attribute.value)) bytes += static_cast<long long>(text->size());
  agree(path, mpi_rank() == 0 ? reserve(temporary, bytes) : "");

  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  std::string complaint;
  {
    Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
    if (mpi_size() > 1) {
      H5Pset_fapl_mpio(access, PETSC_COMM_WORLD, MPI_INFO_NULL);
      H5Pset_dxpl_mpio(transfer, H5FD_MPIO_COLLECTIVE);
    }
    Id file(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
    if (file < 0) complaint = hdf5_complaint();
    agree(path, complaint);  // nobody goes on into collective writing alone
    for (int k = 0; k < count; ++k)
      if (!write_dataset(file, datasets[k], first[k], rows[k], transfer) && complaint.empty())
        complaint = hdf5_complaint();
    for (const auto& attribute : attributes)
      if (!write_attribute(file, attribute) && complaint.empty()) complaint = hdf5_complaint();
    if (!file.close() && complaint.empty()) complaint = hdf5_complaint();
  }
  agree(path, complaint);
  agree(path, mpi_rank() == 0 ? commit(temporary, path) : "");
  return rows;
}

void write_text(const std::string& path, const std::string& text) {
  std::string complaint;
  if (mpi_rank() == 0) {
    const std::string temporary = path + ".part";
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) {
      complaint = std::strerror(errno);
    } else {
      for (std::size_t done = 0; done < text.size() && complaint.empty();) {
        const ssize_t written = ::write(file, text.data() + done, text.size() - done);
        if (written < 0 && errno != EINTR) complaint = std::strerror(errno);
        if (written > 0) done += static_cast<std::size_t>(written);
      }
      ::close(file);
      if (complaint.empty()) complaint = commit(temporary, path);
    }
    if (!complaint.empty()) ::unlink(temporary.c_str());
  }
  agree(path, complaint);
}

}  // namespace silt
