#pragma once
#include "base/options.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// No rolling resistance.
struct NoRolling {
  static constexpr const char* name = "none";
  static constexpr bool acts = false;
  void options(OptionGroup&) {}
  template <class Real>
  struct Constants {};
  Constants<double> constants(const PairProperties&) const { return {}; }
  template <class Real>
  struct History {};
  template <class Real>
  static SILT_INLINE void torque(const Contact<Real>&, const NormalLoad<Real>&, const Constants<Real>&, Real,
                                 History<Real>&, Real* torque) {
    for (int d = 0; d < 3; ++d) torque[d] = Real(0.0);
  }
};

}  // namespace silt
