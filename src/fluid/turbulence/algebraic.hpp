#pragma once
#include "fluid/turbulence/smagorinsky.hpp"
#include "fluid/turbulence/turbulence.hpp"
#include "fluid/turbulence/vertex_rule.hpp"
#include "fluid/turbulence/wale.hpp"

namespace silt {

/// A subgrid model: the eddy viscosity of a cell from its mean velocity gradient and its width, the cubic (2D: square)
/// root of its volume. Model: Smagorinsky, Wale.
template <class Model>
class Algebraic : public Turbulence {
 public:
  Algebraic(const Mesh& mesh, Options& options, const TurbulenceOptions& read, const BoundaryConditions& boundaries,
            bool axisymmetric)
      : Turbulence(read, wall_distance_of(mesh, boundaries)), rule_(mesh, axisymmetric) {
    options.read("fluid", model_);
    cell_eddy_viscosity_.assign(mesh.cells, 0.0);
    wall_y_plus_.assign(mesh.cells, 0.0);
    eddy_viscosity_.assign(mesh.nodes, 0.0);
  }

  void start(const Flow& flow) override {
    find(flow);
    accept();
  }
  int solve(double, const Bdf&, double, const Flow& flow) override {
    find(flow);
    return 0;
  }
  void accept() override {
    cell_eddy_viscosity_ = next_;
    eddy_viscosity_ = next_nodal_;
  }

 private:
  void find(const Flow& flow);

  VertexRule rule_;
  Model model_;
  std::vector<double> next_, next_nodal_;
};

}  // namespace silt
