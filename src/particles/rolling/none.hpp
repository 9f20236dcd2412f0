#pragma once
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// No rolling resistance.
struct NoRolling {
  static constexpr const char* name = "none";
  static constexpr ModelNote note{"", "", "M = 0", "spin about the contact is kept"};
  static constexpr bool extended = false;
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
