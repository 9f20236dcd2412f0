#include "particles/sweep.hpp"

#include <fmt/format.h>

#include <string>

#include "base/error.hpp"

namespace silt {

const Kernels& choose_kernels(const char* name) {
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd");
  const std::string wanted = name;
  if ((wanted == "auto" || wanted == "avx512") && avx512) return avx512_kernels;
  if ((wanted == "auto" || wanted == "avx2") && avx2) return avx2_kernels;
  if (wanted == "auto" || wanted == "plain") return plain_kernels;
  throw UserError(fmt::format("-particles_instructions {}: this processor cannot; allowed: auto, plain{}", wanted,
                              avx2 ? ", avx2" : ""));
}

}  // namespace silt
