#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "base/vector.hpp"

namespace silt {

/// An axis-aligned box, m.
struct Box {
  Vec3 lower = Vec3::Constant(1e300), upper = Vec3::Constant(-1e300);
  void add(const Vec3& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  void add(const Box& box) {
    lower = lower.cwiseMin(box.lower);
    upper = upper.cwiseMax(box.upper);
  }
  void grow(double margin) {
    lower.array() -= margin;
    upper.array() += margin;
  }
  bool meets(const Box& other) const {
    return (lower.array() <= other.upper.array()).all() && (other.lower.array() <= upper.array()).all();
  }
  /// Square of the distance from a point; 0 inside.
  double squared_distance(const Vec3& point) const {
    return (lower - point).cwiseMax(point - upper).cwiseMax(Vec3::Zero()).squaredNorm();
  }
};

/// A tree of boxes over a fixed set of items: finds those near a point in logarithmic time, whatever their sizes.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Box>& boxes);

  /// Calls visit(item) for every item whose box is within `radius` of the point.
  template <class Visit>
  void within(const Vec3& point, double radius, Visit&& visit) const {
    if (nodes_.empty()) return;
    const double limit = radius * radius;
    int stack[64], top = 0;
    stack[top++] = 0;
    while (top) {
      const Node& node = nodes_[stack[--top]];
      if (node.box.squared_distance(point) > limit) continue;
      if (node.count == 0) {
        stack[top++] = node.first;
        stack[top++] = node.first + 1;
        continue;
      }
      for (int k = node.first; k < node.first + node.count; ++k)
        if (boxes_[k].squared_distance(point) <= limit) visit(items_[k]);
    }
  }

  /// Visits items in the order of nearing boxes while they may beat `limit`, the squared distance found so far, which
  /// visit(item, limit) lowers.
  template <class Visit>
  void nearest(const Vec3& point, double limit, Visit&& visit) const {
    if (nodes_.empty()) return;
    int stack[64], top = 0;
    stack[top++] = 0;
    while (top) {
      const Node& node = nodes_[stack[--top]];
      if (node.box.squared_distance(point) > limit) continue;
      if (node.count == 0) {
        const bool left_first =
            nodes_[node.first].box.squared_distance(point) < nodes_[node.first + 1].box.squared_distance(point);
        stack[top++] = node.first + (left_first ? 1 : 0);
        stack[top++] = node.first + (left_first ? 0 : 1);
        continue;
      }
      for (int k = node.first; k < node.first + node.count; ++k)
        if (boxes_[k].squared_distance(point) <= limit) visit(items_[k], limit);
    }
  }

 private:
  struct Node {
    Box box;
    int first = 0;  ///< first item of a leaf, or left child (the right one follows)
    int count = 0;  ///< items of a leaf, 0 for a branch
  };
  void split(int node, int first, int count, const std::vector<Box>& boxes);
  std::vector<Node> nodes_;
  std::vector<int> items_;
  std::vector<Box> boxes_;  ///< in the order of items_
};

}  // namespace silt
