#include "fluid/turbulence/algebraic.hpp"

#include <algorithm>
#include <cmath>

#include "fluid/turbulence/wall_law.hpp"

namespace silt {

template <class Model>
void Algebraic<Model>::find(const Flow& flow) {
  const Mesh& mesh = rule_.mesh();
  const int n = rule_.corners();
  next_.assign(mesh.cells, 0.0);
  next_nodal_.assign(mesh.nodes, 0.0);
  rule_.for_each_cell([&](const VertexRule::At& at) {
    Mat3 gradient = Mat3::Zero();
    double volume = 0, density = 0, distance = 0;
    for (int v = 0; v < n; ++v) {
      volume += at.weight[v];
      density += flow.density[at.node[v]] / n;
      distance += wall_distance_[at.node[v]] / n;
      for (int a = 0; a < n; ++a)
        gradient +=
            at.weight[v] * vec3(&flow.velocity[3 * static_cast<std::size_t>(at.node[a])]) * at.slope[v][a].transpose();
    }
    double length = model_.constant * std::pow(mesh.cell_volumes[at.cell], 1.0 / mesh.dimension);
    if (Model::limited_at_walls) length = std::min(length, wall_law::kappa * distance);
    const double value = density * length * length * Model::rate(gradient / volume);
    next_[at.cell] = value;
    for (int v = 0; v < n; ++v) next_nodal_[at.node[v]] += at.weight[v] * value;
  });
  mesh.sum_shared(next_nodal_.data(), 1);
  for (int i = 0; i < mesh.nodes; ++i) next_nodal_[i] /= rule_.volume()[i];
}

template class Algebraic<Smagorinsky>;
template class Algebraic<Wale>;

}  // namespace silt
