#pragma once
#include <algorithm>
#include <array>

#include "base/element.hpp"

namespace silt {

inline constexpr double inside_tolerance = 1e-10;  ///< in reference coordinates
/// Smaller, so that the cell across a touched facet surely holds the point too.
inline constexpr double tie_tolerance = 1e-11;

/// What each facet means in reference coordinates: the barycentric coordinate that vanishes there, or a side of the
/// unit square or cube.
template <Cell kind>
struct FacetTable {
  static constexpr bool simplex = kind == Cell::triangle || kind == Cell::tetrahedron;
  static constexpr int dimension = cell_dimension(kind), facets = cell_facets(kind), corners = silt::cell_nodes(kind);
  std::array<int, facets> axis{};  ///< simplices: the opposite node
  std::array<bool, facets> high{};

  FacetTable() {
    for (int f = 0; f < facets; ++f) {
      const auto& nodes = facet_node_list(kind, f);
      int all = ~0, none = ~0, sum = 0;
      for (int k = 0; k < facet_nodes(kind); ++k) {
        all &= nodes[k];
        none &= ~nodes[k];
        sum += nodes[k];
      }
      if constexpr (simplex) {
        axis[f] = dimension * (dimension + 1) / 2 - sum;
      } else {
        for (int d = 0; d < dimension; ++d) {
          if (all >> d & 1) axis[f] = d, high[f] = true;
          if (none >> d & 1) axis[f] = d, high[f] = false;
        }
      }
    }
  }
  /// Distance from facet f into the cell, in reference coordinates; negative outside.
  double depth(int f, const double* xi) const {
    if constexpr (simplex) {
      if (axis[f] > 0) return xi[axis[f] - 1];
      double rest = 1;
      for (int d = 0; d < dimension; ++d) rest -= xi[d];
      return rest;
    } else {
      return high[f] ? 1 - xi[axis[f]] : xi[axis[f]];
    }
  }
};

template <Cell kind>
const FacetTable<kind>& facet_table() {
  static const FacetTable<kind> table;
  return table;
}

template <Cell kind>
double least_depth(const double* xi) {
  const auto& table = facet_table<kind>();
  double least = table.depth(0, xi);
  for (int f = 1; f < cell_facets(kind); ++f) least = std::min(least, table.depth(f, xi));
  return least;
}

}  // namespace silt
