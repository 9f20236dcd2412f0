#include "particles/walls/box_tree.hpp"

#include <numeric>

namespace silt {

BoxTree::BoxTree(const std::vector<Box>& boxes) : items_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(items_.begin(), items_.end(), 0);
  nodes_.reserve(boxes.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<int>(boxes.size()), boxes);
  boxes_.reserve(boxes.size());
  for (int item : items_) boxes_.push_back(boxes[item]);
}

void BoxTree::split(int node, int first, int count, const std::vector<Box>& boxes) {
  constexpr int leaf = 4;
  Box box, centres;
  for (int k = first; k < first + count; ++k) {
    box.add(boxes[items_[k]]);
    centres.add(0.5 * (boxes[items_[k]].lower + boxes[items_[k]].upper));
  }
  nodes_[node].box = box;
  if (count <= leaf) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  // Halves at the median (never empty, so the depth is at most log2 of the count) along the longest extent of centres.
  int axis = 0;
  (centres.upper - centres.lower).maxCoeff(&axis);
  const auto begin = items_.begin() + first, middle = begin + count / 2;
  std::nth_element(begin, middle, begin + count, [&](int a, int b) {
    const double ca = boxes[a].lower[axis] + boxes[a].upper[axis], cb = boxes[b].lower[axis] + boxes[b].upper[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const int left = static_cast<int>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = left;
  split(left, first, count / 2, boxes);
  split(left + 1, first + count / 2, count - count / 2, boxes);
}

}  // namespace silt
