#include "fluid/assembly/flow_table.hpp"

#include <map>

#include "fluid/space/quadratic_element.hpp"

namespace silt {
namespace {

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
