#pragma once
#include <optional>

#include "base/models.hpp"
#include "particles/field/given_field.hpp"
#include "particles/field/magnetisation.hpp"
#include "particles/force_field.hpp"
#include "particles/pair_sums.hpp"

namespace silt {

/// What dipoles do to each other and an applied field to them, whatever the model of their moment.
inline constexpr SwitchedModel magnetic_models[] = {
    {"pairs",
     "magnetic_type",
     {"(7.77-7.80)", "Jackson 1975",
      "F_ij = 3 mu0/(4 pi r^4) [(m_i.b) m_j + (m_j.b) m_i + (m_i.m_j) b - 5 (m_i.b)(m_j.b) b], M = mu0 m_i x H_ij, "
      "H_ij = "
      "[3 b (m_j.b) - m_j]/(4 pi r^3), b the unit vector from j to i; all pairs or up to a cut-off",
      "head to tail, side by side, oblique; sums over pairs with images; angular momentum of a pair"}},
    {"applied_field",
     "magnetic_field",
     {"(7.77-7.80)", "Jackson 1975", "F = mu0 grad(m.H), M = mu0 m x H",
      "force of a field gradient; swing of a magnet"}},
};

/// The options `-magnetic_...` that all models of the moment share.
struct MagneticOptions {
  std::string field, flux_density;
  double cutoff = 0, tolerance = 1e-8;
  int iterations = 200, seed = 1;
  Vec3 direction = Vec3::Zero();
  void options(OptionGroup& option) {
    option("field", field, "A/m, formulas in x, y, z, t: the applied field H");
    option("flux_density", flux_density, "T, formulas in x, y, z, t: mu0 H of the applied field, instead of field");
    option("cutoff", cutoff, "m", "dipoles further apart do not act on each other; 0: all do", non_negative);
    option("tolerance", tolerance, "-", "change of the moments, relative to the largest, at which they are found",
           Range{0, 1, true, true});
    option("iterations", iterations, "-", "the moments not found by then, the run stops", at_least(1));
    option("direction", direction, "-", "of permanent and fixed moments at the start; 0, 0, 0: at random");
    option("seed", seed, "-", "another seed, other random directions", at_least(0));
  }
};

/// Magnetic dipoles (7.77-7.80): moments by the model chosen, forces between all pairs or up to a cut-off, force and
/// torque of the applied field. The moment is the column "magnetic_moment", A m2.
class Magnetic final : public ForceField {
 public:
  /// Null for `-magnetic_type none`.
  static std::unique_ptr<Magnetic> create(Options& options, const Mesh& mesh, Columns& columns,
                                          const std::string& instructions);
  Magnetic(MagneticModels::Any model, const MagneticOptions& options, const Mesh& mesh, Columns& columns,
           const std::string& instructions);
  void act(FieldStep& step) override;
  bool turns() const override { return follows_ == MomentFollows::body; }
  void turn(Store& store, const double (*turned)[4]) override;
  std::vector<StepBound> bounds(const Materials& materials, const SmallestRadii& smallest) const override;
  std::vector<std::string> warnings(const Materials& materials, const SmallestRadii& smallest) const override {
    return cutoff_warnings("magnetic_cutoff", options_.cutoff, 4, materials, smallest);
  }
  std::string description() const override;

 private:
  void apply(FieldStep& step, double* moment) const;
  /// The moments that agree with the field of all others; leaves the sources ready.
  void find_moments(FieldStep& step, double* moment);
  Vec3 applied(const Vec3& x, double time) const { return scale_ * field_(x, time); }

  MagneticModels::Any model_;
  MagneticOptions options_;
  MomentFollows follows_;
  GivenField field_;
  double scale_;      ///< from what the user gave to A/m
  FieldRange range_;  ///< of field_, in what the user gave
  int column_;
  const PairKernels& kernels_;
  PairSources sources_;
  PairSums force_, neighbours_;
};

}  // namespace silt
