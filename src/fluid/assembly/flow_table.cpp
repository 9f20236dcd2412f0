#include "fluid/assembly/flow_table.hpp"

#include <cmath>
#include <map>
#include <stdexcept>

#include "fluid/space/quadratic_element.hpp"

namespace silt {
namespace {

/// Whether point q is the one nearest to node q, and all other nodes count alike there, as flow_term takes it.
bool stand_by_nodes(const FlowTable& t, int nodes) {
  bool stand = t.points == nodes;
  for (int q = 0; q < t.points && stand; ++q)
    for (int a = 0; a < nodes; ++a) stand &= a == q ? t.N[q][a] > 0.5 : std::abs(t.N[q][a] - t.N[q][q == 0]) < 1e-15;
  return stand;
}

FlowTable make_table(Cell cell, int order) {
  const bool simplex = cell == Cell::triangle || cell == Cell::tetrahedron;
  const Quadrature rule = quadrature(cell, order == 2 ? 5 : simplex ? 2 : 3);
  FlowTable table;
  table.points = rule.points;
  for (int q = 0; q < rule.points; ++q) {
    table.weight[q] = rule.weight[q];
    shape(cell, rule.point[q].data(), table.M[q], table.dM[q]);
    if (order == 1)
      shape(cell, rule.point[q].data(), table.N[q], table.dN[q]);
    else
      quadratic_shape(cell, rule.point[q].data(), table.N[q], table.dN[q]);
  }
  if (simplex && order == 1 && !stand_by_nodes(table, cell_nodes(cell)))
    throw std::logic_error("the points of a linear element must each stand by their own node");
  return table;
}

}  // namespace

const FlowTable& flow_table(Cell cell, int order) {
  static std::map<std::pair<Cell, int>, FlowTable> tables;
  auto [entry, fresh] = tables.try_emplace({cell, order});
  if (fresh) entry->second = make_table(cell, order);
  return entry->second;
}

}  // namespace silt
