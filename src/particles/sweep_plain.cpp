#define SILT_ISA plain
#define SILT_LANES 4
#include "particles/sweep_kernels.hpp"

namespace silt {
const Kernels plain_kernels = {"plain",           plain::pair_sweep, plain::candidate_sweep, plain::contact_census,
                               plain::wall_sweep, plain::integrate,  plain::near_sphere,     plain::near_row};
}
