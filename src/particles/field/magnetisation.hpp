#pragma once
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/models.hpp"
#include "base/vector.hpp"

namespace silt {

/// The field that a moment answers to.
enum class MomentFollows {
  nothing,  ///< it is what it is
  applied,  ///< the applied field alone
  local,    ///< applied field and neighbours, found together
  body      ///< it turns with the particle
};

/// The models of `-magnetic_type`: the moment m (A m2) of a particle of volume V in the field H (A/m). Those that
/// follow nothing or the body start as magnetisation times V along `magnetic_direction`.
struct NoMagnetism {
  static constexpr const char* name = "none";
  static constexpr ModelNote note = {"", "", "m = 0", ""};
  MomentFollows follows() const { return MomentFollows::nothing; }
  void options(OptionGroup&) {}
  Vec3 moment(const Vec3&, double) const { return Vec3::Zero(); }
  double largest(double) const { return 0; }
};

/// The moment has its full size along the field: the applied one, or with `local` the one that the neighbours change.
struct SaturatedMagnetism {
  static constexpr const char* name = "saturated";
  static constexpr ModelNote note = {"(7.77-7.80)", "Jackson 1975", "m = M_s V along the field",
                                     "head to tail, side by side, oblique; approach of a pair; chains"};
  double magnetisation = 0;
  bool local = false;
  void options(OptionGroup& option) {
    option("magnetisation", magnetisation, "A/m", "saturation magnetisation M_s", non_negative);
    option("local", local, "saturated moments follow the local field, neighbours and all, not the applied one");
  }
  void check() const {
    if (!(magnetisation > 0)) throw UserError("-magnetic_magnetisation is missing: -magnetic_type saturated needs it");
  }
  MomentFollows follows() const { return local ? MomentFollows::local : MomentFollows::applied; }
  Vec3 moment(const Vec3& field, double volume) const {
    const double size = field.norm();
    return size > 0 ? Vec3(magnetisation * volume / size * field) : Vec3::Zero();
  }
  double largest(double volume) const { return magnetisation * volume; }
};

/// The moment is in proportion to the field. The susceptibility chi is that of a lone sphere in the applied field,
/// whose own field is part of it.
struct LinearMagnetism {
  static constexpr const char* name = "linear";
  static constexpr ModelNote note = {"(7.77-7.80)", "Jackson 1975",
                                     "m = chi V H with H of the neighbours too; chi given, or 3 (mu_r - 1)/(mu_r + 2)",
                                     "two coupled spheres in line and side by side"};
  std::optional<double> susceptibility, permeability;
  void options(OptionGroup& option) {
    option("susceptibility", susceptibility, "-", "moment of a lone sphere over its volume and the applied field",
           Range{-1.5, 3, false, false});
    option("permeability", permeability, "-", "relative permeability of the material, instead of the susceptibility",
           non_negative);
  }
  void check() const {
    if (susceptibility.has_value() == permeability.has_value())
      throw UserError("-magnetic_type linear needs one of -magnetic_susceptibility and -magnetic_permeability");
  }
  double effective() const { return susceptibility ? *susceptibility : 3 * (*permeability - 1) / (*permeability + 2); }
  MomentFollows follows() const { return MomentFollows::local; }
  Vec3 moment(const Vec3& field, double volume) const { return effective() * volume * field; }
  double largest(double) const { return 0; }
};

/// Superparamagnetic (Langevin 1905): in proportion to weak fields, full size in strong ones.
struct LangevinMagnetism {
  static constexpr const char* name = "langevin";
  static constexpr ModelNote note = {"(7.77-7.80)", "Langevin 1905",
                                     "m = M_s V L(3 chi H/M_s) along H, the neighbours' too, L(x) = coth x - 1/x",
                                     "both limits; two coupled spheres"};
  double magnetisation = 0, susceptibility = 0;
  void options(OptionGroup& option) {
    option("magnetisation", magnetisation, "A/m", "saturation magnetisation M_s", non_negative);
    option("susceptibility", susceptibility, "-", "initial susceptibility chi of a lone sphere",
           Range{0, 3, false, false});
  }
  void check() const {
    if (!(magnetisation > 0 && susceptibility > 0))
      throw UserError("-magnetic_type langevin needs -magnetic_magnetisation and -magnetic_susceptibility");
  }
  static double langevin(double x) { return x < 1e-2 ? x / 3 * (1 - x * x / 15) : 1 / std::tanh(x) - 1 / x; }
  MomentFollows follows() const { return MomentFollows::local; }
  Vec3 moment(const Vec3& field, double volume) const {
    const double size = field.norm();
    if (!(size > 0)) return Vec3::Zero();
    return magnetisation * volume * langevin(3 * susceptibility * size / magnetisation) / size * field;
  }
  double largest(double volume) const { return magnetisation * volume; }
};

/// What magnets have in common that bring their moment along.
struct MagnetisedBody {
  double magnetisation = 0;
  void options(OptionGroup& option) {
    option("magnetisation", magnetisation, "A/m", "magnetisation M of the particle", non_negative);
  }
  void check() const {
    if (!(magnetisation > 0))
      throw UserError("-magnetic_magnetisation is missing: -magnetic_type permanent and fixed need it");
  }
  Vec3 moment(const Vec3&, double) const { return Vec3::Zero(); }
  double largest(double volume) const { return magnetisation * volume; }
};

/// A moment that is fixed in the particle and turns with it.
struct PermanentMagnetism : MagnetisedBody {
  static constexpr const char* name = "permanent";
  static constexpr ModelNote note = {"(7.77-7.80)", "Jackson 1975", "m = M V, turns with the particle",
                                     "swing in a field, second order; angular momentum of a pair"};
  MomentFollows follows() const { return MomentFollows::body; }
};

/// A moment that never changes.
struct FixedMagnetism : MagnetisedBody {
  static constexpr const char* name = "fixed";
  static constexpr ModelNote note = {"(7.77-7.80)", "Jackson 1975", "m = M V, fixed in space",
                                     "force of a field gradient; repulsion of a pair"};
  MomentFollows follows() const { return MomentFollows::nothing; }
};

using MagneticModels =
    Models<NoMagnetism, SaturatedMagnetism, LinearMagnetism, LangevinMagnetism, PermanentMagnetism, FixedMagnetism>;

}  // namespace silt
