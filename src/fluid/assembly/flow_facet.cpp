#include "fluid/assembly/flow_facet.hpp"

#include <algorithm>
#include <cmath>

#include "base/dual.hpp"
#include "fluid/space/quadratic_element.hpp"

namespace silt {
namespace {

/// Reference facet to reference cell: place and tangents.
void facet_map(int nodes, const double (&corner)[4][3], const double* s, double* place, double (*tangent)[3]) {
  double N[4] = {}, dN[4][2] = {};
  const double x = s[0], y = s[1];
  if (nodes == 2) {
    N[0] = 1 - x, N[1] = x, dN[0][0] = -1, dN[1][0] = 1;
  } else if (nodes == 3) {
    N[0] = 1 - x - y, N[1] = x, N[2] = y;
    dN[0][0] = dN[0][1] = -1, dN[1][0] = 1, dN[2][1] = 1;
  } else {
    N[0] = (1 - x) * (1 - y), N[1] = x * (1 - y), N[2] = x * y, N[3] = (1 - x) * y;
    dN[0][0] = y - 1, dN[0][1] = x - 1, dN[1][0] = 1 - y, dN[1][1] = -x;
    dN[2][0] = y, dN[2][1] = x, dN[3][0] = -y, dN[3][1] = 1 - x;
  }
  for (int d = 0; d < 3; ++d) {
    place[d] = tangent[0][d] = tangent[1][d] = 0;
    for (int a = 0; a < nodes; ++a) {
      place[d] += N[a] * corner[a][d];
      for (int k = 0; k < 2; ++k) tangent[k][d] += dN[a][k] * corner[a][d];
    }
  }
}

/// Reference coordinates of the vertices.
void vertex_place(Cell cell, int a, double* xi) {
  const bool simplex = cell == Cell::triangle || cell == Cell::tetrahedron;
  for (int d = 0; d < 3; ++d) xi[d] = simplex ? a == d + 1 : a >> d & 1;
}

}  // namespace

struct FlowFacets::Geometry {
  Vec3 normal;  ///< outward, times weight and area
  Vec3 gradient[27];
};

FlowFacets::FlowFacets(const Mesh& mesh, int order)
    : mesh_(mesh),
      order_(order),
      dimension_(mesh.dimension),
      nv_(order == 1 ? mesh.nodes_per_cell : quadratic_nodes(mesh.cell)),
      np_(mesh.nodes_per_cell),
      rows_(nv_ * dimension_ + np_) {
  const int nodes = facet_nodes(mesh.cell);
  const Quadrature rule = facet_quadrature(mesh.cell, order == 2 ? 5 : mesh.cell == Cell::tetrahedron ? 4 : 3);
  points_.resize(mesh.facets_per_cell);
  for (int f = 0; f < mesh.facets_per_cell; ++f) {
    double corner[4][3] = {};
    for (int a = 0; a < nodes; ++a) vertex_place(mesh.cell, facet_node_list(mesh.cell, f)[a], corner[a]);
    for (int q = 0; q < rule.points; ++q) {
      Point p;
      double place[3];
      p.weight = rule.weight[q];
      facet_map(nodes, corner, rule.point[q].data(), place, p.tangent);
      p.N.resize(nv_), p.dN.resize(3 * nv_), p.M.resize(np_), p.dM.resize(3 * np_);
      shape(mesh.cell, place, p.M.data(), reinterpret_cast<double(*)[3]>(p.dM.data()));
      if (order == 1)
        p.N = p.M, p.dN = p.dM;
      else
        quadratic_shape(mesh.cell, place, p.N.data(), reinterpret_cast<double(*)[3]>(p.dN.data()));
      points_[f].push_back(std::move(p));
    }
    const auto not_zero = [&](const std::vector<double> Point::*functions, int count) {
      std::vector<int> list;
      for (int a = 0; a < count; ++a)
        if (std::any_of(points_[f].begin(), points_[f].end(),
                        [&](const Point& p) { return std::abs((p.*functions)[a]) > 1e-12; }))
          list.push_back(a);
      return list;
    };
    nodes_.push_back(not_zero(&Point::N, nv_));
    vertices_.push_back(not_zero(&Point::M, np_));
  }
  FlowData data;
  data.coordinates = mesh.cell_coordinates.data();
  for (size_t f = 0; f < mesh.facets.size(); ++f)
    for (const Point& p : points_[mesh.facets[f].facet])
      normals_.push_back(geometry(data, static_cast<int>(f), p).normal);
}

bool FlowFacets::on_facet(int facet, int a) const {
  return std::find(nodes_[facet].begin(), nodes_[facet].end(), a) != nodes_[facet].end();
}

FlowFacets::Geometry FlowFacets::geometry(const FlowData& data, int f, const Point& point) const {
  const double* x = data.coordinates + 3 * static_cast<size_t>(mesh_.facets[f].cell) * np_;
  Mat3 J = Mat3::Zero();
  for (int a = 0; a < np_; ++a) J += vec3(x + 3 * a) * vec3(&point.dM[3 * a]).transpose();
  if (dimension_ == 2) J(2, 2) = 1;
  const Vec3 t = J * vec3(point.tangent[0]);
  Geometry g;
  // In 2D the outward normal is the tangent turned right.
  g.normal = point.weight * (dimension_ == 2 ? Vec3(t.y(), -t.x(), 0) : Vec3(t.cross(J * vec3(point.tangent[1]))));
  const Mat3 inverse = J.inverse().transpose();
  for (int a = 0; a < nv_; ++a) g.gradient[a] = inverse * vec3(&point.dN[3 * a]);
  return g;
}

void FlowFacets::add(const FlowData& data, int f, const FacetTerm& term, double* residual, double* matrix) const {
  if (dimension_ == 2)
    add_terms<2>(data, f, term, residual, matrix);
  else
    add_terms<3>(data, f, term, residual, matrix);
}

template <int dim>
void FlowFacets::add_flow(const FlowData& data, int f, double* residual, double* matrix) const {
  const BoundaryFacet& facet = mesh_.facets[f];
  const int* v = data.velocity_nodes + static_cast<size_t>(facet.cell) * nv_;
  const std::vector<Point>& points = points_[facet.facet];
  const std::vector<int>&nodes = nodes_[facet.facet], &vertices = vertices_[facet.facet];
  double flux[27][dim];
  for (const int b : nodes)
    for (int j = 0; j < dim; ++j) flux[b][j] = data.alpha[v[b]] * data.state[data.layout.velocity_stride * v[b] + j];
  for (size_t q = 0; q < points.size(); ++q) {
    const double *N = points[q].N.data(), *M = points[q].M.data();
    const Vec3& normal = normals_[static_cast<size_t>(f) * points.size() + q];
    double flow = 0;
    for (const int b : nodes)
      for (int j = 0; j < dim; ++j) flow += N[b] * flux[b][j] * normal[j];
    for (const int a : vertices) {
      const double test = data.parameters.continuity_scale * M[a];
      residual[pressure_row(a)] -= test * flow;
      if (!matrix) continue;
      for (const int b : nodes)
        for (int j = 0; j < dim; ++j)
          matrix[pressure_row(a) * rows_ + velocity_row(b, j)] -= test * N[b] * data.alpha[v[b]] * normal[j];
    }
  }
}

template <int dim>
void FlowFacets::add_terms(const FlowData& data, int f, const FacetTerm& term, double* residual, double* matrix) const {
  if (!term.pressure_boundary) return add_flow<dim>(data, f, residual, matrix);
  constexpr int directions = dim + dim * dim;
  using D = Dual<directions>;
  const BoundaryFacet& facet = mesh_.facets[f];
  const int* v = data.velocity_nodes + static_cast<size_t>(facet.cell) * nv_;
  const int* n = data.vertices + static_cast<size_t>(facet.cell) * np_;
  const FlowParameters& k = data.parameters;
  const double viscosity = k.viscosity + (data.eddy_viscosity ? data.eddy_viscosity[facet.cell] : 0);
  for (const Point& point : points_[facet.facet]) {
    const Geometry g = geometry(data, f, point);
    double alpha = 0, pressure = 0, u[dim] = {}, gradient[dim][dim] = {};
    for (int b = 0; b < nv_; ++b) {
      alpha += point.N[b] * data.alpha[v[b]];
      for (int i = 0; i < dim; ++i) {
        const double value = data.state[data.layout.velocity_stride * v[b] + i];
        u[i] += point.N[b] * value;
        for (int j = 0; j < dim; ++j) gradient[i][j] += value * g.gradient[b][j];
      }
    }
    for (int b = 0; b < np_; ++b) pressure += point.M[b] * term.pressure[n[b]];
    D velocity[dim], slope[dim][dim], through;
    for (int i = 0; i < dim; ++i) {
      velocity[i] = D::variable(u[i], i);
      through += velocity[i] * g.normal[i];
      for (int j = 0; j < dim; ++j) slope[i][j] = D::variable(gradient[i][j], dim + i * dim + j);
    }
    if (through.value > 0) through = D(0.0);
    for (int i = 0; i < dim; ++i) {
      D momentum = through * velocity[i] * (-term.backflow * alpha * k.density);
      for (int j = 0; j < dim; ++j) momentum -= slope[j][i] * (alpha * viscosity * g.normal[j]);
      for (int a = 0; a < nv_; ++a) {
        const int row = velocity_row(a, i);
        const double weight = k.model_a ? data.alpha[v[a]] : 1.0;
        residual[row] += point.N[a] * (momentum.value + weight * pressure * g.normal[i]);
        if (!matrix || point.N[a] == 0) continue;
        for (int b = 0; b < nv_; ++b)
          for (int c = 0; c < dim; ++c) {
            double sum = momentum.derivative[c] * point.N[b];
            for (int j = 0; j < dim; ++j) sum += momentum.derivative[dim + c * dim + j] * g.gradient[b][j];
            matrix[row * rows_ + velocity_row(b, c)] += point.N[a] * sum;
          }
      }
    }
  }
}

struct FlowFacets::Values {
  double alpha = 0, pressure = 0;
  Vec3 velocity = Vec3::Zero(), flux = Vec3::Zero(), traction = Vec3::Zero();
};

FlowFacets::Values FlowFacets::values(const FlowData& data, int f, const Point& point, const Geometry& g) const {
  const BoundaryFacet& facet = mesh_.facets[f];
  const int* v = data.velocity_nodes + static_cast<size_t>(facet.cell) * nv_;
  const int* n = data.vertices + static_cast<size_t>(facet.cell) * np_;
  Values result;
  Mat3 gradient = Mat3::Zero();
  for (int b = 0; b < nv_; ++b) {
    Vec3 value = Vec3::Zero();
    for (int i = 0; i < dimension_; ++i) value[i] = data.state[data.layout.velocity_stride * v[b] + i];
    result.alpha += point.N[b] * data.alpha[v[b]];
    result.velocity += point.N[b] * value;
    result.flux += point.N[b] * data.alpha[v[b]] * value;
    gradient += value * g.gradient[b].transpose();
  }
  for (int b = 0; b < np_; ++b)
    result.pressure += point.M[b] * data.state[data.layout.pressure_offset + data.layout.pressure_stride * n[b]];
  const double viscosity = data.parameters.viscosity + (data.eddy_viscosity ? data.eddy_viscosity[facet.cell] : 0);
  const double share = data.parameters.model_a ? result.alpha : 1.0;
  result.traction =
      share * result.pressure * g.normal - result.alpha * viscosity * ((gradient + gradient.transpose()) * g.normal);
  return result;
}

FacetIntegrals FlowFacets::integrate(const FlowData& data, int f) const {
  FacetIntegrals result;
  for (const Point& point : points_[mesh_.facets[f].facet]) {
    const Geometry g = geometry(data, f, point);
    const Values at = values(data, f, point, g);
    result.volume_flow += at.flux.dot(g.normal);
    result.area += g.normal.norm();
    result.pressure += at.pressure * g.normal.norm();
    result.traction += at.traction;
    result.convection += at.alpha * data.parameters.density * at.velocity.dot(g.normal) * at.velocity;
  }
  return result;
}

void FlowFacets::add_nodal_flow(const FlowData& data, int f, double* flow) const {
  for (const Point& point : points_[mesh_.facets[f].facet]) {
    const Geometry g = geometry(data, f, point);
    const double through = values(data, f, point, g).flux.dot(g.normal);
    for (int a = 0; a < np_; ++a) flow[a] += point.M[a] * through;
  }
}

void FlowFacets::add_nodal_force(const FlowData& data, int f, double* force) const {
  for (const Point& point : points_[mesh_.facets[f].facet]) {
    const Geometry g = geometry(data, f, point);
    const Values at = values(data, f, point, g);
    for (int a = 0; a < nv_; ++a) vec3(force + 3 * a) += point.N[a] * at.traction;
  }
}

}  // namespace silt
