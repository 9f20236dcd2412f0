#pragma once
#include "base/models.hpp"
#include "particles/contact.hpp"
#include "particles/materials.hpp"
#include "particles/normal/normal_load.hpp"

namespace silt {

/// No twisting resistance.
struct NoTwisting {
  static constexpr const char* name = "none";
  static constexpr ModelNote note{"", "", "M_t = 0", "spin about the normal is kept"};
  static constexpr bool acts = false, extended = false;
  void options(OptionGroup&) {}
  template <class Real>
  struct Constants {};
  Constants<double> constants(const PairProperties&) const { return {}; }
  template <class Real>
  struct History {};
  template <class Real>
  static SILT_INLINE Real torque(const Contact<Real>&, const NormalLoad<Real>&, const Constants<Real>&, Real,
                                 History<Real>&) {
    return Real(0.0);
  }
};

}  // namespace silt
