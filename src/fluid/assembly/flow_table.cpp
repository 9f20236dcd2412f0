#include "fluid/assembly/flow_table.hpp"

#include <cmath>
#include <map>
#include <stdexcept>

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
  if (simplex && order == 1)  // as flow_term takes it
    for (int q = 0; q < rule.points; ++q)
      for (int a = 0; a < cell_nodes(cell); ++a)
        if (rule.points != cell_nodes(cell) || (a == q) != (table.N[q][a] > 0.5) ||
            (a != q && std::abs(table.N[q][a] - table.N[q][q == 0]) > 1e-15))
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
