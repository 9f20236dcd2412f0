#include "fluid/compressible/gas_loop_of.hpp"

namespace silt {
GasLoop gas_loop_avx2(Cell cell) { return gas_loop_of<4>(cell); }
}  // namespace silt
