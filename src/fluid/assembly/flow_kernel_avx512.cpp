#include "fluid/assembly/flow_kernel.hpp"

namespace silt {
FlowKernel flow_kernel_avx512(Cell cell, int order) { return flow_kernel_of<8>(cell, order); }
}  // namespace silt
