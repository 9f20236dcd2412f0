#pragma once
#include <string>
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

/// The smallest and the largest particle of each material, on all ranks.
struct ParticleSizes {
  explicit ParticleSizes(int materials) : smallest(materials, infinity), largest(materials, 0.0) {}
  std::vector<double> smallest;  ///< m, infinity where the material has no particle
  std::vector<double> largest;   ///< m, 0 where the material has no particle
};

/// How fast a law wants to be followed in time.
struct LawDuration {
  std::string law;
  double duration;  ///< s, as of a collision
};

/// The laws between particles that are near each other, as the user chose them (`-normal_type`, `-adhesion_type`,
/// `-dlvo_type`, `-bridge_type`, `-interfacial_type`, `-lubrication_type`, `-tangential_type`, `-rolling_type`,
/// `-twisting_type`).
class ContactLaws {
 public:
  /// Throws UserError for laws that do not go together.
  ContactLaws(Options& options, const Materials& materials);
  ContactLaws(const ContactLaws&) = delete;

  const LawSetup& setup() const { return setup_; }
  /// Doubles that a contact remembers.
  int history_components() const { return history_components_; }
  /// Takes note of the sizes of the particles: sets the gaps at which pairs begin and end, and what depends on sizes.
  void set_sizes(const ParticleSizes& sizes);
  const ParticleSizes& sizes() const { return sizes_; }
  /// What the user should know of the laws at these sizes (Tabor parameter; forces that are cut off), a line each.
  const std::vector<std::string>& notices() const { return notices_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Friction of all pairs is multiplied by this factor (settling without friction).
  void scale_friction(double factor) {
    friction_factor_ = factor;
    prepare();
  }

  /// At which share of a step springs are read at least (ParticleOptions::spring_share).
  void read_springs_at(double share) {
    least_share_ = share;
    prepare();
  }

  /// The slip takes the spins at the radius instead of the arm to the contact point, R_i w_i + R_j w_j.
  void take_slip_at_radius(bool at_radius) { setup_.slip_at_radius = at_radius; }

  /// Duration of a collision of this pair of materials. s
  double duration(int a, int b, const Encounter& encounter) const;
  /// The same for the forces beside the normal law.
  std::vector<LawDuration> pull_durations(int a, int b, const Encounter& encounter) const;
  /// Half a swing of the springs of friction, rolling and twisting whose stiffness is given: those that follow from the
  /// normal law are never stiffer than it.
  std::vector<LawDuration> swing_durations(int a, int b, const Encounter& encounter) const;
  /// True where waves in the particles limit the step too (Hertz family).
  bool hertzian() const;

  const NormalModels::Any& normal() const { return normal_.model; }
  const TangentialModels::Any& tangential() const { return tangential_.model; }
  const RollingModels::Any& rolling() const { return rolling_.model; }
  const TwistingModels::Any& twisting() const { return twisting_.model; }
  const AdhesionModels::Any& adhesion() const { return adhesion_.model; }
  const DlvoModels::Any& dlvo() const { return dlvo_.model; }
  const BridgeModels::Any& bridge() const { return bridge_.model; }
  const InterfacialModels::Any& interfacial() const { return interfacial_.model; }
  const LubricationModels::Any& lubrication() const { return lubrication_.model; }
  /// What the laws know of two materials: with the sizes of the run and the friction of the moment.
  PairProperties pair(int a, int b) const;

 private:
  /// Calls act(slot, stage) for every slot, in the order in which the laws run.
  template <class Act>
  void each(Act&& act) {
    act(normal_, setup_.normal);
    act(adhesion_, setup_.adhesion);
    act(dlvo_, setup_.dlvo);
    act(bridge_, setup_.bridge);
    act(interfacial_, setup_.interfacial);
    act(lubrication_, setup_.lubrication);
    act(tangential_, setup_.tangential);
    act(rolling_, setup_.rolling);
    act(twisting_, setup_.twisting);
  }
  void prepare();
  void check_combination() const;
  void describe_adhesion();

  const Materials& materials_;
  LawSlot<NormalModels> normal_;
  LawSlot<TangentialModels> tangential_;
  LawSlot<RollingModels> rolling_;
  LawSlot<TwistingModels> twisting_;
  LawSlot<AdhesionModels> adhesion_;
  LawSlot<DlvoModels> dlvo_;
  LawSlot<BridgeModels> bridge_;
  LawSlot<InterfacialModels> interfacial_;
  LawSlot<LubricationModels> lubrication_;
  LawSetup setup_;
  ParticleSizes sizes_;
  std::vector<std::string> notices_, warnings_;
  double friction_factor_ = 1, least_share_ = 0.5;
  int history_components_ = 0;
};

}  // namespace silt
