#include "fluid/assembly/flow_system.hpp"

#include <algorithm>
#include <map>

#include "base/nodal_matrix.hpp"
#include "fluid/assembly/flow_table.hpp"

namespace silt {

FlowSystem::FlowSystem(const Mesh& mesh, const BoundaryConditions& boundary, int order, int lanes)
    : mesh_(mesh),
      boundary_(boundary),
      space_(mesh, order),
      constraints_(space_, boundary),
      facets_(mesh, order),
      kernel_(flow_kernel(mesh.cell, order, lanes)),
      dimension_(mesh.dimension),
      block_(order == 1 ? mesh.dimension + 1 : 1),
      lumped_mass_(silt::lumped_mass(mesh)) {
  for (int i = 0; i < mesh.owned_nodes; ++i) total_mass_ += lumped_mass_[i];
  total_mass_ = mpi_sum(total_mass_);
  cell_size_ = shortest_edges(mesh);
  number();
  find_shares();
}

void FlowSystem::number() {
  const int nv = space_.nodes, np = mesh_.nodes, d = dimension_;
  layout_ = equal_order() ? FlowLayout{d + 1, d, d + 1, np * (d + 1)} : FlowLayout{d, nv * d, 1, nv * d + np};
  global_.assign(layout_.size, 0);
  owned_.assign(layout_.size, 0);
  fixed_.assign(layout_.size, 0);
  if (equal_order()) {
    owned_rows_ = static_cast<PetscInt>(mesh_.owned_nodes) * block_;
    for (int i = 0; i < np; ++i)
      for (int c = 0; c < block_; ++c) {
        global_[i * block_ + c] = static_cast<PetscInt>(space_.node_global[i]) * block_ + c;
        owned_[i * block_ + c] = space_.owned[i];
      }
  } else {
    // Each rank: its velocities, then its pressures. The owner's numbers reach the others through the node exchanges.
    owned_rows_ = static_cast<PetscInt>(space_.owned_nodes) * d + mesh_.owned_nodes;
    PetscInt next = 0;
    MPI_Exscan(&owned_rows_, &next, 1, MPIU_INT, MPI_SUM, PETSC_COMM_WORLD);
    if (mpi_rank() == 0) next = 0;
    std::vector<double> first(nv, 0.0), pressure(np, 0.0);
    for (int i = 0; i < nv; ++i)
      if (space_.owned[i]) first[i] = next, next += d;
    for (int i = 0; i < mesh_.owned_nodes; ++i) pressure[i] = next++;
    space_.sum_shared(first.data(), 1);
    mesh_.copy_from_owner(pressure.data(), 1);
    for (int i = 0; i < nv; ++i)
      for (int c = 0; c < d; ++c) {
        global_[velocity_place(i, c)] = static_cast<PetscInt>(first[i]) + c;
        owned_[velocity_place(i, c)] = space_.owned[i];
      }
    for (int i = 0; i < np; ++i) {
      global_[pressure_place(i)] = static_cast<PetscInt>(pressure[i]);
      owned_[pressure_place(i)] = i < mesh_.owned_nodes;
    }
  }
  for (const auto& c : constraints_.constraints())
    for (int k = 0; k < c.count; ++k) fixed_[velocity_place(c.node, k)] = 1;
  fixed_facet_.assign(mesh_.facets.size(), 0);
  for (size_t f = 0; f < mesh_.facets.size(); ++f) {
    const BoundaryFacet& facet = mesh_.facets[f];
    const int* v = &space_.cell_nodes[static_cast<size_t>(facet.cell) * space_.nodes_per_cell];
    fixed_facet_[f] = boundary_.type(facet.boundary) != BoundaryType::pressure;
    for (int a = 0; a < space_.nodes_per_cell; ++a)
      if (facets_.on_facet(facet.facet, a))
        for (int c = 0; c < d; ++c) fixed_facet_[f] &= fixed_[velocity_place(v[a], c)];
  }

  SILT_PETSC(VecCreateSeq(PETSC_COMM_SELF, layout_.size, local_.out()));
  IsHandle from;
  SILT_PETSC(ISCreateGeneral(PETSC_COMM_SELF, layout_.size, global_.data(), PETSC_COPY_VALUES, from.out()));
  const VecHandle global = create_vector();
  SILT_PETSC(VecScatterCreate(global, from, local_, nullptr, scatter_.out()));
}

void FlowSystem::find_shares() {
  const size_t nodes = space_.nodes, boundaries = mesh_.boundaries.size();
  std::vector<double> area(nodes * boundaries, 0.0);
  for (const FacetRule& facet : boundary_.facets()) {
    if (boundary_.type(facet.boundary) == BoundaryType::pressure) continue;
    double size = 0;
    for (int q = 0; q < facet.points; ++q) size += facet.point[q].area.norm();
    const auto on_facet = [&](int vertex) {
      return std::find(facet.node.begin(), facet.node.begin() + facet.nodes, vertex) !=
             facet.node.begin() + facet.nodes;
    };
    for (int a = 0; a < space_.nodes_per_cell; ++a) {
      const int i = space_.cell_nodes[static_cast<size_t>(facet.cell) * space_.nodes_per_cell + a];
      if (std::all_of(space_.parents.data() + space_.parent_start[i],
                      space_.parents.data() + space_.parent_start[i + 1], on_facet))
        area[i * boundaries + facet.boundary] += size;
    }
  }
  space_.sum_shared(area.data(), static_cast<int>(boundaries));
  for (size_t i = 0; i < nodes; ++i) {
    double sum = 0;
    for (size_t b = 0; b < boundaries; ++b) sum += area[i * boundaries + b];
    for (size_t b = 0; b < boundaries; ++b)
      if (space_.owned[i] && area[i * boundaries + b] > 0)
        shares_.push_back({static_cast<int>(i), static_cast<int>(b), area[i * boundaries + b] / sum});
  }
}

VecHandle FlowSystem::create_vector() const {
  VecHandle x;
  SILT_PETSC(VecCreate(PETSC_COMM_WORLD, x.out()));
  SILT_PETSC(VecSetSizes(x, owned_rows_, PETSC_DETERMINE));
  SILT_PETSC(VecSetBlockSize(x, block_));
  SILT_PETSC(VecSetType(x, VECSTANDARD));
  return x;
}

IsHandle FlowSystem::velocity_rows() const {
  std::vector<PetscInt> rows;
  for (int i = 0; i < space_.nodes; ++i)
    for (int c = 0; c < dimension_; ++c)
      if (owned_[velocity_place(i, c)]) rows.push_back(global_[velocity_place(i, c)]);
  IsHandle is;
  SILT_PETSC(
      ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(rows.size()), rows.data(), PETSC_COPY_VALUES, is.out()));
  if (!equal_order()) SILT_PETSC(ISSetBlockSize(is, dimension_));
  return is;
}

IsHandle FlowSystem::pressure_rows() const {
  std::vector<PetscInt> rows;
  rows.reserve(mesh_.owned_nodes);
  for (int i = 0; i < mesh_.owned_nodes; ++i) rows.push_back(global_[pressure_place(i)]);
  IsHandle is;
  SILT_PETSC(
      ISCreateGeneral(PETSC_COMM_WORLD, static_cast<PetscInt>(rows.size()), rows.data(), PETSC_COPY_VALUES, is.out()));
  return is;
}

void FlowSystem::rotate_rows(double* values) const {
  to_frames(
      constraints_, dimension_, [this](int node) { return velocity_place(node, 0); }, values);
}

void FlowSystem::to_vector(const double* u, const double* p, Vec x) const {
  std::vector<double> values(layout_.size);
  for (int i = 0; i < space_.nodes; ++i)
    for (int c = 0; c < dimension_; ++c) values[velocity_place(i, c)] = u[3 * static_cast<size_t>(i) + c];
  for (int i = 0; i < mesh_.nodes; ++i) values[pressure_place(i)] = p[i];
  rotate_rows(values.data());
  SILT_PETSC(to_global(values, local_, scatter_, x, INSERT_VALUES));
}

PetscErrorCode FlowSystem::local_state(Vec x, std::vector<double>& state) const {
  PetscFunctionBeginUser;
  PetscCall(from_global(x, scatter_, local_, state));
  from_frames(
      constraints_, dimension_, [this](int node) { return velocity_place(node, 0); }, state.data());
  PetscFunctionReturn(0);
}

void FlowSystem::from_vector(Vec x, double* u, double* p) const {
  std::vector<double> state;
  SILT_PETSC(local_state(x, state));
  for (int i = 0; i < space_.nodes; ++i)
    for (int c = 0; c < 3; ++c) u[3 * static_cast<size_t>(i) + c] = c < dimension_ ? state[velocity_place(i, c)] : 0;
  for (int i = 0; i < mesh_.nodes; ++i) p[i] = state[pressure_place(i)];
}

FlowData FlowSystem::data(const StepFields& fields, const double* state) const {
  FlowData d;
  d.cell = mesh_.cell;
  d.table = &flow_table(mesh_.cell, space_.order);
  d.velocity_nodes = space_.cell_nodes.data();
  d.vertices = mesh_.cell_nodes.data();
  d.coordinates = mesh_.cell_coordinates.data();
  d.cell_size = cell_size_.data();
  d.eddy_viscosity = fields.eddy_viscosity.empty() ? nullptr : fields.eddy_viscosity.data();
  d.state = state;
  d.layout = layout_;
  d.alpha = fields.alpha.data();
  d.parameters = fields.parameters;
  nodes_.pack(fields, state, layout_, dimension_);
  nodes_.give(d);
  return d;
}

FacetTerm FlowSystem::facet_term(const StepFields& fields, int f) const {
  return {boundary_.type(mesh_.facets[f].boundary) == BoundaryType::pressure, fields.backflow,
          fields.boundary_pressure.data()};
}

void FlowSystem::cell_places(int cell, PetscInt* places) const {
  const int* v = &space_.cell_nodes[static_cast<size_t>(cell) * space_.nodes_per_cell];
  const int* n = &mesh_.cell_nodes[static_cast<size_t>(cell) * mesh_.nodes_per_cell];
  int row = 0;
  for (int a = 0; a < space_.nodes_per_cell; ++a) {
    for (int i = 0; i < dimension_; ++i) places[row++] = velocity_place(v[a], i);
    if (equal_order()) places[row++] = pressure_place(v[a]);
  }
  if (!equal_order())
    for (int a = 0; a < mesh_.nodes_per_cell; ++a) places[row++] = pressure_place(n[a]);
}

void FlowSystem::local_residual(const StepFields& fields, const std::vector<double>& state,
                                std::vector<double>& residual) const {
  residual.assign(layout_.size, 0.0);
  const FlowData d = data(fields, state.data());
  const int rows = kernel_.rows;
  std::vector<double> values(static_cast<size_t>(kernel_.lanes) * rows);
  std::vector<PetscInt> places(rows);
  const auto add_blocks = [&](int cell, const double* r, auto block) {
    const int* v = &mesh_.cell_nodes[static_cast<size_t>(cell) * mesh_.nodes_per_cell];
    for (int a = 0; a < mesh_.nodes_per_cell; ++a, r += block) {
      double* to = &residual[static_cast<size_t>(v[a]) * block];
      for (int k = 0; k < block; ++k) to[k] += r[k];
    }
  };
  const auto add = [&](int cell, const double* r) {
    if (block_ == 4) return add_blocks(cell, r, std::integral_constant<int, 4>{});
    if (block_ == 3) return add_blocks(cell, r, std::integral_constant<int, 3>{});
    cell_places(cell, places.data());
    for (int k = 0; k < rows; ++k) residual[places[k]] += r[k];
  };
  for (int first = 0; first < mesh_.cells; first += kernel_.lanes) {
    const int count = std::min(kernel_.lanes, mesh_.cells - first);
    kernel_.evaluate(d, first, count, values.data(), nullptr);
    for (int l = 0; l < count; ++l) add(first + l, &values[static_cast<size_t>(l) * rows]);
  }
  for (int f = 0; f < static_cast<int>(mesh_.facets.size()); ++f) {
    std::fill_n(values.begin(), rows, 0.0);
    facets_.add(d, f, facet_term(fields, f), values.data(), nullptr);
    add(mesh_.facets[f].cell, values.data());
  }
  const double scale = fields.parameters.continuity_scale;
  for (int i = 0; i < mesh_.owned_nodes; ++i) {
    residual[pressure_place(i)] += scale * fields.prescribed_flow[i];
    if (!equal_order()) continue;
    for (int c = 0; c < dimension_; ++c) {
      const size_t k = 3 * static_cast<size_t>(i) + c;
      residual[velocity_place(i, c)] +=
          fields.nodal_response[i] * (state[velocity_place(i, c)] - fields.velocity_old[k]) - fields.nodal_load[k];
    }
  }
}

PetscErrorCode FlowSystem::residual(const StepFields& fields, Vec x, Vec r) const {
  PetscFunctionBeginUser;
  std::vector<double> state, values;
  PetscCall(local_state(x, state));
  local_residual(fields, state, values);
  rotate_rows(values.data());
  PetscCall(to_global(values, local_, scatter_, r, ADD_VALUES));

  PetscInt first;
  PetscCall(VecGetOwnershipRange(r, &first, nullptr));
  const double* unknown;
  PetscCall(VecGetArrayRead(x, &unknown));
  double* array;
  PetscCall(VecGetArray(r, &array));
  for (const auto& c : constraints_.constraints()) {
    if (!space_.owned[c.node]) continue;
    const auto given = vec3(&fields.prescribed_velocity[3 * static_cast<size_t>(c.node)]);
    for (int k = 0; k < c.count; ++k) {
      const PetscInt row = global_[velocity_place(c.node, k)] - first;
      array[row] = unknown[row] - c.frame[k].dot(given);
    }
  }
  if (boundary_.closed()) {
    // The sum of the continuity rows is what the conditions and d(alpha)/dt leave over, whatever the flow: it is spread
    // over the volume, without which no solution exists.
    double sum = 0, total = 0;
    for (int i = 0; i < mesh_.owned_nodes; ++i) sum += array[global_[pressure_place(i)] - first];
    PetscCallMPI(MPI_Allreduce(&sum, &total, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
    for (int i = 0; i < mesh_.owned_nodes; ++i)
      array[global_[pressure_place(i)] - first] -= total * lumped_mass_[i] / total_mass_;
  }
  PetscCall(VecRestoreArrayRead(x, &unknown));
  PetscCall(VecRestoreArray(r, &array));
  PetscFunctionReturn(0);
}

std::vector<double> FlowSystem::reaction(const StepFields& fields, Vec x) const {
  std::vector<double> state, values;
  SILT_PETSC(local_state(x, state));
  local_residual(fields, state, values);
  std::vector<double> result(3 * static_cast<size_t>(space_.nodes), 0.0);
  for (int i = 0; i < space_.nodes; ++i)
    for (int c = 0; c < dimension_; ++c) result[3 * static_cast<size_t>(i) + c] = values[velocity_place(i, c)];
  space_.sum_shared(result.data(), 3);
  return result;
}

}  // namespace silt
