#include "fluid/turbulence/facet_tree.hpp"

#include <algorithm>
#include <cmath>

namespace silt {
namespace {

constexpr int leaf_size = 4;

double segment_distance2(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 edge = b - a;
  const double length2 = edge.squaredNorm();
  const double s = length2 > 0 ? std::clamp((x - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
  return (x - a - s * edge).squaredNorm();
}

/// Inside the prism over the triangle the distance to its plane, elsewhere that to the nearest edge.
double facet_distance2(const Vec3& x, const FacetTree::Facet& f) {
  const Vec3 normal = (f[1] - f[0]).cross(f[2] - f[0]);
  const double area2 = normal.squaredNorm();
  bool above = area2 > 0;
  double nearest = 1e300;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &a = f[k], &b = f[(k + 1) % 3];
    above = above && (b - a).cross(x - a).dot(normal) >= 0;
    nearest = std::min(nearest, segment_distance2(x, a, b));
  }
  const double height = normal.dot(x - f[0]);
  return above ? height * height / area2 : nearest;
}

double box_distance2(const Vec3& x, const Vec3& lower, const Vec3& upper) {
  return (x - x.cwiseMax(lower).cwiseMin(upper)).squaredNorm();
}

}  // namespace

FacetTree::FacetTree(std::vector<Facet> facets) : facets_(std::move(facets)) {
  if (!facets_.empty()) build(0, static_cast<int>(facets_.size()));
}

int FacetTree::build(int first, int last) {
  const int place = static_cast<int>(nodes_.size());
  Node node{facets_[first][0], facets_[first][0], first, last - first, -1};
  for (int k = first; k < last; ++k)
    for (const Vec3& corner : facets_[k])
      node.lower = node.lower.cwiseMin(corner), node.upper = node.upper.cwiseMax(corner);
  nodes_.push_back(node);
  if (last - first <= leaf_size) return place;
  int axis = 0;
  (node.upper - node.lower).maxCoeff(&axis);
  const int middle = (first + last) / 2;
  std::nth_element(facets_.begin() + first, facets_.begin() + middle, facets_.begin() + last,
                   [axis](const Facet& a, const Facet& b) {
                     return a[0][axis] + a[1][axis] + a[2][axis] < b[0][axis] + b[1][axis] + b[2][axis];
                   });
  build(first, middle);
  const int right = build(middle, last);
  nodes_[place].right = right;
  nodes_[place].count = 0;
  return place;
}

double FacetTree::distance(const Vec3& x, double bound) const {
  if (empty()) return bound;
  double nearest2 = bound * bound;
  std::array<int, 64> stack;
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    if (box_distance2(x, node.lower, node.upper) >= nearest2) continue;
    if (node.right < 0) {
      for (int k = node.first; k < node.first + node.count; ++k)
        nearest2 = std::min(nearest2, facet_distance2(x, facets_[k]));
      continue;
    }
    int near = static_cast<int>(&node - nodes_.data()) + 1, far = node.right;
    if (box_distance2(x, nodes_[near].lower, nodes_[near].upper) >
        box_distance2(x, nodes_[far].lower, nodes_[far].upper))
      std::swap(near, far);
    stack[size++] = far;
    stack[size++] = near;
  }
  return std::sqrt(nearest2);
}

}  // namespace silt
