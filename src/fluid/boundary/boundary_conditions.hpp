#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/expression.hpp"
#include "base/mesh.hpp"
#include "base/options.hpp"
#include "base/surface_motion.hpp"
#include "fluid/boundary/facets.hpp"
#include "fluid/boundary/temperature_condition.hpp"
#include "fluid/turbulence/turbulence_options.hpp"

namespace silt {

/// What the flow obeys on a boundary; the smaller value wins where boundaries with different conditions meet.
enum class BoundaryType {
  no_slip,
  velocity,
  mass_flow,
  slip,
  pressure,
  total_pressure,
  far_field,
  supersonic_inflow,
  supersonic_outflow
};

/// The options `-boundary_<name>_...` of the fluid.
struct BoundaryOptions {
  std::string type;
  std::string velocity = "0, 0, 0";
  std::string mass_flow = "0";
  std::string profile = "1";
  std::string pressure = "0";
  SurfaceMotion rotation;
  TemperatureOptions temperature;
  TurbulenceInflowOptions turbulence;
  void options(OptionGroup& option);
};

/// The conditions on all boundaries of the mesh, evaluated at the nodes and on the facets.
///
/// Velocity: at a constrained node one to three orthonormal directions are fixed. Where boundaries meet, a node takes
/// the condition of the strongest: resting wall (no_slip without velocity), moving wall, velocity, mass_flow; of two
/// equal ones the first in Mesh::boundaries. If none of these touches it, all slip facets around it count together: the
/// fixed directions span their normals (three faces in a corner fix all three), directions that differ by less than 25
/// degrees being one (curved surfaces). Pressure is fixed at every node of a pressure boundary, also where a wall meets
/// it.
///
/// The volume flow through velocity and mass_flow boundaries is the integral of what the user gave, not of the nodal
/// values: a uniform inflow between no-slip walls delivers its full flow. No flow passes no_slip and slip boundaries.
class BoundaryConditions {
 public:
  /// Reads `-boundary_<name>_...` for every boundary of the mesh; throws UserError for one without a condition or with
  /// parameters that do not fit its type. Collective.
  /// Compressible flow has boundaries of its own (total_pressure, far_field, supersonic_...), its mass_flow leaves the
  /// velocity free, and `density` is not used.
  /// `axisymmetric`: around the x axis, so that a boundary's mass flow is that of the whole circumference.
  BoundaryConditions(const Mesh& mesh, Options& options, double density, bool compressible = false,
                     bool axisymmetric = false);

  BoundaryType type(int boundary) const { return conditions_[boundary].type; }
  /// True when the velocity is free on a boundary of this type: what stands outside enters through the flux alone.
  bool open(int boundary) const {
    return type(boundary) >= BoundaryType::pressure || (compressible_ && type(boundary) == BoundaryType::mass_flow);
  }
  /// Compressible flow, type velocity: the pressure of what enters is given too.
  bool has_pressure(int b) const { return conditions_[b].has_pressure; }
  /// What the user gave for a boundary, at a point.
  double given_pressure(int b, const Vec3& x, double t) const { return (*conditions_[b].pressure)(x, t); }
  Vec3 given_velocity(int b, const Vec3& x, double t) const { return (*conditions_[b].velocity)(x, t); }
  /// kg/(m2 s) into the domain at a point of a mass_flow boundary, at the time of the last evaluate().
  double mass_flux(int b, const Vec3& x, double time) const;
  /// True when no boundary fixes the pressure: it is then determined up to a constant.
  bool closed() const { return closed_; }
  const std::vector<FacetRule>& facets() const { return facets_; }
  /// m2, area of a boundary over all ranks.
  double area(int boundary) const { return areas_[boundary]; }

  /// The fixed directions of one node (rows 0..count-1, orthonormal).
  struct Constraint {
    int node;
    int count;
    std::array<Vec3, 3> direction;
  };
  bool compressible() const { return compressible_; }
  /// The constrained nodes of this rank, ascending; the same directions on every rank that shares a node.
  const std::vector<Constraint>& constraints() const { return constraints_; }
  /// [nodes] boundary whose condition the node's velocity takes, -1 where it is free (for slip: the first slip
  /// boundary).
  const std::vector<int>& velocity_boundary() const { return velocity_boundary_; }
  /// [nodes] first pressure boundary of the node, -1 where the pressure is free.
  const std::vector<int>& pressure_boundary() const { return pressure_boundary_; }

  /// Evaluates every condition at time t; void_fraction [nodes] turns the superficial velocities given into
  /// interstitial ones (null: 1).
  void evaluate(double time, const double* void_fraction);
  /// Interstitial velocity that boundary b prescribes at a point that is no vertex (0 for slip and pressure), with its
  /// outward normal and void fraction there.
  Vec3 prescribed(int b, const Vec3& x, const Vec3& normal, double time, double void_fraction) const;
  /// Order among conditions that meet: the smaller wins.
  int strength(int b) const { return 2 * static_cast<int>(conditions_[b].type) + conditions_[b].moving; }
  /// [nodes][3] m/s, interstitial velocity prescribed by the last evaluate(); 0 where nothing is.
  const std::vector<double>& velocity() const { return velocity_; }
  /// [nodes] Pa, prescribed by the last evaluate(); 0 where nothing is.
  const std::vector<double>& pressure() const { return pressure_; }
  /// [nodes] m3/s, int N_i U.n over velocity and mass_flow boundaries, U the superficial velocity given.
  const std::vector<double>& flow() const { return flow_; }
  /// m3/s, outflow (positive) prescribed by the last evaluate() per boundary, over all ranks.
  const std::vector<double>& boundary_flow() const { return boundary_flow_; }
  /// m3/s, sum of the prescribed inflow and outflow without their signs, over all ranks.
  double throughput() const { return throughput_; }
  /// A closed domain whose boundaries let in more than they let out has no solution: throws RunError on all ranks when
  /// what the last evaluate() prescribes and the fluid's volume, changing by `volume_rate` (m3/s) over a step `dt` (s;
  /// 0: steady), do not balance within a hundredth and beyond the round-off of a void fraction.
  void check_balance(double volume_rate, double dt) const;

  /// Sets the fixed directions of u [nodes][3] to the prescribed velocity.
  void impose(double* u) const;
  /// Removes the fixed directions from a residual or correction r [nodes][3].
  void project(double* r) const;

 private:
  struct Condition {
    BoundaryType type = BoundaryType::no_slip;
    bool moving = false, has_pressure = false;
    std::unique_ptr<VectorExpression> velocity;
    std::unique_ptr<Expression> mass_flow, profile, pressure;
  };
  void read(Options& options);
  void find_nodes();
  void find_constraints(const std::vector<double>& slip_normals);
  /// Finds what the profiles of mass_flow boundaries are multiplied with at a time.
  void spread_mass_flows(double time);
  void add_flow(double time);
  /// A wall that moved through its own surface would need a mesh that moves: refused.
  void refuse_moving_through() const;

  const Mesh& mesh_;
  bool compressible_ = false, axisymmetric_ = false;
  double density_;
  std::vector<Condition> conditions_;
  std::vector<FacetRule> facets_;
  std::vector<double> areas_;
  std::vector<double> spread_;  ///< kg/(m2 s) over the profile of each mass_flow boundary
  bool closed_ = true;
  std::vector<Constraint> constraints_;
  std::vector<int> velocity_boundary_, pressure_boundary_;
  std::vector<double> normal_;  ///< [nodes][3] unit outward normal of the node's mass_flow boundary
  std::vector<double> velocity_, pressure_, flow_, boundary_flow_;
  double throughput_ = 0;
};

}  // namespace silt
