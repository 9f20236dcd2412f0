#pragma once
#include <functional>
#include <vector>

#include "particles/contact_models.hpp"
#include "particles/materials.hpp"
#include "particles/sweep.hpp"

namespace silt {

/// The normal, tangential and rolling law the user chose (`-normal_type`, `-tangential_type`, `-rolling_type`), with
/// their constants for every pair of materials.
class ContactLaws {
 public:
  ContactLaws(Options& options, const Materials& materials);
  ContactLaws(const ContactLaws&) = delete;

  const LawSetup& setup() const { return setup_; }
  /// Doubles that a contact remembers.
  int history_components() const { return history_components_; }
  /// Friction of all pairs is multiplied by this factor (settling without friction).
  void scale_friction(double factor);

  /// Duration of a collision of this pair of materials, masses and radii (effective) and speed. s
  double duration(int a, int b, double mass, double radius, double speed) const;
  /// True where waves in the particles limit the step too (Hertz family).
  bool hertzian() const;

  const NormalModels::Any& normal() const { return normal_; }
  const TangentialModels::Any& tangential() const { return tangential_; }
  const RollingModels::Any& rolling() const { return rolling_; }

 private:
  void prepare(double friction_factor);

  const Materials& materials_;
  NormalModels::Any normal_;
  TangentialModels::Any tangential_;
  RollingModels::Any rolling_;
  std::vector<double> normal_constants_, tangential_constants_, rolling_constants_;
  LawSetup setup_;
  int history_components_ = 0;
};

}  // namespace silt
