#include "particles/walls/convex_parts.hpp"

#include <cstdint>
#include <unordered_map>

#include "particles/walls/point_index.hpp"

namespace silt {
namespace {

using Loop = std::vector<int>;  // corners, anticlockwise seen from outside the domain

/// The facets of a patch as polygons over numbered points.
class PatchPolygons {
 public:
  PatchPolygons(const Surface& surface, const Patch& patch) : outward_(-patch.normal), points_(4 * surface.tolerance) {
    for (int f : patch.facets) {
      const auto& facet = surface.facets[f];
      Loop loop;
      for (int k = 0; k < facet.corners; ++k) loop.push_back(points_(facet.corner[k]));
      own(loop, static_cast<int>(loops_.size()));
      loops_.push_back(std::move(loop));
    }
  }

  /// The outline of all facets when it is one convex loop, else nothing.
  Loop convex_outline() const {
    std::unordered_map<int, int> next;
    for (const auto& loop : loops_)
      for (size_t k = 0; k < loop.size(); ++k) {
        const int a = loop[k], b = loop[(k + 1) % loop.size()];
        if (owner(b, a) < 0 && !next.emplace(a, b).second) return {};
      }
    if (next.empty()) return {};
    int start = next.begin()->first;
    for (const auto& [a, b] : next) start = std::min(start, a);
    Loop outline;
    for (int at = start; outline.empty() || at != start;) {
      outline.push_back(at);
      const auto found = next.find(at);
      if (found == next.end() || outline.size() > next.size()) return {};
      at = found->second;
    }
    if (outline.size() != next.size()) return {};
    outline = straightened(outline);
    for (size_t k = 0; k < outline.size(); ++k)
      if (!turns_left(outline[k], outline[(k + 1) % outline.size()], outline[(k + 2) % outline.size()])) return {};
    return outline;
  }

  /// Joins neighbours as long as their union is convex.
  std::vector<Loop> merged() {
    for (int p = 0; p < static_cast<int>(loops_.size()); ++p)
      for (bool grown = !loops_[p].empty(); grown;) {
        grown = false;
        for (size_t k = 0; k < loops_[p].size() && !grown; ++k) grown = join(p, k);
      }
    std::vector<Loop> result;
    for (const auto& loop : loops_)
      if (!loop.empty()) result.push_back(straightened(loop));
    return result;
  }

  const Vec3& point(int id) const { return points_[id]; }

 private:
  static std::uint64_t key(int a, int b) { return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b); }
  int owner(int a, int b) const {
    const auto found = owner_.find(key(a, b));
    return found == owner_.end() ? -1 : found->second;
  }
  void own(const Loop& loop, int polygon) {
    for (size_t k = 0; k < loop.size(); ++k) owner_[key(loop[k], loop[(k + 1) % loop.size()])] = polygon;
  }
  /// Sine of the turn from a-b to b-c, positive to the left.
  double turn(int a, int b, int c) const {
    const Vec3 first = points_[b] - points_[a], second = points_[c] - points_[b];
    return first.cross(second).dot(outward_) / (first.norm() * second.norm());
  }
  bool turns_left(int a, int b, int c) const { return turn(a, b, c) > -1e-7; }

  /// Without the corners on straight sides.
  Loop straightened(const Loop& loop) const {
    Loop result;
    for (size_t k = 0; k < loop.size(); ++k) {
      const int before = result.empty() ? loop.back() : result.back();
      if (std::abs(turn(before, loop[k], loop[(k + 1) % loop.size()])) > 1e-7) result.push_back(loop[k]);
    }
    return result;
  }

  /// Joins polygon p with its neighbour across side k if the union is convex: two convex polygons share one straight
  /// chain of sides, and only the corners at its ends can become concave.
  bool join(int p, size_t k) {
    const Loop& mine = loops_[p];
    const size_t n = mine.size();
    const int q = owner(mine[(k + 1) % n], mine[k]);
    if (q < 0 || q == p) return false;
    size_t first = k, count = 1;
    while (count < n && owner(mine[first], mine[(first + n - 1) % n]) == q) first = (first + n - 1) % n, ++count;
    while (count < n && owner(mine[(first + count + 1) % n], mine[(first + count) % n]) == q) ++count;
    const Loop& other = loops_[q];
    const size_t m = other.size();
    if (count >= n || count >= m) return false;
    // The chain runs from corner `first` to `first + count` of p, backwards in q.
    const int head = mine[first], tail = mine[(first + count) % n];
    size_t at = 0;
    while (at < m && other[at] != head) ++at;
    if (at == m) return false;
    if (other[(at + m - count) % m] != tail) return false;
    const int before = mine[(first + n - 1) % n], after = mine[(first + count + 1) % n];
    if (!turns_left(before, head, other[(at + 1) % m])) return false;
    if (!turns_left(other[(at + 2 * m - count - 1) % m], tail, after)) return false;
    Loop joined;
    for (size_t s = first + count; s < first + n; ++s) joined.push_back(mine[s % n]);
    for (size_t s = at; s < at + m - count; ++s) joined.push_back(other[s % m]);
    for (size_t s = 0; s < count; ++s) {
      owner_.erase(key(mine[(first + s) % n], mine[(first + s + 1) % n]));
      owner_.erase(key(mine[(first + s + 1) % n], mine[(first + s) % n]));
    }
    loops_[q].clear();
    loops_[p] = std::move(joined);
    own(loops_[p], p);
    return true;
  }

  Vec3 outward_;
  PointIndex points_;
  std::vector<Loop> loops_;
  std::unordered_map<std::uint64_t, int> owner_;
};

}  // namespace

std::vector<std::vector<Vec3>> convex_parts(const Surface& surface, const Patch& patch) {
  PatchPolygons polygons(surface, patch);
  std::vector<Loop> loops;
  if (auto outline = polygons.convex_outline(); !outline.empty())
    loops.push_back(std::move(outline));
  else
    loops = polygons.merged();
  std::vector<std::vector<Vec3>> result;
  for (const auto& loop : loops) {
    auto& corners = result.emplace_back();
    for (int id : loop) corners.push_back(polygons.point(id));
  }
  return result;
}

}  // namespace silt
