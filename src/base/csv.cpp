#include "base/csv.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "base/error.hpp"
#include "base/hdf5_file.hpp"
#include "base/petsc.hpp"

namespace silt {

std::string csv_number(double value) { return std::isnan(value) ? "nan" : fmt::format("{:.12g}", value); }

namespace {

/// The rows of a table up to a time, each with its line end, header first; nothing when there is no such table. A torn
/// last line is left out.
std::string rows_until(const std::string& path, double time) {
  std::ifstream file(path);
  std::string kept, line;
  for (bool header = true; std::getline(file, line) && !file.eof(); header = false)
    if (header || std::strtod(line.c_str(), nullptr) <= time * (1 + 1e-9)) kept += line + "\n";
  return kept;
}

}  // namespace

CsvWriter::CsvWriter(const std::string& path, const std::vector<std::string>& columns, std::optional<double> resumed)
    : path_(path), columns_(columns.size()) {
  const std::string header = fmt::format("{}\n", fmt::join(columns, ","));
  std::string start = header;
  int other = 0;
  if (resumed && mpi_rank() == 0) {
    const std::string kept = rows_until(path, *resumed);
    other = !kept.empty() && kept.compare(0, header.size(), header) != 0;
    if (!kept.empty()) start = kept;
  }
  MPI_Bcast(&other, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (other)
    throw RunError(
        fmt::format("{} has other columns than this run: it cannot go on in this directory, give another "
                    "-output_directory",
                    path));
  if (resumed) write_text(path, start);
  if (mpi_rank() == 0)
    file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | (resumed ? 0 : O_TRUNC) | O_APPEND | O_CLOEXEC, 0666);
  append(resumed ? "" : header);
}

CsvWriter::~CsvWriter() {
  if (file_ >= 0) ::close(file_);
}

CsvWriter::CsvWriter(CsvWriter&& other) noexcept { *this = std::move(other); }

CsvWriter& CsvWriter::operator=(CsvWriter&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(columns_, other.columns_);
  std::swap(file_, other.file_);
  return *this;
}

void CsvWriter::row(std::span<const double> values) {
  std::string text;
  if (mpi_rank() == 0)
    for (std::size_t k = 0; k < values.size(); ++k)
      text += csv_number(values[k]) + ((k + 1) % columns_ == 0 ? '\n' : ',');
  append(text);
}

void CsvWriter::append(const std::string& text) {
  // One write a row: a killed run leaves no torn row.
  int error = 0;
  if (mpi_rank() == 0) {
    if (file_ < 0) error = errno;
    for (std::size_t done = 0; done < text.size() && error == 0;) {
      const ssize_t written = ::write(file_, text.data() + done, text.size() - done);
      if (written < 0 && errno != EINTR) error = errno;
      if (written > 0) done += static_cast<std::size_t>(written);
    }
  }
  MPI_Bcast(&error, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (error != 0) throw RunError(fmt::format("cannot write {}: {}", path_, std::strerror(error)));
}

}  // namespace silt
