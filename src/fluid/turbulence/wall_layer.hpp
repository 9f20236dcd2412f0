#pragma once
#include <span>
#include <vector>

#include "fluid/boundary/boundary_conditions.hpp"
#include "fluid/turbulence/vertex_rule.hpp"

namespace silt {

/// The cells that touch no_slip boundaries, their nodes on the wall and their first nodes off it.
class WallLayer {
 public:
  enum Kind : char { interior, wall, near };

  /// `distance` [nodes] m. Collective.
  WallLayer(const Mesh& mesh, const BoundaryConditions& boundaries, const std::vector<double>& distance);

  /// [nodes]
  const std::vector<Kind>& kind() const { return kind_; }
  /// [nodes] m, of a near node its distance from the wall, of a wall node that of the near nodes of its cells.
  const std::vector<double>& height() const { return height_; }
  struct WallCell {
    int cell;
    double height;  ///< m, mean distance of its near nodes
  };
  const std::vector<WallCell>& cells() const { return cells_; }

  /// [nodes] m/s, speed relative to the wall along it, at wall nodes that of the near nodes of their cells. Collective.
  std::vector<double> speed(std::span<const double> velocity) const;
  /// Overwrites field [nodes] at wall nodes with the mean of the near nodes of their cells. Collective.
  void extend(std::vector<double>& field) const;
  /// Mean of a nodal field over the near nodes of a wall cell.
  double mean(int cell, std::span<const double> field) const;

 private:
  const Mesh& mesh_;
  std::vector<Kind> kind_;
  std::vector<double> height_, normal_;  ///< normal_ [nodes][3] gradient of the distance, unit
  std::vector<WallCell> cells_;
};

}  // namespace silt
