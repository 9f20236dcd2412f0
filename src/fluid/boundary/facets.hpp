#pragma once
#include <array>
#include <vector>

#include "base/mesh.hpp"

namespace silt {

/// One quadrature point of a boundary facet.
struct FacetPoint {
  Vec3 x;                       ///< m
  Vec3 area;                    ///< m2, outward normal times weight times area (m in 2D)
  std::array<double, 4> shape;  ///< values of the facet's nodal shape functions
};

/// A boundary facet with its nodes and quadrature, made once per mesh.
struct FacetRule {
  int boundary = 0;  ///< index into Mesh::boundaries
  int cell = 0;      ///< local cell
  int nodes = 0, points = 0;
  std::array<int, 4> node{};  ///< local nodes, ordered as the outward facet
  std::array<FacetPoint, 6> point{};
};

/// The rules of all facets of local cells; exact on flat facets for a shape function times a quadratic (a given inflow
/// profile keeps its flow).
std::vector<FacetRule> facet_rules(const Mesh& mesh);

}  // namespace silt
