#pragma once
#include "base/models.hpp"
#include "coupling/drag/beetstra.hpp"
#include "coupling/drag/di_felice.hpp"
#include "coupling/drag/ergun.hpp"
#include "coupling/drag/gidaspow.hpp"
#include "coupling/drag/haider_levenspiel.hpp"
#include "coupling/drag/koch_hill.hpp"
#include "coupling/drag/mazza.hpp"
#include "coupling/drag/none.hpp"
#include "coupling/drag/rong.hpp"
#include "coupling/drag/schiller_naumann.hpp"
#include "coupling/drag/stokes_cunningham.hpp"
#include "coupling/drag/tang.hpp"
#include "coupling/drag/wen_yu.hpp"

namespace silt {

/// The drag laws a user can choose by `-drag_type`; a new law is one header and one entry here. Each gives the exchange
/// coefficient k_p (kg/s) of a particle, F = k_p (u - v), u the interstitial velocity, in the sense of model A: the
/// drag beside the pressure-gradient force.
using DragModels =
    Models<GidaspowDrag, NoDrag, StokesCunninghamDrag, SchillerNaumannDrag, HaiderLevenspielDrag, DiFeliceDrag,
           WenYuDrag, ErgunDrag, BeetstraDrag, KochHillDrag, RongDrag, TangDrag, MazzaDrag>;

}  // namespace silt
