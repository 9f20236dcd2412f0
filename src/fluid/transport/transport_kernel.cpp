#include "fluid/transport/transport_kernel.hpp"

namespace silt {

TransportKernel transport_kernel_sse2(Cell cell) { return transport_kernel_of<2>(cell); }

TransportKernel transport_kernel(Cell cell) {
  const int lanes = widest_lanes();
  return lanes == 8   ? transport_kernel_avx512(cell)
         : lanes == 4 ? transport_kernel_avx2(cell)
                      : transport_kernel_sse2(cell);
}

}  // namespace silt
