#define SILT_ISA plain
#define SILT_LANES 4
#include "particles/pair_kernels.hpp"

namespace silt {
const PairKernels plain_pair_kernels = {plain::dipoles, plain::charges};
}
