#include "base/output_directory.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <regex>
#include <vector>

#include "base/error.hpp"
#include "base/hdf5_file.hpp"
#include "base/petsc.hpp"

namespace silt {
namespace {

namespace fs = std::filesystem;
constexpr const char* record_name = "run.yaml";

/// What a run writes into its directory: nothing else is ever removed.
bool is_ours(const fs::path& relative) {
  static const std::regex pattern(
      R"((run\.yaml|fluid\.xdmf|particles\.xdmf|(diagnostics|boundaries|ledger|errors)\.csv|(removed|walls|energy|expectations)\.csv|)"
      R"((probe|line|profile|wall)_.*\.csv|(checkpoint|last_good|balance)\.h5|(fluid|particles)/(mesh(_\d+)?|\d{6,})\.h5)(\.part)?)");
  return std::regex_match(relative.generic_string(), pattern);
}

/// The files of ours in the directory and its two folders.
std::vector<fs::path> our_files(const fs::path& directory) {
  std::vector<fs::path> found;
  for (const char* folder : {"", "fluid", "particles"}) {
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(directory / folder, code))
      if (!entry.is_directory(code) && is_ours(fs::path(folder) / entry.path().filename()))
        found.push_back(entry.path());
  }
  return found;
}

/// Throws on every rank what rank 0 found.
void refuse(const std::string& words) {
  char text[512] = {};
  words.copy(text, sizeof text - 1);
  MPI_Bcast(text, sizeof text, MPI_CHAR, 0, PETSC_COMM_WORLD);
  if (text[0]) throw UserError(text);
}

}  // namespace

void OutputOptions::options(OptionGroup& option) {
  option("directory", directory, "where the run writes its files");
  option("interval", interval, "s", "simulated time between two outputs of the series; 0: only the first and the last",
         non_negative);
  option("overwrite", overwrite,
         "replace the files of an earlier run in the directory; no: refuse, unless the run goes on from a checkpoint "
         "there");
  option("precision", precision, {"double", "single"}, "numbers of the fluid and particle series");
}

OutputDirectory::OutputDirectory(const OutputOptions& options, const std::string& checkpoint)
    : options_(options), checkpoint_(checkpoint) {
  while (options_.directory.size() > 1 && options_.directory.back() == '/') options_.directory.pop_back();
  refuse(mpi_rank() == 0 ? obstacle() : "");
}

std::string OutputDirectory::obstacle() const {
  if (options_.directory.empty()) return "option -output_directory: it must name a directory";
  const auto unusable = [this](const std::string& why) {
    return fmt::format("cannot write to the output directory '{}' (-output_directory): {}", options_.directory, why);
  };
  std::error_code code;
  // The nearest directory that exists already must take a new entry.
  fs::path there = fs::absolute(options_.directory).lexically_normal();
  while (!fs::exists(there, code) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, code)) return unusable(fmt::format("'{}' is not a directory", there.string()));
  const fs::path probe = there / fmt::format(".silt_probe_{}", ::getpid());
  if (!fs::create_directory(probe, code))
    return unusable(fmt::format("{} in '{}'", code ? code.message() : "no new entry", there.string()));
  fs::remove(probe, code);

  if (!fs::is_directory(options_.directory, code)) return "";
  if (fs::exists(path(record_name), code)) {
    if (!options_.overwrite && !goes_on())
      return fmt::format("the output directory '{}' holds an earlier run and -output_overwrite is no",
                         options_.directory);
  } else if (const auto files = our_files(options_.directory); !files.empty()) {
    return fmt::format("the output directory '{}' holds '{}' but no {}: not a run of Silt, nothing is overwritten",
                       options_.directory, files[0].lexically_relative(options_.directory).string(), record_name);
  }
  return "";
}

void OutputDirectory::prepare(const std::string& record) {
  std::string words;
  if (mpi_rank() == 0) {
    words = obstacle();
    std::error_code code;
    if (words.empty())
      for (const auto& file : our_files(options_.directory)) fs::remove(file, code);
    if (words.empty() && !fs::is_directory(options_.directory, code) &&
        !fs::create_directories(options_.directory, code) && code)
      words = fmt::format("cannot make the output directory '{}' (-output_directory): {}", options_.directory,
                          code.message());
  }
  refuse(words);
  try {
    write_text(path(record_name), record);
  } catch (const RunError& e) {
    throw UserError(e.what());
  }
}

bool OutputDirectory::goes_on() const {
  std::error_code code;
  return !checkpoint_.empty() && fs::exists(path(record_name), code) &&
         fs::equivalent(fs::absolute(checkpoint_).parent_path(), options_.directory, code);
}

void OutputDirectory::resume(const std::string& record, double time) {
  int there = mpi_rank() == 0 && goes_on();
  MPI_Bcast(&there, 1, MPI_INT, 0, PETSC_COMM_WORLD);
  if (!there) return prepare(record);
  resumed_ = time;
  try {
    write_text(path(record_name), record);
  } catch (const RunError& e) {
    throw UserError(e.what());
  }
}

CsvWriter OutputDirectory::table(const std::string& file, const std::vector<std::string>& columns) const {
  return CsvWriter(path(file), columns, resumed_);
}

}  // namespace silt
