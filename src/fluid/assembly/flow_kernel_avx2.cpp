#include "fluid/assembly/flow_kernel.hpp"

namespace silt {
FlowKernel flow_kernel_avx2(Cell cell, int order) { return flow_kernel_of<4>(cell, order); }
}  // namespace silt
