#pragma once
#include <span>
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// The void fraction alpha = 1 - (share of the volume that particles take) and its rate of change over the step.
/// sum_i M_i (1 - alpha_i) is the particles' volume to round-off; alpha is never clipped.
class VoidFraction {
 public:
  explicit VoidFraction(const Mesh& mesh) : mesh_(mesh), previous_(mesh.nodes, 1.0) {}

  /// alpha at the start of the coming step. Throws RunError on all ranks when it is below `least`.
  void start(std::span<const double> solids_fraction, double least);
  /// Fills alpha and d(alpha)/dt = (alpha - alpha at the start)/dt. Throws RunError on all ranks when alpha falls below
  /// `least`.
  void advance(std::span<const double> solids_fraction, double dt, double least, std::span<double> alpha,
               std::span<double> rate) const;
  /// The step is done: its alpha is the start of the next.
  void commit(std::span<const double> alpha) { previous_.assign(alpha.begin(), alpha.end()); }
  std::span<const double> previous() const { return previous_; }
  /// What a restart needs.
  std::vector<double>& state() { return previous_; }

 private:
  void check(std::span<const double> alpha, double least) const;
  const Mesh& mesh_;
  std::vector<double> previous_;
};

}  // namespace silt
