#include "fluid/assembly/flow_kernel.hpp"

namespace silt {

FlowKernel flow_kernel_sse2(Cell cell, int order) { return flow_kernel_of<2>(cell, order); }

int widest_lanes() {
  __builtin_cpu_init();
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  const bool middle = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return wide ? 8 : middle ? 4 : 2;
}

FlowKernel flow_kernel(Cell cell, int order, int lanes) {
  if (lanes == 0) lanes = widest_lanes();
  if (lanes == 8) return flow_kernel_avx512(cell, order);
  if (lanes == 4) return flow_kernel_avx2(cell, order);
  return flow_kernel_sse2(cell, order);
}

}  // namespace silt
