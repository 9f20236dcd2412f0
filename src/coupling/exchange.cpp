#include "coupling/exchange.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace silt {

double balanced(const char* what, double imbalance, double exchanged) {
  const double residual = exchanged > 0 ? imbalance / exchanged : 0;
  if (!(residual <= exchange_tolerance))
    throw RunError(fmt::format("{} is out of balance by {:.3g} of what was exchanged, allowed {:.0e}", what, residual,
                               exchange_tolerance));
  return residual;
}

}  // namespace silt
