#define SILT_ISA avx512
#define SILT_LANES 8
#include "particles/pair_kernels.hpp"

namespace silt {
const PairKernels avx512_pair_kernels = {avx512::dipoles, avx512::charges};
}
