// What a solution of the FlowSystem means: fluxes, integrals and forces.
#include <algorithm>

#include "fluid/assembly/flow_system.hpp"
#include "fluid/assembly/flow_table.hpp"

namespace silt {

std::vector<double> FlowSystem::superficial_velocity(const StepFields& fields, Vec x) const {
  std::vector<double> state;
  SILT_PETSC(local_state(x, state));
  const FlowData d = data(fields, state.data());
  const size_t size = 3 * static_cast<size_t>(d.table->points);
  std::vector<double> result(size * mesh_.cells, 0.0), batch(size * kernel_.lanes, 0.0);
  for (int first = 0; first < mesh_.cells; first += kernel_.lanes) {
    const int count = std::min(kernel_.lanes, mesh_.cells - first);
    kernel_.flux(d, first, count, batch.data());
    std::copy_n(batch.data(), size * count, &result[size * first]);
  }
  return result;
}

std::vector<double> FlowSystem::nodal_outflow(const StepFields& fields, Vec x) const {
  std::vector<double> state;
  SILT_PETSC(local_state(x, state));
  const FlowData d = data(fields, state.data());
  const size_t np = mesh_.nodes_per_cell;
  std::vector<double> result(mesh_.nodes, 0.0), cell(np);
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    const BoundaryFacet& facet = mesh_.facets[f];
    if (boundary_.type(facet.boundary) != BoundaryType::pressure) continue;
    std::fill(cell.begin(), cell.end(), 0.0);
    facets_.add_nodal_flow(d, f, cell.data());
    for (size_t a = 0; a < np; ++a) result[mesh_.cell_nodes[facet.cell * np + a]] += cell[a];
  }
  mesh_.sum_shared(result.data(), 1);
  for (int i = 0; i < mesh_.nodes; ++i) result[i] += fields.prescribed_flow[i];
  return result;
}

std::vector<FacetIntegrals> FlowSystem::boundary_integrals(const StepFields& fields, Vec x) const {
  std::vector<double> state;
  SILT_PETSC(local_state(x, state));
  const FlowData d = data(fields, state.data());
  constexpr int numbers = 9;
  std::vector<double> sums(numbers * mesh_.boundaries.size(), 0.0);
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    const FacetIntegrals one = facets_.integrate(d, f);
    double* s = &sums[numbers * static_cast<size_t>(mesh_.facets[f].boundary)];
    s[0] += one.volume_flow;
    s[1] += one.pressure;
    s[2] += one.area;
    vec3(s + 3) += one.traction;
    vec3(s + 6) += one.convection;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  std::vector<FacetIntegrals> result(mesh_.boundaries.size());
  for (size_t b = 0; b < result.size(); ++b) {
    const double* s = &sums[numbers * b];
    result[b] = {s[0], s[1], s[2], vec3(s + 3), vec3(s + 6)};
  }
  return result;
}

std::vector<Vec3> FlowSystem::boundary_forces(const StepFields& fields, Vec x) const {
  std::vector<double> rest = reaction(fields, x);
  std::vector<double> state;
  SILT_PETSC(local_state(x, state));
  const FlowData d = data(fields, state.data());
  const size_t boundaries = mesh_.boundaries.size(), nv = space_.nodes_per_cell;
  std::vector<double> force(3 * boundaries, 0.0), nodal(3 * static_cast<size_t>(space_.nodes)), cell(3 * nv);
  for (double& r : rest) r = -r;
  for (size_t b = 0; b < boundaries; ++b) {
    // Tractions at the nodes between boundaries, taken out of what is left of their reactions.
    std::fill(nodal.begin(), nodal.end(), 0.0);
    for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
      if (mesh_.facets[f].boundary != static_cast<int>(b)) continue;
      if (boundary_.type(static_cast<int>(b)) == BoundaryType::pressure) continue;
      std::fill(cell.begin(), cell.end(), 0.0);
      facets_.add_nodal_force(d, f, cell.data());
      for (size_t a = 0; a < nv; ++a)
        vec3(&nodal[3 * static_cast<size_t>(space_.cell_nodes[mesh_.facets[f].cell * nv + a])]) += vec3(&cell[3 * a]);
    }
    space_.sum_shared(nodal.data(), 3);
    for (const Share& s : shares_) {
      if (s.boundary != static_cast<int>(b) || s.share == 1 || constraints_.of_node()[s.node] < 0) continue;
      vec3(&force[3 * b]) += vec3(&nodal[3 * static_cast<size_t>(s.node)]);
      vec3(&rest[3 * static_cast<size_t>(s.node)]) -= vec3(&nodal[3 * static_cast<size_t>(s.node)]);
    }
  }
  for (const Share& s : shares_)
    if (constraints_.of_node()[s.node] >= 0)
      vec3(&force[3 * static_cast<size_t>(s.boundary)]) += s.share * vec3(&rest[3 * static_cast<size_t>(s.node)]);
  MPI_Allreduce(MPI_IN_PLACE, force.data(), static_cast<int>(force.size()), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  std::vector<Vec3> result(boundaries);
  for (size_t b = 0; b < boundaries; ++b) result[b] = vec3(&force[3 * b]);
  return result;
}

}  // namespace silt
