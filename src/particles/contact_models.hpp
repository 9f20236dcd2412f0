#pragma once
#include "base/models.hpp"
#include "particles/normal/linear.hpp"
#include "particles/normal/tsuji.hpp"
#include "particles/rolling/constant.hpp"
#include "particles/rolling/none.hpp"
#include "particles/tangential/mindlin.hpp"
#include "particles/tangential/spring_dashpot.hpp"

namespace silt {

/// The contact laws a user can choose; a new law is one header and one entry here.
using NormalModels = Models<Tsuji, Linear>;
using TangentialModels = Models<Mindlin, SpringDashpot>;
using RollingModels = Models<NoRolling, ConstantRolling>;

}  // namespace silt
