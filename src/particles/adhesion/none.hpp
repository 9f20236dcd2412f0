#pragma once
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// No adhesion.
struct NoAdhesion {
  static constexpr const char* name = "none";
  static constexpr ModelNote note{"", "", "F = 0", "spheres part at touching"};
  static constexpr bool extended = false;
  void options(OptionGroup&) {}
  template <class Real>
  struct Constants {};
  Constants<double> constants(const PairProperties&) const { return {}; }
  template <class Real>
  struct History {};
  template <class Real>
  static SILT_INLINE void adhere(const Contact<Real>&, const Constants<Real>&, History<Real>&, NormalLoad<Real>& load,
                                 Real& pull) {
    load.pull_off = Real(0.0);
    pull = Real(0.0);
  }
};

/// Nothing in a slot of forces along the line of centres.
struct NoPull {
  static constexpr const char* name = "none";
  static constexpr ModelNote note{"", "", "F = 0", ""};
  static constexpr bool extended = false;
  void options(OptionGroup&) {}
  template <class Real>
  struct Constants {};
  Constants<double> constants(const PairProperties&) const { return {}; }
  template <class Real>
  struct History {};
  template <class Real>
  static SILT_INLINE Real force(const Contact<Real>&, const Constants<Real>&) {
    return Real(0.0);
  }
};

}  // namespace silt
