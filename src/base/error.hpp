#pragma once
#include <stdexcept>
#include <string>

namespace silt {

/// A mistake in what the user gave (option, mesh, material, file): one line `silt: error: ...`, exit code 2.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The run cannot go on (non-finite field, lost particle, step below the least, ledger out of balance, disk full): exit
/// code 1.
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A solve that failed but may succeed with a smaller step; the state is as before the step.
struct SolveFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace silt
