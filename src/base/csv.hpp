#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace silt {

/// A table in a CSV file that grows by a row at a time; every row is in the file when the call returns, whole.
class CsvWriter {
 public:
  CsvWriter() = default;
  /// Starts the file with its header line. With `resumed`, a file of the same columns that is there goes on after its
  /// rows up to that time (the first column). Rank 0 writes; the others follow. Throws RunError on every rank.
  /// Collective.
  CsvWriter(const std::string& path, const std::vector<std::string>& columns, std::optional<double> resumed = {});
  ~CsvWriter();
  CsvWriter(CsvWriter&& other) noexcept;
  CsvWriter& operator=(CsvWriter&& other) noexcept;

  /// Appends one row, or several when the values are a multiple of the columns. Only rank 0's values count. Collective.
  void row(std::span<const double> values);

 private:
  void append(const std::string& text);
  std::string path_;
  std::size_t columns_ = 0;
  int file_ = -1;
};

/// A number as it stands in our text files: twelve digits, as short as they allow.
std::string csv_number(double value);

}  // namespace silt
