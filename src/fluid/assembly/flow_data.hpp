#pragma once
#include "base/element.hpp"
#include "fluid/equations/volume_averaged_navier_stokes.hpp"

namespace silt {

struct FlowTable;

/// Where the unknowns of a node stand in the local vector of the flow: velocity component c of velocity node v at
/// velocity_stride v + c, pressure of vertex a at pressure_offset + pressure_stride a. Equal order interlaces both
/// (stride dim + 1); Taylor-Hood keeps them apart.
struct FlowLayout {
  int velocity_stride = 0, pressure_offset = 0, pressure_stride = 0, size = 0;
};

/// The arrays a cell loop reads; [v] over velocity nodes, [p] over vertices. Valid during one assembly.
struct FlowData {
  Cell cell = Cell::hexahedron;
  const FlowTable* table = nullptr;
  const int* velocity_nodes = nullptr;     ///< [cells][NV]
  const int* vertices = nullptr;           ///< [cells][NP]
  const double* coordinates = nullptr;     ///< [cells][NP][3]
  const double* cell_size = nullptr;       ///< [cells] m, shortest edge
  const double* eddy_viscosity = nullptr;  ///< [cells] Pa s, added to the viscosity; null: 0
  const double* state = nullptr;           ///< unknowns by FlowLayout, Cartesian components
  const double* alpha = nullptr;           ///< [v]
  FlowLayout layout;
  /// All that a cell loop gathers, a node's values together (one or two cache lines a node, not one an array).
  const double* node_values = nullptr;    ///< [v][node_stride], see FlowNodes
  const double* vertex_values = nullptr;  ///< [p][vertex_stride]
  bool forced = false;                    ///< there is a body force
  bool loaded = false;                    ///< there is a load or a response of particles
  FlowParameters parameters;
  static constexpr int node_stride = 16, vertex_stride = 12;
};

/// Residuals and Jacobians of `lanes` cells at a time, for the widest vectors of this machine.
struct FlowKernel {
  int lanes = 0;
  int rows = 0;  ///< unknowns of a cell: equal order interlaced by node, Taylor-Hood velocities first
  /// Cells first..first+count-1 (count <= lanes): residual [lanes][rows], or, when it is not null, the matrix alone
  /// [lanes][rows][rows].
  void (*evaluate)(const FlowData& data, int first, int count, double* residual, double* matrix) = nullptr;
  /// The superficial velocity whose divergence the continuity rows balance, at the points of the table:
  /// [lanes][points][3] m/s.
  void (*flux)(const FlowData& data, int first, int count, double* flux) = nullptr;
};
/// Doubles in the widest vectors of this machine: 2, 4 or 8.
int widest_lanes();
/// `lanes` 0 chooses by the machine; 2 (SSE2), 4 (AVX2), 8 (AVX-512) ask for one.
FlowKernel flow_kernel(Cell cell, int order, int lanes = 0);

}  // namespace silt
