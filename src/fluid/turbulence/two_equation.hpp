#pragma once
#include "fluid/turbulence/closure.hpp"
#include "fluid/turbulence/initial_turbulence.hpp"
#include "fluid/turbulence/positive_transport.hpp"
#include "fluid/turbulence/turbulence.hpp"
#include "fluid/turbulence/turbulence_inflow.hpp"
#include "fluid/turbulence/wall_layer.hpp"

namespace silt {

/// A model with transport equations for k and a second quantity (epsilon or omega), one after the other
/// (docs/theory/turbulence.md, T1 to T3). Model: RealizableKEpsilon, SstKOmega.
template <class Model>
class TwoEquation : public Turbulence {
 public:
  TwoEquation(const Mesh& mesh, Options& options, const TurbulenceOptions& read, const BoundaryConditions& boundaries,
              bool axisymmetric);

  void start(const Flow& flow) override;
  int solve(double time, const Bdf& bdf, double dt, const Flow& flow) override;
  void accept() override;
  std::span<const double> energy() const override { return k_; }
  std::span<const double> dissipation() const override { return dissipation_; }
  std::span<const double> exchange() const override { return exchange_; }
  void add_scalars(std::vector<Fluid::Scalar>& scalars) const override;
  void add_state(std::vector<Fluid::StateArray>& arrays) override;
  void restored() override { set_dissipation(); }

 private:
  struct State {
    std::vector<double> k, second, viscosity;    ///< [nodes]
    std::vector<double> cell_viscosity, y_plus;  ///< [cells]
  };
  /// What the flow is at the nodes during a step.
  struct Fields {
    std::vector<Strain> strain;
    std::vector<double> speed;       ///< along the wall, in its layer
    std::vector<double> flux;        ///< [nodes][3] alpha rho u
    std::vector<double> entering;    ///< kg/s through open boundaries with a given turbulence, positive in
    std::vector<int> entering_from;  ///< boundary, -1: none
  };
  Fields fields(const Flow& flow) const;
  /// Adds what enters through open boundaries.
  void add_entering(Fields& f) const;
  /// The points at all nodes, with the eddy viscosity of the state.
  std::vector<TurbulentPoint> points(const Flow& flow, const Fields& f, const State& state) const;
  double eddy_viscosity(const TurbulentPoint& p, int node) const;
  void set_viscosity(const Flow& flow, const Fields& f, State& state) const;
  /// Fills what is given at the nodes of inflows and walls; 2: by an inflow, 1: k at a wall, 0: free.
  std::vector<char> impose(const Flow& flow, double t, State& state) const;
  double inflow_second(int boundary, const Flow& flow, int node, double t, double k) const;
  /// The second quantity at a node of the wall layer; false where it is not given.
  bool wall_value(const Flow& flow, const std::vector<double>& k, int node, double& value) const;
  /// W/m3, what shear produces by the law of the wall; `otherwise` where it does not hold.
  double wall_production(const Flow& flow, const Fields& f, double k, int node, double otherwise) const;
  void set_sources(const Flow& flow, const std::vector<TurbulentPoint>& points, const State& state, double t,
                   PositiveTransport::Terms& energy, PositiveTransport::Terms& second) const;
  void set_dissipation();
  /// Adds the dissipation by dilatation (T8, T9) at a node.
  void add_dilatation(const Flow& flow, const TurbulentPoint& p, double free, int node,
                      PositiveTransport::Terms& energy, PositiveTransport::Terms& second) const;

  static constexpr bool epsilon = requires { Model::C2; };

  const Mesh& mesh_;
  const BoundaryConditions& boundaries_;
  TurbulenceInflow inflow_;
  VertexRule rule_;
  NodalGraph graph_;
  WallLayer layer_;
  bool resolved_, axisymmetric_;
  PositiveTransport k_transport_, second_transport_;
  InitialTurbulence initial_;
  DilatationDissipation dilatation_;
  bool turning_;  ///< P = mu_t S W instead of mu_t S^2 (Kato & Launder 1993)

  std::vector<double> k_, old_k_, second_, old_second_, dissipation_, exchange_;
  State next_;
};

}  // namespace silt
