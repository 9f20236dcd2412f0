#include "fluid/compressible/gas_loop_of.hpp"

namespace silt {
GasLoop gas_loop_avx512(Cell cell) { return gas_loop_of<8>(cell); }
}  // namespace silt
