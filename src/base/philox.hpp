#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace silt {

/// Philox4x32-10 (Salmon, Moraes, Dror & Shaw 2011): four 32-bit random numbers as a function of a counter and a key,
/// the same on every machine and in any order.
inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * counter[0], b = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

/// Four independent normal deviates of mean 0 and variance 1 from four random numbers (Box & Muller 1958).
inline std::array<double, 4> normal_deviates(const std::array<std::uint32_t, 4>& random) {
  std::array<double, 4> deviates;
  for (int k = 0; k < 4; k += 2) {
    const double u = (random[k] + 0.5) * 0x1p-32, angle = 2 * std::numbers::pi * (random[k + 1] * 0x1p-32);
    const double size = std::sqrt(-2 * std::log(u));
    deviates[k] = size * std::cos(angle);
    deviates[k + 1] = size * std::sin(angle);
  }
  return deviates;
}

}  // namespace silt
