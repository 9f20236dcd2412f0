#include "fluid/transport/transport_kernel.hpp"

namespace silt {
TransportKernel transport_kernel_avx2(Cell cell) { return transport_kernel_of<4>(cell); }
}  // namespace silt
