#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "fluid/boundary/boundary_conditions.hpp"
#include "fluid/turbulence/turbulence_options.hpp"

namespace silt {

/// The turbulence of what enters through boundaries, given by intensity (or k) and length (or viscosity ratio).
class TurbulenceInflow {
 public:
  /// Reads `-boundary_<name>_turbulence_...`; inflows that fix the velocity need them, open boundaries may have them.
  /// Throws UserError for what is missing, given twice or given where nothing enters.
  TurbulenceInflow(const Mesh& mesh, Options& options, const BoundaryConditions& boundaries);

  bool given(int boundary) const { return conditions_[boundary].given; }
  /// k of what enters with a speed; m2/s2
  double energy(int boundary, const Vec3& x, double t, double speed) const;
  /// Exactly one of the two is above 0: length (m) or viscosity ratio.
  struct Scale {
    double length, viscosity_ratio;
  };
  Scale scale(int boundary, const Vec3& x, double t) const;

 private:
  struct Condition {
    bool given = false, by_energy = false, by_length = false;
    std::unique_ptr<Expression> intensity, energy, length, viscosity_ratio;
  };
  std::vector<Condition> conditions_;
};

}  // namespace silt
