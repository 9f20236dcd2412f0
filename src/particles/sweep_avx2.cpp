#define SILT_ISA avx2
#define SILT_LANES 4
#include "particles/sweep_kernels.hpp"

namespace silt {
const Kernels avx2_kernels = {"avx2",           avx2::pair_sweep, avx2::candidate_sweep, avx2::contact_census,
                              avx2::wall_sweep, avx2::integrate,  avx2::near_sphere,     avx2::near_row};
}
