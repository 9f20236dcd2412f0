#pragma once
#include "fluid/assembly/flow_table.hpp"
#include "fluid/compressible/gas.hpp"

namespace silt {

/// What the element loop of the compressible equations reads: fields at the nodes and per cell, in the units of GasLaw.
struct GasData {
  const FlowTable* table;
  GasLaw law;
  const int* cell_nodes;
  const double* coordinates;                         ///< [cells][nodes][3]
  const double *state, *known, *source;              ///< [nodes][size]
  const double *alpha, *alpha_rate;                  ///< [nodes]
  const double *carried, *viscosity, *normal;        ///< GasFrozen
  const double *eddy_viscosity, *eddy_conductivity;  ///< [cells]; null: laminar
  double rate, gravity[3];
  bool axisymmetric, porous, lumped;
};

/// Residual [lanes][rows] and, when not null, Jacobian [lanes][rows][rows] of the cells first ... first + count - 1,
/// count <= lanes.
struct GasLoop {
  int lanes;
  void (*evaluate)(const GasData& data, int first, int count, double* residual, double* matrix);
};

/// For the widest vectors of this processor; `lanes` 2, 4 or 8 asks for others (tests).
GasLoop gas_loop(Cell cell, int lanes = 0);

}  // namespace silt
