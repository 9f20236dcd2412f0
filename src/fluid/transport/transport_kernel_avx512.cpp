#include "fluid/transport/transport_kernel.hpp"

namespace silt {
TransportKernel transport_kernel_avx512(Cell cell) { return transport_kernel_of<8>(cell); }
}  // namespace silt
