#pragma once
#include <algorithm>
#include <cmath>

namespace silt {

/// m3/s, what an imbalance of the fluid's volume is measured by: what comes in, what alpha makes room for, or a
/// hundredth of what flows about inside, in this step or the one before (whose flow a solver of finite tolerance has to
/// stop), but at least a millionth of the whole volume a step (a fluid at rest; dt <= 0: a steady state).
class VolumeScale {
 public:
  /// The scale of a step that is done; `speed`, m/s: mean over the domain, of `volume`, m3 (2D: m2).
  double next(double inflow, double volume_rate, double speed, double volume, int dimension, double dt) {
    const double before = flow_, inside = speed * std::pow(volume, 1 - 1.0 / dimension);
    flow_ = std::max({inflow, std::abs(volume_rate), 0.01 * inside});
    return std::max({flow_, before, dt > 0 ? 1e-6 * volume / dt : 0.0, 1e-300});
  }

 private:
  double flow_ = 0;  ///< m3/s, of the last step
};

}  // namespace silt
