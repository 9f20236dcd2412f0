#pragma once
#include <vector>

#include "base/mesh.hpp"
#include "fluid/assembly/flow_data.hpp"

namespace silt {

/// What stands on a boundary facet.
struct FacetTerm {
  bool pressure_boundary = false;    ///< natural traction; otherwise the flow through the facet is prescribed
  double backflow = 0;               ///< share of the momentum of the inflow that is taken out
  const double* pressure = nullptr;  ///< [p] Pa, traction on pressure boundaries
};

/// Integrals over one boundary facet (outward normal).
struct FacetIntegrals {
  double volume_flow = 0;         ///< int (alpha u)_h.n
  double pressure = 0, area = 0;  ///< int p, int 1
  Vec3 traction =
      Vec3::Zero();  ///< int of the force of the fluid on the boundary: alpha (p n - mu (grad u + grad u^T) n)
  Vec3 convection = Vec3::Zero();  ///< int alpha rho u (u.n), momentum that leaves
};

/// Boundary terms of the flow, evaluated with the shape functions of the cell behind the facet.
///
/// Pressure boundary: + int w_a N_a p_b n (traction; w_a as in FlowResidual) - int N_a alpha mu (grad u)^T n, so that a
/// parallel outflow leaves undisturbed, - backflow int N_a alpha rho min(u.n, 0) u, which keeps the energy bounded
/// where fluid comes back (Bazilevs et al. 2009). Elsewhere: - int N_a (alpha u)_h.n in the continuity rows, which
/// replaces the nodal flow by the one prescribed.
class FlowFacets {
 public:
  FlowFacets(const Mesh& mesh, int order);
  int rows() const { return rows_; }
  /// Whether velocity node a of the cell lies on facet `facet` of the cell.
  bool on_facet(int facet, int a) const;
  /// Adds to residual [rows] and, when not null, matrix [rows][rows] of the cell behind facet number `f` of
  /// Mesh::facets.
  void add(const FlowData& data, int f, const FacetTerm& term, double* residual, double* matrix) const;
  FacetIntegrals integrate(const FlowData& data, int f) const;
  /// flow [vertices of the cell] += int M_a (alpha u)_h.n.
  void add_nodal_flow(const FlowData& data, int f, double* flow) const;
  /// force [velocity nodes of the cell][3] += int N_a (force of the fluid on the boundary).
  void add_nodal_force(const FlowData& data, int f, double* force) const;

 private:
  struct Point {
    double weight;
    double tangent[2][3];  ///< of the reference facet in the cell's reference coordinates
    std::vector<double> N, dN, M, dM;
  };
  struct Geometry;
  Geometry geometry(const FlowData& data, int f, const Point& point) const;
  struct Values;
  Values values(const FlowData& data, int f, const Point& point, const Geometry& g) const;
  /// The terms where the flow is prescribed.
  template <int dim>
  void add_flow(const FlowData& data, int f, double* residual, double* matrix) const;
  template <int dim>
  void add_terms(const FlowData& data, int f, const FacetTerm& term, double* residual, double* matrix) const;
  int velocity_row(int a, int i) const { return order_ == 1 ? a * (dimension_ + 1) + i : a * dimension_ + i; }
  int pressure_row(int a) const { return order_ == 1 ? a * (dimension_ + 1) + dimension_ : nv_ * dimension_ + a; }

  const Mesh& mesh_;
  int order_, dimension_, nv_, np_, rows_;
  std::vector<std::vector<Point>> points_;          ///< [facet of the cell]
  std::vector<std::vector<int>> nodes_, vertices_;  ///< [facet of the cell] whose functions are not zero there
  std::vector<Vec3> normals_;                       ///< [facets][points] outward, times weight and area
};

}  // namespace silt
