#pragma once
#include <cstddef>
#include <vector>

namespace silt {

/// A new order of a rank's particles, applied to one array after the other in place: new entry k is what order[k] was.
/// Either a permutation, or the ascending places of those that are kept.
class Rearrangement {
 public:
  explicit Rearrangement(const std::vector<int>& order, int before) : order_(order) {
    if (static_cast<int>(order.size()) < before) {
      kept_only_ = true;
      return;
    }
    // One member of each cycle; in a rank's particles, which move little between two sortings, most stand alone.
    std::vector<bool> seen(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (seen[k] || order[k] == static_cast<int>(k)) continue;
      first_.push_back(static_cast<int>(k));
      for (int at = static_cast<int>(k); !seen[at]; at = order[at]) seen[at] = true;
    }
  }
  bool nothing_moves() const { return !kept_only_ && first_.empty(); }

  /// `width` entries a particle.
  template <class T>
  void apply(T* values, int width = 1) const {
    const auto copy = [width](const T* from, T* to) {
      for (int c = 0; c < width; ++c) to[c] = from[c];
    };
    const auto row = [&](int k) { return values + static_cast<std::ptrdiff_t>(k) * width; };
    if (kept_only_) {
      for (std::size_t k = 0; k < order_.size(); ++k) copy(row(order_[k]), row(static_cast<int>(k)));
      return;
    }
    std::vector<T> aside(width);
    for (const int first : first_) {
      copy(row(first), aside.data());
      int at = first;
      for (; order_[at] != first; at = order_[at]) copy(row(order_[at]), row(at));
      copy(aside.data(), row(at));
    }
  }

 private:
  const std::vector<int>& order_;
  bool kept_only_ = false;
  std::vector<int> first_;
};

}  // namespace silt
