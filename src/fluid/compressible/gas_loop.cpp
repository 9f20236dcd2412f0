#include "fluid/compressible/gas_loop.hpp"

#include "fluid/assembly/flow_data.hpp"
#include "fluid/compressible/gas_loop_of.hpp"

namespace silt {

GasLoop gas_loop_sse2(Cell cell) { return gas_loop_of<2>(cell); }

GasLoop gas_loop(Cell cell, int lanes) {
  if (lanes == 0) lanes = widest_lanes();
  if (lanes == 8) return gas_loop_avx512(cell);
  if (lanes == 4) return gas_loop_avx2(cell);
  return gas_loop_sse2(cell);
}

}  // namespace silt
