#include "fluid/space/velocity_constraints.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

namespace silt {

VelocityConstraints::VelocityConstraints(const LagrangeSpace& space, const BoundaryConditions& boundary)
    : space_(space), boundary_(boundary), of_node_(space.nodes, -1) {
  for (const auto& given : boundary.constraints()) add(given.node, given.count, given.direction);
  if (space.order == 2) find_middles();
}

void VelocityConstraints::add(int node, int count, std::array<Vec3, 3> directions) {
  const int dimension = space_.mesh.dimension;
  std::array<Vec3, 3> frame = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  if (count < dimension) {
    // The fixed directions, completed to an orthonormal frame of the plane or of space.
    for (int k = 0; k < count; ++k) frame[k] = directions[k];
    if (dimension == 2) {
      frame[1] = Vec3(-frame[0].y(), frame[0].x(), 0);
    } else if (count == 1) {
      frame[1] = frame[0].unitOrthogonal();
      frame[2] = frame[0].cross(frame[1]);
    } else {
      frame[2] = frame[0].cross(frame[1]);
    }
  }
  of_node_[node] = static_cast<int>(constraints_.size());
  constraints_.push_back({node, std::min(count, dimension), frame});
}

void VelocityConstraints::find_middles() {
  const Mesh& mesh = space_.mesh;
  const size_t nodes = space_.nodes;
  std::vector<int> best(nodes, std::numeric_limits<int>::max()), chosen(nodes, -1);
  std::vector<Vec3> normal(nodes, Vec3::Zero());
  std::vector<Mat3> slip(nodes, Mat3::Zero());
  std::vector<double> touch(13 * nodes);
  for (size_t b = 0; b < mesh.boundaries.size(); ++b) {
    const BoundaryType type = boundary_.type(static_cast<int>(b));
    if (type == BoundaryType::pressure) continue;
    std::fill(touch.begin(), touch.end(), 0.0);
    for (const FacetRule& facet : boundary_.facets()) {
      if (facet.boundary != static_cast<int>(b)) continue;
      Vec3 area = Vec3::Zero();
      for (int q = 0; q < facet.points; ++q) area += facet.point[q].area;
      const Mat3 moment = area * area.transpose() / area.squaredNorm();
      const auto on_facet = [&](int vertex) {
        return std::find(facet.node.begin(), facet.node.begin() + facet.nodes, vertex) !=
               facet.node.begin() + facet.nodes;
      };
      for (int a = 0; a < space_.nodes_per_cell; ++a) {
        const int node = space_.cell_nodes[static_cast<size_t>(facet.cell) * space_.nodes_per_cell + a];
        if (node < mesh.nodes) continue;
        if (!std::all_of(space_.parents.data() + space_.parent_start[node],
                         space_.parents.data() + space_.parent_start[node + 1], on_facet))
          continue;
        double* t = &touch[13 * static_cast<size_t>(node)];
        t[0] += 1;
        vec3(t + 1) += area;
        Eigen::Map<Mat3>(t + 4) += moment;
      }
    }
    space_.sum_shared(touch.data(), 13);
    for (size_t i = mesh.nodes; i < nodes; ++i) {
      const double* t = &touch[13 * i];
      if (t[0] == 0) continue;
      if (type == BoundaryType::slip) slip[i] += Eigen::Map<const Mat3>(t + 4);
      const int strength = boundary_.strength(static_cast<int>(b));
      if (strength >= best[i]) continue;
      best[i] = strength;
      chosen[i] = static_cast<int>(b);
      normal[i] = vec3(t + 1).normalized();
    }
  }
  for (size_t i = mesh.nodes; i < nodes; ++i) {
    if (chosen[i] < 0) continue;
    int count = 3;
    std::array<Vec3, 3> direction = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    if (boundary_.type(chosen[i]) == BoundaryType::slip) {
      // As at the vertices: directions less than 25 degrees apart are one.
      const Eigen::SelfAdjointEigenSolver<Mat3> eigen(slip[i]);
      count = 0;
      for (int k = 2; k >= 0; --k)
        if (eigen.eigenvalues()[k] > 0.05 * eigen.eigenvalues()[2]) direction[count++] = eigen.eigenvectors().col(k);
    }
    add(static_cast<int>(i), count, direction);
    middles_.push_back({static_cast<int>(i), chosen[i], normal[i]});
  }
}

void VelocityConstraints::evaluate(double time, const double* void_fraction, double* velocity) const {
  std::copy(boundary_.velocity().begin(), boundary_.velocity().end(), velocity);
  std::fill(velocity + 3 * static_cast<size_t>(space_.mesh.nodes), velocity + 3 * static_cast<size_t>(space_.nodes), 0);
  for (const Middle& m : middles_)
    vec3(velocity + 3 * m.node) = boundary_.prescribed(m.boundary, vec3(&space_.node_coordinates[3 * m.node]), m.normal,
                                                       time, void_fraction[m.node]);
}

void VelocityConstraints::impose(const double* prescribed, double* u) const {
  for (const Constraint& c : constraints_) {
    const auto given = vec3(prescribed + 3 * c.node);
    auto value = vec3(u + 3 * c.node);
    if (c.count == space_.mesh.dimension) {
      value = given;
      continue;
    }
    for (int k = 0; k < c.count; ++k) value += c.frame[k] * c.frame[k].dot(given - value);
  }
}

}  // namespace silt
