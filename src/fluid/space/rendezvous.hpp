#pragma once
#include <array>
#include <vector>

namespace silt {

/// For every named thing of this rank the least `value` that any rank offers under the same name. Names meet on a rank
/// that follows from the name alone, so no rank needs to know who shares what. Collective.
std::vector<long long> least_over_ranks(const std::vector<std::array<long long, 8>>& names,
                                        const std::vector<long long>& values);

}  // namespace silt
