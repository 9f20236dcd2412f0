#pragma once
#include "base/element.hpp"

namespace silt {

struct FlowTable;

/// What a cell loop of the transport of a scalar T reads (docs/theory/energy.md, E2): the terms
///   (mass T + known)_h + carried flux.grad T - div(diffusivity grad T) + reaction T
/// of a cell, all in units of the source (W/m3 for the energy equation). The rate of change is interpolated from its
/// nodal values, both ends of the step alike. Plain data only, see flow_kernel.hpp.
struct TransportData {
  const FlowTable* table = nullptr;
  const int* nodes = nullptr;                ///< [cells][nodes of a cell]
  const double* coordinates = nullptr;       ///< [cells][nodes of a cell][3] m
  const double* cell_size = nullptr;         ///< [cells] m, shortest edge
  const double* flux = nullptr;              ///< [cells][points of the table][3] m/s, superficial velocity
  double carried = 1;                        ///< what the flux carries per unit of T (energy: rho c_p)
  const double* mass = nullptr;              ///< [nodes] factor of T in the rate of change
  const double* known = nullptr;             ///< [nodes] history of the rate of change less the sources
  const double* diffusivity = nullptr;       ///< [nodes]
  const double* cell_diffusivity = nullptr;  ///< [cells] added to it; null: nothing
  const double* reaction = nullptr;  ///< [nodes] density of what acts at the nodes; here in the stabilisation only
  const double* load = nullptr;      ///< [nodes] density of the load that acts at the nodes; as reaction
  double supg = 1;                   ///< factor of the streamline stabilisation
};

/// Matrix [lanes][n][n] and right side [lanes][n] of cells first..first+count-1 (count <= lanes).
struct TransportKernel {
  int lanes = 0;
  void (*assemble)(const TransportData& data, int first, int count, double* matrix, double* right) = nullptr;
};
/// For the widest vectors of this machine.
TransportKernel transport_kernel(Cell cell);

}  // namespace silt
