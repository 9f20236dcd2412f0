#define SILT_LANES 8
#include "fluid/pressure_correction/cell_loop_kernels.hpp"

namespace silt {
const CellLoopTable* cell_loops_avx512(int kind) { return tables[kind]; }
}  // namespace silt
