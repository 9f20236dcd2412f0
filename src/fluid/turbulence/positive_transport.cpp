#include "fluid/turbulence/positive_transport.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace silt {
namespace {

/// What of the difference `own` along an edge is smooth: all of it where the differences extrapolated from both ends
/// are at least half of it and of its sign, none at an extremum.
double smooth_part(double own, double one, double other) {
  if (own == 0) return 0;
  const double ratio = 2 * std::min(one / own, other / own);
  return own * std::clamp(ratio, 0.0, 1.0);
}

}  // namespace

PositiveTransport::PositiveTransport(const VertexRule& rule, const NodalGraph& graph, const std::string& prefix)
    : rule_(rule), graph_(graph), system_(graph, prefix) {}

int PositiveTransport::solve(const Terms& terms, const std::vector<char>& fixed, std::vector<double>& phi) {
  const Mesh& mesh = rule_.mesh();
  const int n = rule_.corners(), nodes = mesh.nodes;
  std::vector<double> gradient, returned(nodes, 0.0);
  rule_.gradient(phi, 1, gradient);
  system_.zero();
  auto& values = system_.matrix().values;
  rule_.for_each_cell([&](const VertexRule::At& at) {
    double K[8][8] = {};
    for (int v = 0; v < n; ++v) {
      const Vec3 flux = at.weight[v] * vec3(&(*terms.flux)[3 * static_cast<std::size_t>(at.node[v])]);
      const double D = at.weight[v] * terms.diffusivity[at.node[v]];
      for (int b = 0; b < n; ++b) K[v][b] += flux.dot(at.slope[v][b]);
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < a; ++b) {
          const double stiffness = D * at.slope[v][a].dot(at.slope[v][b]);
          K[a][b] += stiffness, K[b][a] += stiffness;
          K[a][a] -= stiffness, K[b][b] -= stiffness;
        }
    }
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < a; ++b) {
        const double added = std::max({0.0, K[a][b], K[b][a]});
        if (added == 0) continue;
        K[a][b] -= added, K[b][a] -= added;
        K[a][a] += added, K[b][b] += added;
        const int i = at.node[a], j = at.node[b];
        const Vec3 edge = vec3(at.x + 3 * a) - vec3(at.x + 3 * b);
        const double own = phi[i] - phi[j];
        const double one = 2 * vec3(&gradient[3 * static_cast<std::size_t>(i)]).dot(edge) - own,
                     other = 2 * vec3(&gradient[3 * static_cast<std::size_t>(j)]).dot(edge) - own;
        const double back = added * smooth_part(own, one, other);
        returned[i] += back;
        returned[j] -= back;
      }
    const int* entry = &graph_.cell_entry[static_cast<std::size_t>(at.cell) * n * n];
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) values[entry[a * n + b]] += K[a][b];
  });
  mesh.sum_shared(returned.data(), 1);

  const auto& volume = rule_.volume();
  for (int i = 0; i < nodes; ++i) {
    double coefficient = volume[i] * (terms.rate * terms.storage[i] + terms.destruction[i]),
           right = volume[i] * terms.production[i];
    for (const double rest : {returned[i], volume[i] * terms.storage[i] * terms.history[i]}) {
      if (rest >= 0)
        right += rest;
      else
        coefficient -= rest / std::max(phi[i], 1e-100);
    }
    if (!terms.entering.empty() && terms.entering[i] > 0) {
      coefficient += terms.entering[i];
      right += terms.entering[i] * terms.entering_value[i];
    }
    if (i < mesh.owned_nodes) values[graph_.diagonal[i]] += coefficient;
    system_.right()[i] = right;
  }
  const int iterations = system_.solve(fixed, phi);
  bool bad = false;
  for (double& value : phi) {
    bad = bad || !std::isfinite(value);
    value = std::max(value, 0.0);  // the linear solver leaves a rest of either sign
  }
  if (mpi_any(bad)) throw SolveFailure("the turbulence became non-finite");
  return iterations;
}

}  // namespace silt
