#pragma once
#include "base/element.hpp"

namespace silt {

/// Shape functions at the quadrature points of a cell: velocity functions N (order 1 or 2) and vertex functions M
/// (pressure, void fraction and geometry).
struct FlowTable {
  int points = 0;
  double weight[27];
  double N[27][27], dN[27][27][3];
  double M[27][8], dM[27][8][3];
};

/// The table of a cell for velocity functions of the given order, made once.
const FlowTable& flow_table(Cell cell, int order);

}  // namespace silt
