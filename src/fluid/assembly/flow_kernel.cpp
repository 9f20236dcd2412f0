#include "fluid/assembly/flow_kernel.hpp"

namespace silt {

FlowKernel flow_kernel_sse2(Cell cell, int order) { return flow_kernel_of<2>(cell, order); }

FlowKernel flow_kernel(Cell cell, int order, int lanes) {
  __builtin_cpu_init();
  if (lanes == 0)
    lanes = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")
                ? 8
            : __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? 4
                                                                              : 2;
  if (lanes == 8) return flow_kernel_avx512(cell, order);
  if (lanes == 4) return flow_kernel_avx2(cell, order);
  return flow_kernel_sse2(cell, order);
}

}  // namespace silt
