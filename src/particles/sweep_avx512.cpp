#define SILT_ISA avx512
#define SILT_LANES 8
#include "particles/sweep_kernels.hpp"

namespace silt {
const Kernels avx512_kernels = {"avx512",           avx512::pair_sweep, avx512::candidate_sweep, avx512::contact_census,
                                avx512::wall_sweep, avx512::integrate,  avx512::near_sphere,     avx512::near_row};
}
