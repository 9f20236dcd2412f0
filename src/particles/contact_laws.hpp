#pragma once
#include <vector>

#include "particles/contact_models.hpp"
#include "particles/materials.hpp"
#include "particles/sweep.hpp"

namespace silt {

/// The law chosen from a list of models, with its constants for every pair of materials.
template <class List>
struct LawSlot {
  typename List::Any model;
  std::vector<double> constants;  ///< [constants of the model][pairs of materials]
};

/// The laws of contact the user chose (`-normal_type`, `-tangential_type`, `-rolling_type`, `-twisting_type`).
class ContactLaws {
 public:
  /// Throws UserError for laws that do not go together.
  ContactLaws(Options& options, const Materials& materials);
  ContactLaws(const ContactLaws&) = delete;

  const LawSetup& setup() const { return setup_; }
  /// Doubles that a contact remembers.
  int history_components() const { return history_components_; }
  /// Friction of all pairs is multiplied by this factor (settling without friction).
  void scale_friction(double factor) { prepare(factor); }

  /// Duration of a collision of this pair of materials. s
  double duration(int a, int b, const Encounter& encounter) const;
  /// True where waves in the particles limit the step too (Hertz family).
  bool hertzian() const;

  const NormalModels::Any& normal() const { return normal_.model; }
  const TangentialModels::Any& tangential() const { return tangential_.model; }
  const RollingModels::Any& rolling() const { return rolling_.model; }
  const TwistingModels::Any& twisting() const { return twisting_.model; }

 private:
  /// Calls act(slot, stage) for every slot, in the order in which the laws run.
  template <class Act>
  void each(Act&& act) {
    act(normal_, setup_.normal);
    act(tangential_, setup_.tangential);
    act(rolling_, setup_.rolling);
    act(twisting_, setup_.twisting);
  }
  void prepare(double friction_factor);
  void check_combination() const;

  const Materials& materials_;
  LawSlot<NormalModels> normal_;
  LawSlot<TangentialModels> tangential_;
  LawSlot<RollingModels> rolling_;
  LawSlot<TwistingModels> twisting_;
  LawSetup setup_;
  int history_components_ = 0;
};

}  // namespace silt
