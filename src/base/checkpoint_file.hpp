#pragma once
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "base/hdf5_file.hpp"

namespace silt {

/// A checkpoint as it is put together: named arrays, of which every rank adds its rows, and notes. Written whole or not
/// at all, with a checksum for every array.
class CheckpointWriter {
 public:
  void add(const std::string& name, int components, std::vector<double> values);
  void add(const std::string& name, int components, std::vector<std::int64_t> values);
  /// The same on every rank.
  void note(const std::string& name, double value) { notes_.push_back({name, value}); }
  void note(const std::string& name, const std::string& text) { notes_.push_back({name, text}); }
  /// Throws RunError on every rank. Collective.
  void write(const std::string& path) const;

 private:
  std::vector<Dataset> sets_;
  std::deque<std::vector<double>> numbers_;
  std::deque<std::vector<std::int64_t>> wholes_;
  std::vector<Attribute> notes_;
};

/// A checkpoint that is read. Every member throws UserError, the same on every rank, naming the file and what is wrong.
class CheckpointReader {
 public:
  /// Opens the file and checks that it is a checkpoint and that every array is as it was written. Collective.
  explicit CheckpointReader(const std::string& path);

  bool has(const std::string& name) const;
  /// Rows over all ranks that wrote; components of a row.
  long long rows(const std::string& name) const;
  int components(const std::string& name) const;
  /// `count` rows from row `first`. Local; all ranks must call it for a failure to be told.
  std::vector<double> numbers(const std::string& name, long long first, long long count) const;
  std::vector<std::int64_t> wholes(const std::string& name, long long first, long long count) const;
  std::vector<double> numbers(const std::string& name) const { return numbers(name, 0, rows(name)); }
  std::vector<std::int64_t> wholes(const std::string& name) const { return wholes(name, 0, rows(name)); }
  double number(const std::string& note) const;
  std::string text(const std::string& note) const;
  const std::string& path() const { return path_; }
  /// Throws UserError "-restart: <file> <what>" on every rank.
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  struct Array {
    std::string name, kind;
    int components;
    long long rows;
    std::uint64_t checksum;
  };
  const Array& array(const std::string& name) const;
  void read(const Array& array, long long first, long long count, void* to) const;
  void check_sums() const;

  std::string path_;
  std::vector<Array> arrays_;
};

}  // namespace silt
