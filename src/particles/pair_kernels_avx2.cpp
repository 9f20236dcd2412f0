#define SILT_ISA avx2
#define SILT_LANES 4
#include "particles/pair_kernels.hpp"

namespace silt {
const PairKernels avx2_pair_kernels = {avx2::dipoles, avx2::charges};
}
