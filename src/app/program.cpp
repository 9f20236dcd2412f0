#include "app/program.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "app/catalogue.hpp"
#include "app/simulation.hpp"
#include "app/version.hpp"
#include "base/error.hpp"
#include "base/options.hpp"
#include "base/petsc.hpp"
#include "particles/law_table.hpp"

namespace silt {
namespace {

/// What PETSc's own start-up may see: not the case files, and not the switches that mean something else to us.
std::vector<std::string> for_petsc(const std::vector<std::string>& arguments) {
  std::vector<std::string> kept{"silt"};
  for (const auto& word : arguments)
    if (word.rfind("-log_view", 0) == 0 || word.rfind("-malloc", 0) == 0 || word == "-info" || word == "-fp_trap")
      kept.push_back(word);
  return kept;
}

/// True when every rank arrives within a few seconds: then all of them failed alike and can leave in order.
bool all_ranks_failed() {
  MPI_Request request;
  MPI_Ibarrier(PETSC_COMM_WORLD, &request);
  for (int k = 0; k < 500; ++k) {
    int done = 0;
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

/// Prints the one line of an error and returns the exit code; a rank that fails alone takes the others down.
int fail(const std::string& message, int code) {
  const bool together = all_ranks_failed();
  if (!together || mpi_rank() == 0) {
    std::fflush(stdout);
    fmt::print(stderr, "silt: error: {}\n", message);
    std::fflush(stderr);
  }
  if (!together) MPI_Abort(PETSC_COMM_WORLD, code);
  return code;
}

/// Builds the case. Where that fails, a mistyped option is named before what is missing because of it.
std::unique_ptr<Simulation> build(Options& options) {
  try {
    return std::make_unique<Simulation>(options);
  } catch (const UserError&) {
    options.refuse_unknown(&catalogue());
    throw;
  }
}

int answer(const std::vector<std::string>& arguments) {
  Options options = Options::from_arguments(arguments);
  const bool talk = mpi_rank() == 0;
  if (options.find("version")) {
    if (talk)
      fmt::print("silt {} (PETSc {}.{}.{})\n", version, PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR,
                 PETSC_VERSION_SUBMINOR);
    return 0;
  }
  if (options.find("help") || arguments.empty()) {
    if (talk)
      fmt::print(
          "usage: silt case.yaml [more.yaml] [-option value ...]\n\n  -check   validate the case without running it\n  "
          "-help    this list\n  -models  the laws that can be chosen\n  -version\n\noptions (nested maps of the YAML "
          "file join their keys by _):\n{}",
          catalogue().help_text());
    return arguments.empty() ? 2 : 0;
  }
  if (options.find("models")) {
    if (talk) fmt::print("{}", model_list());
    return 0;
  }
  if (options.find("options_page")) {
    if (talk) fmt::print("{}", catalogue().markdown());
    return 0;
  }
  if (options.find("models_page")) {
    if (talk) fmt::print("{}", model_page());
    return 0;
  }
  if (options.given("law_table_motion")) {
    const std::string table = law_table(options);
    options.refuse_unknown(&catalogue());
    if (talk) fmt::print("{}", table);
    return 0;
  }
  const bool check = options.find("check").has_value();
  options.insert_into_petsc();
  auto simulation = build(options);
  if (check) return simulation->check();
  for (;;) {
    const int code = simulation->run();
    if (code != Simulation::share_out_anew) return code;
    auto carried = simulation->carried();
    simulation.reset();  // before the next one takes its memory
    simulation = std::make_unique<Simulation>(options, std::move(carried));
  }
}

}  // namespace

int run_program(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = for_petsc(arguments);
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  PetscSession session(static_cast<int>(words.size()), argv.data());
  try {
    return answer(arguments);
  } catch (const UserError& e) {
    return fail(e.what(), 2);
  } catch (const std::exception& e) {
    return fail(e.what(), 1);
  }
}

}  // namespace silt
