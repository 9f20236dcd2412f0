#pragma once
#include <memory>
#include <vector>

#include "fluid/assembly/cell_entries.hpp"
#include "fluid/assembly/flow_data.hpp"
#include "fluid/assembly/flow_facet.hpp"
#include "fluid/assembly/flow_nodes.hpp"
#include "fluid/boundary/boundary_conditions.hpp"
#include "fluid/space/lagrange_space.hpp"
#include "fluid/space/unknowns.hpp"

namespace silt {

/// Everything that is given during one step; [v] over the velocity nodes, [p] over the vertices.
struct StepFields {
  std::vector<double> alpha;                       ///< [v]
  std::vector<double> history;                     ///< [v][3] m/s2
  std::vector<double> velocity_old;                ///< [v][3] m/s
  std::vector<double> body;                        ///< [v][3] N/m3
  std::vector<double> alpha_rate;                  ///< [p] 1/s
  std::vector<double> load, response;              ///< [p][3] N/m3, [p] kg/(m3 s): the particles' densities
  std::vector<double> nodal_load, nodal_response;  ///< [p][3] N, [p] kg/s: added to the rows of equal-order elements
  std::vector<double> following;                   ///< [p] s; empty: 0
  std::vector<double> lent_share, lent_pressure;   ///< [p] s and p of the last step; empty: 0
  std::vector<double> prescribed_velocity;         ///< [v][3] m/s
  std::vector<double> prescribed_flow;             ///< [p] m3/s
  std::vector<double> boundary_pressure;           ///< [p] Pa
  std::vector<double> eddy_viscosity;              ///< [cells] Pa s; empty: none
  double backflow = 0.5;
  FlowParameters parameters;
};

/// The algebraic system of the monolithic scheme: numbering, residual and Jacobian of velocity and pressure together.
///
/// Equal order: unknowns interlaced by node, BAIJ. Taylor-Hood: velocities, then pressures of each rank, AIJ. At nodes
/// with a condition the unknowns are the components in the frame of the constraint (an oblique slip wall fixes the
/// normal one); a fixed component has the row u - given = 0, and its column is left out of the other rows because every
/// iterate holds the given value.
class FlowSystem {
 public:
  /// `order` of the velocity functions: 1 equal order, 2 Taylor-Hood; `lanes` as in flow_kernel(). Collective.
  FlowSystem(const Mesh& mesh, const BoundaryConditions& boundary, int order, int lanes = 0);

  const LagrangeSpace& space() const { return space_; }
  const VelocityConstraints& constraints() const { return constraints_; }
  const BoundaryConditions& boundary() const { return boundary_; }
  /// m, shortest edge of each local cell.
  const std::vector<double>& cell_size() const { return cell_size_; }
  const std::vector<double>& lumped_mass() const { return lumped_mass_; }
  bool equal_order() const { return space_.order == 1; }

  VecHandle create_vector() const;
  /// The Jacobian's matrix, with the null space of a constant pressure in a closed domain.
  MatHandle create_matrix() const;
  /// Global rows of this rank's velocity and pressure unknowns, for a field split.
  IsHandle velocity_rows() const;
  IsHandle pressure_rows() const;

  /// u [v][3], p [p] <-> global vector.
  void to_vector(const double* u, const double* p, Vec x) const;
  void from_vector(Vec x, double* u, double* p) const;

  /// Residual and Jacobian at x of the step described by `fields`; callable from PETSc.
  PetscErrorCode residual(const StepFields& fields, Vec x, Vec r) const;
  PetscErrorCode jacobian(const StepFields& fields, Vec x, Mat matrix) const;

  /// The momentum residual before the conditions are put in: at a constrained node minus the force of the fluid on the
  /// boundary. [v][3] N, summed over ranks. Collective.
  std::vector<double> reaction(const StepFields& fields, Vec x) const;
  /// [cells][points][3] m/s at the points of flow_table: the superficial velocity whose divergence the continuity rows
  /// balance, stabilisation included.
  std::vector<double> superficial_velocity(const StepFields& fields, Vec x) const;
  /// [p] m3/s, int N_i U.n over the whole boundary, as the continuity rows see it. Collective.
  std::vector<double> nodal_outflow(const StepFields& fields, Vec x) const;
  /// Integrals over each boundary, summed over ranks. Collective.
  std::vector<FacetIntegrals> boundary_integrals(const StepFields& fields, Vec x) const;
  /// Force of the fluid on each boundary with a velocity condition, from the reaction (of higher order than the
  /// integral of the traction); a node's reaction goes to its boundary, that of a node between two boundaries by their
  /// tractions. Summed over ranks. Collective.
  std::vector<Vec3> boundary_forces(const StepFields& fields, Vec x) const;

 private:
  void number();
  void find_shares();
  /// A node's part of one boundary: `share` is its portion of the facet areas around the node.
  struct Share {
    int node, boundary;
    double share;
  };
  int velocity_place(int node, int i) const { return layout_.velocity_stride * node + i; }
  int pressure_place(int node) const { return layout_.pressure_offset + layout_.pressure_stride * node; }
  FlowData data(const StepFields& fields, const double* state) const;
  FacetTerm facet_term(const StepFields& fields, int f) const;
  /// Local vector of unknowns with the constrained nodes turned to Cartesian components. Callable from PETSc.
  PetscErrorCode local_state(Vec x, std::vector<double>& state) const;
  /// Residual of this rank's cells, facets and owned nodes by local place, Cartesian.
  void local_residual(const StepFields& fields, const std::vector<double>& state, std::vector<double>& residual) const;
  void rotate_rows(double* values) const;
  void cell_places(int cell, PetscInt* places) const;
  void constrain(int cell, double* matrix) const;
  PetscErrorCode insert_cell(Mat matrix, int cell, const double* values) const;
  CellEntries::Points cell_points() const;

  const Mesh& mesh_;
  const BoundaryConditions& boundary_;
  LagrangeSpace space_;
  VelocityConstraints constraints_;
  FlowFacets facets_;
  FlowKernel kernel_;
  FlowLayout layout_;
  int dimension_, block_;
  PetscInt owned_rows_ = 0;
  std::vector<PetscInt> global_;  ///< [layout_.size] global row of each local place
  std::vector<char> fixed_;       ///< [layout_.size] prescribed
  std::vector<char> owned_;       ///< [layout_.size]
  std::vector<double> cell_size_, lumped_mass_;
  double total_mass_ = 0;
  std::vector<Share> shares_;
  std::vector<char> fixed_facet_;  ///< [facets] the velocity of all its nodes is given, so its Jacobian is zero
  mutable FlowNodes nodes_;        ///< of the present assembly
  mutable std::unique_ptr<CellEntries> entries_;  ///< of every matrix of create_matrix()
  Handle<VecScatter, VecScatterDestroy> scatter_;
  VecHandle local_;
};

}  // namespace silt
