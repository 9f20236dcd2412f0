#pragma once
#include <array>
#include <span>
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// Where a point lies, as seen by this rank.
struct Place {
  enum class State {
    inside,    ///< in the local cell `cell`, at the reference coordinates xi
    remote,    ///< left this rank through a facet towards rank `rank`
    boundary,  ///< left the domain through boundary `boundary` (index into Mesh::boundaries), as far as this rank can
               ///< tell
    missing    ///< in no local cell
  };
  State state = State::missing;
  int cell = -1, rank = -1, boundary = -1;
  std::array<double, 3> xi{0, 0, 0};  ///< reference coordinates in `cell` (element.hpp)
  std::array<int, 3> wrap{0, 0, 0};   ///< periods to add to the point: it lies at x + wrap * Locator::period()
  bool inside() const { return state == State::inside; }
};

/// Finds the cells of points: a walk from cell to cell over cached inverse maps, with a grid of bins behind it.
///
/// Simplices and parallelepipeds have an affine map; other quadrilaterals and hexahedra are inverted by Newton's method
/// on the (bi-, tri-)linear map. A point counts as inside a cell up to 1e-10 in reference coordinates, so that no point
/// falls between two cells. Ties (points on facets, edges, vertices): the lowest local cell around the point; where a
/// facet through the point leads to a lower rank, that rank. Nothing here depends on the order of calls.
///
/// Who follows moving points: find(x, cell); `inside` is final; hand `remote` to that rank, which looks with find(x);
/// what is neither (boundary, missing, not found on arrival) goes to settle(), which knows all ranks and is final.
class Locator {
 public:
  explicit Locator(const Mesh& mesh);

  /// The cell of the point x (3 doubles). `hint`: a local cell near it, or -1 for a search through the bins. On a
  /// periodic mesh x may lie a period outside. Local, no communication.
  Place find(const double* x, int hint = -1) const;
  Place find(const Vec3& x, int hint = -1) const { return find(x.data(), hint); }

  /// Which of `count` points, `stride` doubles apart, are so far inside the cells they were in that find() with these
  /// as hints would say `inside` there without a wrap: 1, else 0 (ask find(), which may say the same). Most points that
  /// move are.
  void well_inside(const double* x, std::size_t stride, const int* cells, int count, unsigned char* inside) const;

  /// find() for many points; `hints` is empty or gives a cell for each.
  std::vector<Place> find(std::span<const Vec3> points, std::span<const int> hints = {}) const;

  /// Where the caller's points lie among all ranks: `inside` when this rank is the lowest that holds it, `remote` with
  /// the lowest rank that does, or else `boundary` with the boundary nearest to the point. Never `missing`. Every rank
  /// brings its own points. Collective.
  std::vector<Place> settle(std::span<const Vec3> points) const;

  /// Which of the given points (the same list on every rank) this rank holds: `inside` on exactly one rank for each
  /// point in the domain, `missing` on the others. For creating particles. Collective.
  std::vector<Place> claim(std::span<const Vec3> points) const;

  /// The local cell that holds the point, as claim() sees it: `inside` also where a tie would go to a lower rank. For a
  /// point that settle() sent here. Local.
  Place held(const Vec3& x) const;

  /// Reference coordinates of x in a given cell, whether inside or not (no wrap). False when the map could not be
  /// inverted there.
  bool reference(int cell, const double* x, double* xi) const;

  /// Lengths of the periods, 0 in directions that have none. m
  const Vec3& period() const { return period_; }
  /// The point moved into the box by the wrap of its place.
  Vec3 wrapped(const Vec3& x, const Place& place) const {
    return {x[0] + place.wrap[0] * period_[0], x[1] + place.wrap[1] * period_[1], x[2] + place.wrap[2] * period_[2]};
  }

 private:
  /// xi = inverse (x - origin): exact for affine cells, the tangent at the centre for others.
  struct InverseMap {
    double origin[3];
    double inverse[3][3];
  };
  template <Cell kind>
  bool invert(int cell, const double* x, double* xi) const;
  template <Cell kind>
  Place walk(const double* x, int hint) const;
  template <Cell kind>
  Place search(const double* x) const;
  template <Cell kind>
  void search_bin(const double* x, Place& place) const;
  template <Cell kind>
  Place lowest_around(const double* x, const Place& place) const;
  template <Cell kind>
  Place find_kind(const double* x, int hint) const;
  template <Cell kind>
  void well_inside_kind(const double* x, std::size_t stride, const int* cells, int count, unsigned char* inside) const;
  template <Cell kind>
  void build_maps();
  void build_bins();
  void build_wraps();
  void to_box(double* x, std::array<int, 3>& wrap) const;

  const Mesh& mesh_;
  Vec3 period_ = Vec3::Zero();
  bool periodic_ = false;
  std::vector<InverseMap> maps_;       ///< [cells]
  std::vector<unsigned char> affine_;  ///< [cells]
  std::vector<signed char>
      facet_wraps_;  ///< [cells][facets] on periodic meshes: +-(axis + 1) where crossing adds a period, else 0
  double bin_lower_[3] = {0, 0, 0}, bin_inverse_[3] = {0, 0, 0};
  int bins_[3] = {0, 0, 0};
  std::vector<int> bin_start_, bin_cells_;  ///< cells whose box touches a bin, ascending
  std::vector<double> boxes_;               ///< [cells][6] lower and upper corner of each cell
};

}  // namespace silt
