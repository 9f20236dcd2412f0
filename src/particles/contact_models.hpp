#pragma once
#include "base/models.hpp"
#include "particles/adhesion/automatic.hpp"
#include "particles/adhesion/capillary.hpp"
#include "particles/adhesion/dlvo.hpp"
#include "particles/adhesion/dmt.hpp"
#include "particles/adhesion/interfacial.hpp"
#include "particles/adhesion/jkr.hpp"
#include "particles/adhesion/squeeze_film.hpp"
#include "particles/no_law.hpp"
#include "particles/normal/kuwabara_kono.hpp"
#include "particles/normal/langston.hpp"
#include "particles/normal/lee_herrmann.hpp"
#include "particles/normal/lennard_jones.hpp"
#include "particles/normal/linear.hpp"
#include "particles/normal/thornton.hpp"
#include "particles/normal/tsuji.hpp"
#include "particles/normal/walton_braun.hpp"
#include "particles/rolling/constant.hpp"
#include "particles/rolling/epsd.hpp"
#include "particles/rolling/spring.hpp"
#include "particles/rolling/viscous_coulomb.hpp"
#include "particles/tangential/mindlin.hpp"
#include "particles/tangential/spring.hpp"
#include "particles/tangential/spring_dashpot.hpp"
#include "particles/tangential/viscous.hpp"
#include "particles/tangential/walton_braun.hpp"
#include "particles/twisting/twisting.hpp"

namespace silt {

/// The contact laws a user can choose; a new law is one header and one entry here. `extended` laws read the extended
/// fields of Contact. One that acts beyond touching has `double reach(const Constants<double>&, const Encounter&)
/// const`, the gap (m) to which it acts, and `enter(...)`, the gap at which it begins (without it: touching).
using NormalModels = Models<Tsuji, Linear, LeeHerrmann, KuwabaraKono, WaltonBraun, Thornton, LennardJones, Langston>;
using TangentialModels = Models<Mindlin, SpringDashpot, SpringTangential, ViscousTangential, WaltonBraunTangential>;
using RollingModels = Models<NoLaw, ConstantRolling, SpringRolling, ViscousCoulombRolling, EpsdRolling>;
using TwistingModels = Models<NoLaw, Twisting>;
/// Adhesion of the surfaces in contact, and forces along the line of centres, also beyond touching, that do not press
/// the surfaces together.
using AdhesionModels = Models<NoLaw, Jkr, Dmt, AutomaticAdhesion>;
using DlvoModels = Models<NoLaw, VdwDlvo, ElectrostaticDlvo, FullDlvo>;
using BridgeModels = Models<NoLaw, CapillaryBridge>;
using InterfacialModels = Models<NoLaw, Interfacial>;
using LubricationModels = Models<NoLaw, SqueezeFilm>;

}  // namespace silt
