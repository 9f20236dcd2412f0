#pragma once
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// Nothing in a slot that may stay empty: no adhesion, no pull, no resistance to rolling or twisting.
struct NoLaw {
  static constexpr const char* name = "none";
  static constexpr ModelNote note{"", "", "0", ""};
  static constexpr bool extended = false;
  void options(OptionGroup&) {}
  template <class Real>
  struct Constants {};
  Constants<double> constants(const PairProperties&) const { return {}; }
  template <class Real>
  struct History {};

  /// In the slot of adhesion.
  template <class Real>
  static SILT_INLINE void adhere(const Contact<Real>&, const Constants<Real>&, History<Real>&, NormalLoad<Real>& load,
                                 Real& pull) {
    load.pull_off = Real(0.0);
    pull = Real(0.0);
  }
  /// In the slots of forces along the line of centres.
  template <class Real>
  static SILT_INLINE Real force(const Contact<Real>&, const Constants<Real>&, const History<Real>&) {
    return Real(0.0);
  }
  /// In the slot of rolling.
  template <class Real>
  static SILT_INLINE void torque(const Contact<Real>&, const NormalLoad<Real>&, const Constants<Real>&, Real,
                                 History<Real>&, Real* torque) {
    for (int d = 0; d < 3; ++d) torque[d] = Real(0.0);
  }
  /// In the slot of twisting.
  template <class Real>
  static SILT_INLINE Real torque(const Contact<Real>&, const NormalLoad<Real>&, const Constants<Real>&, Real,
                                 History<Real>&) {
    return Real(0.0);
  }
};

}  // namespace silt
