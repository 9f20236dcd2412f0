#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>

namespace silt {

/// Random numbers by counting: the k-th number of a stream is a hash of (seed, stream, k), the same on every machine,
/// compiler and rank count (SplitMix64's finaliser; Steele, Lea & Flood 2014).
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream)
      : key_(mix(mix(seed) + 0x9E3779B97F4A7C15ull * (stream + 1))) {}

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(mix(key_ + 0x9E3779B97F4A7C15ull * ++counter_) >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Whole number in [0, count).
  std::uint64_t below(std::uint64_t count) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
  }
  /// How many numbers were drawn, and how to go on after as many.
  std::uint64_t drawn() const { return counter_; }
  void go_on_after(std::uint64_t count) { counter_ = count; }
  /// Mean 0, standard deviation 1 (Box & Muller 1958).
  double normal() {
    const double u = 1 - uniform(), v = uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
  }

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  std::uint64_t key_, counter_ = 0;
};

}  // namespace silt
