#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fluid/fluid.hpp"
#include "particles/particles.hpp"

namespace silt {

/// The state after a step, as those look at it who report on the run. A run without fluid or without particles has
/// null there.
struct Moment {
  double time = 0, dt = 0;  ///< s; dt of the step that led here
  long long step = 0;
  const Fluid* fluid = nullptr;
  const Particles* particles = nullptr;
  FluidStep fluid_step;
  ParticleStep particle_step;
  double ledger_residual = 0;  ///< largest relative residual of the conservation ledger
};

/// Named numbers measured at one moment: "pressure_drop", "probe name.velocity_x", "boundary name.force_x".
/// The same on every rank.
class Quantities {
 public:
  void set(const std::string& name, double value) { values_[name] = value; }
  std::optional<double> find(const std::string& name) const {
    const auto it = values_.find(name);
    return it == values_.end() ? std::nullopt : std::optional<double>(it->second);
  }

 private:
  std::map<std::string, double> values_;
};

}  // namespace silt
