// What can be wrong with an STL surface.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "particles/walls/box_tree.hpp"
#include "particles/walls/point_index.hpp"
#include "particles/walls/stl_file.hpp"

namespace silt {
namespace {

Vec3 area_of(const StlFacet& f) { return 0.5 * (f.corner[1] - f.corner[0]).cross(f.corner[2] - f.corner[0]); }

/// Whether the segment goes through the inside of the facet, off its edges and with its ends clear of the plane.
bool pierces(const Vec3& a, const Vec3& b, const StlFacet& facet, double tolerance) {
  const Vec3 area = area_of(facet);
  const double size = area.norm();
  const Vec3 normal = area / size;
  const double da = normal.dot(a - facet.corner[0]), db = normal.dot(b - facet.corner[0]);
  if (std::abs(da) <= tolerance || std::abs(db) <= tolerance || (da > 0) == (db > 0)) return false;
  const Vec3 x = a + da / (da - db) * (b - a);
  for (int k = 0; k < 3; ++k) {
    const Vec3 &p = facet.corner[k], &q = facet.corner[(k + 1) % 3];
    if (normal.dot((q - p).cross(x - p)) <= tolerance * (q - p).norm()) return false;
  }
  return true;
}

class Checker {
 public:
  Checker(const std::vector<StlFacet>& facets, const std::string& file) : facets_(facets), file_(file) {
    Box box;
    for (const auto& facet : facets)
      for (const Vec3& corner : facet.corner) {
        if (!corner.allFinite()) refuse(number(facet), "has a corner that is not a number");
        box.add(corner);
      }
    tolerance_ = 2e-7 * std::max({box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff()});
    PointIndex points(tolerance_);
    for (const auto& facet : facets)
      corners_.push_back({points(facet.corner[0]), points(facet.corner[1]), points(facet.corner[2])});
  }

  void shapes() const {
    std::map<std::array<int, 3>, int> known;
    for (int f = 0; f < count(); ++f) {
      const StlFacet& facet = facets_[f];
      double longest = 0;
      for (int k = 0; k < 3; ++k) longest = std::max(longest, (facet.corner[k] - facet.corner[(k + 1) % 3]).norm());
      const Vec3 area = area_of(facet);
      if (2 * area.norm() <= 4 * tolerance_ * longest)
        refuse(f, fmt::format("is degenerate: its height is {:.3g} m", longest > 0 ? 2 * area.norm() / longest : 0.0));
      if (facet.normal.norm() > 0.5 && facet.normal.normalized().dot(area.normalized()) < -0.5)
        refuse(f, "is inverted: its normal is against the order of its corners");
      auto sorted = corners_[f];
      std::sort(sorted.begin(), sorted.end());
      if (const auto [at, fresh] = known.emplace(sorted, f); !fresh)
        refuse(f, fmt::format("is facet {} once more", at->second + 1));
    }
  }

  void closed() const {
    std::map<std::pair<int, int>, std::vector<int>> users;
    for (int f = 0; f < count(); ++f)
      for (int k = 0; k < 3; ++k) users[{corners_[f][k], corners_[f][(k + 1) % 3]}].push_back(f);
    std::vector<int> against_neighbours(facets_.size(), 0);
    int open = -1;
    Vec3 where = Vec3::Zero();
    for (const auto& [edge, along] : users) {
      const auto back = users.find({edge.second, edge.first});
      const std::size_t others = back == users.end() ? 0 : back->second.size();
      if (along.size() <= others) continue;
      if (along.size() == 1 && (open < 0 || along[0] < open)) {
        open = along[0];
        for (int k = 0; k < 3; ++k)
          if (corners_[open][k] == edge.first)
            where = 0.5 * (facets_[open].corner[k] + facets_[open].corner[(k + 1) % 3]);
      }
      if (along.size() > 1)
        for (const int f : along) ++against_neighbours[f];
    }
    const auto worst = std::max_element(against_neighbours.begin(), against_neighbours.end());
    if (*worst > 0)
      refuse(static_cast<int>(worst - against_neighbours.begin()),
             fmt::format("is inverted: {} of its neighbours face the other way", *worst));
    if (open >= 0)
      refuse(open, fmt::format("has an open edge at ({:.4g}, {:.4g}, {:.4g}) m: the surface encloses no volume (close "
                               "it, or choose side both)",
                               where[0], where[1], where[2]));
    double volume = 0;
    const Vec3 origin = facets_[0].corner[0];
    for (const auto& facet : facets_) volume += area_of(facet).dot(facet.corner[0] - origin) / 3;
    if (volume < 0) refuse(0, "and all others are inverted: the normals of a closed surface must point outwards");
  }

  void crossings() const {
    std::vector<Box> boxes;
    for (const auto& facet : facets_) {
      Box box;
      for (const Vec3& corner : facet.corner) box.add(corner);
      boxes.push_back(box);
    }
    const BoxTree tree(boxes);
    for (int f = 0; f < count(); ++f) {
      const Vec3 middle = 0.5 * (boxes[f].lower + boxes[f].upper);
      tree.within(middle, 0.5 * (boxes[f].upper - boxes[f].lower).norm(), [&](int g) {
        if (g <= f || !boxes[f].meets(boxes[g])) return;
        for (int k = 0; k < 3; ++k)
          if (pierces(facets_[f].corner[k], facets_[f].corner[(k + 1) % 3], facets_[g], 2 * tolerance_) ||
              pierces(facets_[g].corner[k], facets_[g].corner[(k + 1) % 3], facets_[f], 2 * tolerance_))
            refuse(f, fmt::format("crosses facet {}", g + 1));
      });
    }
  }

 private:
  int count() const { return static_cast<int>(facets_.size()); }
  int number(const StlFacet& facet) const { return static_cast<int>(&facet - facets_.data()); }
  [[noreturn]] void refuse(int facet, const std::string& what) const {
    throw UserError(fmt::format("{}: facet {} {}", file_, facet + 1, what));
  }

  const std::vector<StlFacet>& facets_;
  const std::string& file_;
  double tolerance_;  ///< m, single precision of the coordinates
  std::vector<std::array<int, 3>> corners_;
};

}  // namespace

void check_stl(const std::vector<StlFacet>& facets, bool closed, const std::string& file) {
  const Checker checker(facets, file);
  checker.shapes();
  if (closed) checker.closed();
  checker.crossings();
}

}  // namespace silt
