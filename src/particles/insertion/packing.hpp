#pragma once
#include <array>
#include <cstdint>
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
  /// Calls visit(index, distance) for spheres that may touch, until it returns true.
  template <class Visit>
  bool around(const Vec3& centre, double radius, Visit&& visit) const;
  /// Place in first_ of a bin, by hashing: spheres of other bins may share it.
  std::size_t slot(Bin bin) const;
  Bin bin(const Vec3& centre) const;
  void link(int sphere);
  /// Files all spheres again, for a larger radius or more spheres.
  void refile();

  Vec3 period_;
  double largest_ = 0;                  ///< m, largest radius that the bins allow for
  Vec3 width_ = Vec3::Ones();           ///< m, of the bins; whole numbers of them fit a period
  std::array<std::int64_t, 3> bins_{};  ///< per period, 0 where not periodic
  std::vector<Vec3> centres_;
  std::vector<double> radii_;
  std::vector<int> first_, next_;  ///< first sphere of a slot, next one of the same slot; -1: none
};

}  // namespace silt
