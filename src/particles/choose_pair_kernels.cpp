#include <string>

#include "particles/pair_sums.hpp"
#include "particles/sweep.hpp"

namespace silt {

const PairKernels& choose_pair_kernels(const char* name) {
  const std::string chosen = choose_kernels(name).name;
  return chosen == "avx512" ? avx512_pair_kernels : chosen == "avx2" ? avx2_pair_kernels : plain_pair_kernels;
}

}  // namespace silt
