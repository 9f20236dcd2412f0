#pragma once
#include "base/models.hpp"
#include "particles/normal/kuwabara_kono.hpp"
#include "particles/normal/lee_herrmann.hpp"
#include "particles/normal/linear.hpp"
#include "particles/normal/thornton.hpp"
#include "particles/normal/tsuji.hpp"
#include "particles/normal/walton_braun.hpp"
#include "particles/rolling/constant.hpp"
#include "particles/rolling/epsd.hpp"
#include "particles/rolling/none.hpp"
#include "particles/rolling/spring.hpp"
#include "particles/rolling/viscous_coulomb.hpp"
#include "particles/tangential/mindlin.hpp"
#include "particles/tangential/spring.hpp"
#include "particles/tangential/spring_dashpot.hpp"
#include "particles/tangential/viscous.hpp"
#include "particles/tangential/walton_braun.hpp"
#include "particles/twisting/none.hpp"
#include "particles/twisting/twisting.hpp"

namespace silt {

/// The contact laws a user can choose; a new law is one header and one entry here. `extended` laws read the extended
/// fields of Contact.
using NormalModels = Models<Tsuji, Linear, LeeHerrmann, KuwabaraKono, WaltonBraun, Thornton>;
using TangentialModels = Models<Mindlin, SpringDashpot, SpringTangential, ViscousTangential, WaltonBraunTangential>;
using RollingModels = Models<NoRolling, ConstantRolling, SpringRolling, ViscousCoulombRolling, EpsdRolling>;
using TwistingModels = Models<NoTwisting, Twisting>;

}  // namespace silt
