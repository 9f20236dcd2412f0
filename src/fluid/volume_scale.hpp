#pragma once
#include <algorithm>
#include <cmath>

namespace silt {

/// m3/s, what an imbalance of the fluid's volume is measured by: what comes in, or what alpha makes room for, but at
/// least a millionth of the whole volume a step (a fluid at rest; dt <= 0: a steady state).
inline double volume_scale(double inflow, double volume_rate, double volume, double dt) {
  return std::max({inflow, std::abs(volume_rate), dt > 0 ? 1e-6 * volume / dt : 0.0, 1e-300});
}

}  // namespace silt
