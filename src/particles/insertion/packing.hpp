#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/vector.hpp"

namespace silt {

/// Spheres that have been placed, in bins, so that overlaps are found in constant time; periodic where the domain is.
class Packing {
 public:
  /// `period`: length in periodic directions, else 0. m
  explicit Packing(const Vec3& period) : period_(period) {}

  void add(const Vec3& centre, double radius);
  int count() const { return static_cast<int>(centres_.size()); }

  /// The sphere that overlaps a given one most, and by how much of the smaller radius; index -1: none touches.
  struct Overlap {
    int index = -1;
    double share = 0;
  };
  Overlap deepest(const Vec3& centre, double radius) const;
  /// Whether a sphere would overlap another one.
  bool blocked(const Vec3& centre, double radius) const;

 private:
  using Bin = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Bin& b) const {
      std::uint64_t h = 0x243F6A8885A308D3ull;
      for (auto v : b) h = (h ^ static_cast<std::uint64_t>(v)) * 0x9E3779B97F4A7C15ull, h ^= h >> 31;
      return h;
    }
  };
  /// Calls visit(index, distance) for spheres that may touch, until it returns true.
  template <class Visit>
  bool around(const Vec3& centre, double radius, Visit&& visit) const;
  Bin bin(const Vec3& centre) const;
  void rebin(double largest);

  Vec3 period_;
  double largest_ = 0;                  ///< m, largest radius that the bins allow for
  Vec3 width_ = Vec3::Ones();           ///< m, of the bins; whole numbers of them fit a period
  std::array<std::int64_t, 3> bins_{};  ///< per period, 0 where not periodic
  std::vector<Vec3> centres_;
  std::vector<double> radii_;
  std::vector<int> next_;  ///< next sphere of the same bin, -1: last
  std::unordered_map<Bin, int, Hash> first_;
};

}  // namespace silt
