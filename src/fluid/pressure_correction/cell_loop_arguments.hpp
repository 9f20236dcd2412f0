#pragma once
// Plain data only: this header is compiled for several instruction sets, so it must not bring in inline functions that
// the linker could take from a unit for a better processor.

namespace silt {

/// Shape functions and reference gradients at the quadrature points of the cell.
struct ReferenceCell {
  double shape[8][8];        ///< [point][node]
  double gradient[8][8][3];  ///< [point][node][direction]
  double weight[8];
};

/// The cells in batches of `lanes`; the last batch repeats its last cell.
struct CellBatches {
  int cells, batches;
  const int* nodes;           ///< [batches][nodes per cell][lanes]
  const double* coordinates;  ///< [batches][nodes per cell][dimension][lanes] m
  const double* size;         ///< [batches * lanes] m, shortest edge
  const int* entry;           ///< [cells][nodes per cell][nodes per cell] places in the matrix
  const ReferenceCell* reference;
};

/// What the per-cell coefficients are made of.
struct CoefficientTerms {
  double density, viscosity;
  double rate;                   ///< 1/s, gamma/dt
  bool model_a;                  ///< pressure share alpha_e, else 1
  const double* velocity;        ///< [nodes][3] m/s, the convecting velocity w
  const double* void_fraction;   ///< [nodes]; null: 1
  const double* drag;            ///< [nodes] kg/m3/s, beta; with void_fraction only
  const double* eddy_viscosity;  ///< [padded cells] Pa s, added to the viscosity; null: 0
  const double* following;       ///< [nodes] s, volume share of particles that follow; with void_fraction only; null: 0
};

/// Coefficients constant in each cell, arrays of padded_cells.
struct CellCoefficients {
  double* void_fraction;   ///< alpha_e, mean of the nodes
  double* pressure_share;  ///< P_e: alpha_e in model A, 1 in model B
  double* drag;            ///< beta_e = alpha_e^2 mean(beta/alpha^2), kg/m3/s
  double* mobility;        ///< k_e = (P_e + s_e)/alpha_e mean(alpha/(alpha rho gamma/dt + beta)): u = u~ - k grad phi
  double* stabilisation;   ///< tau_p = alpha_e P_e tau, m3 s/kg
  double* force[3];        ///< f_e, mean force density of the particles; null entries: 0
  double* balance[3];      ///< s_e = -(f_e + weight)/P_e, what balances grad p at rest; null entries: 0
  double* following;       ///< s_e, mean of the nodes (model B: 0)
};

/// Where the cell force densities come from.
struct ForceTerms {
  const double* load_per_drag;  ///< [nodes][3] F_i / sum_e drag_e V_e, F_i [N] the particles' load with w; null: 0
  const double* drag;           ///< [padded cells] kg/m3/s, how a cell shares in the loads of its nodes
  const double* weight;         ///< [nodes][3] N/m3, the fluid's weight, when the pressure carries it; null: 0
};

/// Terms of the momentum equation; cell arrays are null without particles (void_fraction null).
struct MomentumTerms {
  double density, viscosity;
  double rate;                       ///< 1/s, gamma/dt
  double supg;                       ///< factor of the streamline stabilisation
  const double* velocity;            ///< [nodes][3] w
  const double* history;             ///< [nodes][3] m/s2, c1 u^n - c2 u^{n-1}
  const double* pressure;            ///< [nodes] p^n; without particles the effective p^n + (c1 k^n phi^n - c2 ...) rho
  const double* increment;           ///< [nodes] phi^n
  const double* old_increment;       ///< [nodes] phi^{n-1}
  const double* void_fraction;       ///< [nodes]
  const double* void_fraction_rate;  ///< [nodes] 1/s
  const double* body_force;          ///< [nodes][3] N/m3; null: 0
  const double* cell_void_fraction;
  const double* cell_pressure_share;
  const double* cell_following;  ///< s_e
  const double* cell_lent;       ///< s_e of the last step, whose pressure lent_pressure comes back
  const double* lent_pressure;   ///< [nodes] Pa
  const double* cell_drag;
  const double* increment_factor;      ///< alpha_e rho c1 k_e^n
  const double* old_increment_factor;  ///< alpha_e rho c2 k_e^{n-1}
  const double* force[3];              ///< f_e; null entries: 0
  const double* eddy_viscosity;        ///< [padded cells] Pa s, added to the viscosity; null: 0
};

/// Terms of the continuity equation.
struct ContinuityTerms {
  const double* flux;           ///< [nodes][3] U = alpha u~
  const double* pressure;       ///< [nodes] p^n
  const double* projection;     ///< [nodes][3] pi
  const double* stabilisation;  ///< [padded cells] tau_p
  const double* balance[3];     ///< [padded cells] s_e; null entries: 0
};

/// One set of loops, for one kind of cell and one vector width.
struct CellLoopTable {
  int lanes;
  void (*coefficients)(const CellBatches&, const CoefficientTerms&, const CellCoefficients&);
  void (*cell_forces)(const CellBatches&, const ForceTerms&, const CellCoefficients&);
  void (*momentum)(const CellBatches&, const MomentumTerms&, double*, double*);
  void (*momentum_porous)(const CellBatches&, const MomentumTerms&, double*, double*);
  void (*projection)(const CellBatches&, const ContinuityTerms&, double*);
  void (*continuity)(const CellBatches&, const ContinuityTerms&, double*);
  void (*diffusion)(const CellBatches&, const double*, double*);
  void (*drive)(const CellBatches&, const MomentumTerms&, double*);
  void (*mean_gradient)(const CellBatches&, const double*, const double*, double*);
};

/// The tables of the units; kind: 0 triangle, 1 quadrilateral, 2 tetrahedron, 3 hexahedron (enum Cell).
const CellLoopTable* cell_loops_baseline(int kind);
const CellLoopTable* cell_loops_avx2(int kind);
const CellLoopTable* cell_loops_avx512(int kind);

}  // namespace silt
