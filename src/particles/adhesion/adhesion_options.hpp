#pragma once
#include <string>

#include "base/options.hpp"
#include "particles/normal/normal_load.hpp"
#include "particles/real.hpp"

namespace silt {

/// The options that all adhesions share.
struct AdhesionOptions {
  std::string friction = "thornton_yin";
  double distance = 0.4e-9;
  void options(OptionGroup& option) {
    option("friction", friction, {"thornton_yin", "net"},
           "Coulomb limit of adhesive contacts: mu |F + 2 F_c|, F_c the pull-off force, or mu |F|");
    option("distance", distance, "m", "reach D of the surface forces in the Tabor parameter", positive);
  }
  /// What multiplies F_c in the load that limits friction (Thornton & Yin 1991).
  double friction_share() const { return friction == "net" ? 0 : 2; }
};

/// Splits the net normal force of a contact whose pull-off force is load.pull_off into the load that limits friction
/// and the pull that does not.
template <class Real>
SILT_INLINE void split_load(NormalLoad<Real>& load, Real net, Real share, Real& pull) {
  load.force = net + share * load.pull_off;
  pull = Real(0.0) - share * load.pull_off;
}

}  // namespace silt
