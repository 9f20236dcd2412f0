#pragma once
#include <array>
#include <vector>

#include "base/vector.hpp"

namespace silt {

/// A binary tree of boxes over segments (2D) or triangles, for the distance to the nearest of them.
class FacetTree {
 public:
  using Facet = std::array<Vec3, 3>;  ///< corners, m; a segment repeats its last

  explicit FacetTree(std::vector<Facet> facets);
  bool empty() const { return facets_.empty(); }
  /// m, exact distance to the nearest facet, if it is below `bound`; else `bound`.
  double distance(const Vec3& x, double bound) const;

 private:
  struct Node {
    Vec3 lower, upper;
    int first, count;  ///< facets of a leaf
    int right;         ///< the other child; the first one follows its parent
  };
  int build(int first, int last);

  std::vector<Facet> facets_;
  std::vector<Node> nodes_;
};

}  // namespace silt
