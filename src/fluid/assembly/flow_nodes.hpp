#pragma once
#include <vector>

#include "fluid/assembly/flow_data.hpp"

namespace silt {

struct StepFields;

/// The nodal values of a step and an iterate, packed for the cell loops.
///
/// A velocity node has u (3), alpha, history (3), 0, body force (3), 0, u^n (3), 0; a vertex has p, d(alpha)/dt,
/// response, following, load (3), 0, lent share, lent pressure, 0, 0. What no node has (a body force, particles) is not
/// packed, and the loops leave it out.
class FlowNodes {
 public:
  /// `state` by `layout`, Cartesian.
  void pack(const StepFields& fields, const double* state, const FlowLayout& layout, int dimension);
  /// Sets what data has of it.
  void give(FlowData& data) const;

 private:
  std::vector<double> nodes_, vertices_;
  bool forced_ = false, loaded_ = false;
};

}  // namespace silt
