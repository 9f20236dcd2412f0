#include "fluid/space/lagrange_space.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <stdexcept>

#include "fluid/space/quadratic_element.hpp"
#include "fluid/space/rendezvous.hpp"

namespace silt {
namespace {

/// PETSc keeps its exchange buffers by data type: each type is made once and kept.
MPI_Datatype doubles(int components) {
  static std::map<int, MPI_Datatype> types;
  auto [entry, added] = types.try_emplace(components, MPI_DOUBLE);
  if (added && components > 1) {
    MPI_Type_contiguous(components, MPI_DOUBLE, &entry->second);
    MPI_Type_commit(&entry->second);
  }
  return entry->second;
}

}  // namespace

LagrangeSpace::LagrangeSpace(const Mesh& m, int space_order) : mesh(m), order(space_order) {
  if (order != 1 && order != 2) throw std::logic_error("LagrangeSpace: order 1 or 2");
  nodes = mesh.nodes;
  nodes_per_cell = mesh.nodes_per_cell;
  cell_nodes = mesh.cell_nodes;
  node_coordinates = mesh.node_coordinates;
  for (int i = 0; i <= nodes; ++i) parent_start.push_back(i);
  for (int i = 0; i < nodes; ++i) parents.push_back(i);
  if (order == 2) add_middles();
  number_globally();
}

void LagrangeSpace::add_middles() {
  const int n = quadratic_nodes(mesh.cell), vertices = mesh.nodes_per_cell;
  nodes_per_cell = n;
  cell_nodes.assign(static_cast<size_t>(mesh.cells) * n, 0);
  std::map<std::vector<int>, int> known;
  for (int c = 0; c < mesh.cells; ++c) {
    const int* v = mesh.cell_nodes.data() + static_cast<size_t>(c) * vertices;
    const double* x = mesh.cell_coordinates.data() + 3 * static_cast<size_t>(c) * vertices;
    for (int a = 0; a < n; ++a) {
      int& place = cell_nodes[static_cast<size_t>(c) * n + a];
      const std::vector<int>& local = quadratic_parents(mesh.cell, a);
      if (local.size() == 1) {
        place = v[local[0]];
        continue;
      }
      std::vector<int> key;
      key.reserve(local.size());
      for (int p : local) key.push_back(v[p]);
      std::sort(key.begin(), key.end());
      const auto [entry, fresh] = known.try_emplace(key, nodes);
      place = entry->second;
      if (!fresh) continue;
      ++nodes;
      parents.insert(parents.end(), key.begin(), key.end());
      parent_start.push_back(static_cast<int>(parents.size()));
      Vec3 middle = Vec3::Zero();
      for (int p : local) middle += vec3(x + 3 * p) / static_cast<double>(local.size());
      node_coordinates.insert(node_coordinates.end(), middle.data(), middle.data() + 3);
    }
  }
}

void LagrangeSpace::number_globally() {
  owned.assign(nodes, 1);
  for (int i = mesh.owned_nodes; i < mesh.nodes; ++i) owned[i] = 0;
  std::vector<int> shared;                     // middles that another rank may have
  std::vector<std::array<long long, 8>> keys;  // their names
  if (mpi_size() > 1 && order == 2) {
    std::vector<double> holders(mesh.nodes, 1.0);
    mesh.sum_shared(holders.data(), 1);
    for (int i = mesh.nodes; i < nodes; ++i) {
      std::array<long long, 8> key;
      key.fill(-1);
      bool everywhere = true;
      for (int k = parent_start[i]; k < parent_start[i + 1]; ++k) {
        everywhere = everywhere && holders[parents[k]] > 1;
        key[k - parent_start[i]] = mesh.node_global[parents[k]];
      }
      std::sort(key.begin(), key.end());
      if (!everywhere || parent_start[i + 1] - parent_start[i] == mesh.nodes_per_cell) continue;
      shared.push_back(i);
      keys.push_back(key);
    }
    const std::vector<long long> lowest = least_over_ranks(keys, std::vector<long long>(keys.size(), mpi_rank()));
    for (size_t k = 0; k < shared.size(); ++k) owned[shared[k]] = lowest[k] == mpi_rank();
  }

  owned_nodes = static_cast<int>(std::count(owned.begin(), owned.end(), 1));
  long long mine = owned_nodes, first = 0;
  MPI_Exscan(&mine, &first, 1, MPI_LONG_LONG, MPI_SUM, PETSC_COMM_WORLD);
  if (mpi_rank() == 0) first = 0;
  node_global.assign(nodes, -1);
  std::vector<double> number(mesh.nodes, 0.0);
  PetscInt next = static_cast<PetscInt>(first);
  for (int i = 0; i < nodes; ++i)
    if (owned[i]) {
      node_global[i] = next++;
      if (i < mesh.nodes) number[i] = node_global[i];
    }
  mesh.copy_from_owner(number.data(), 1);
  for (int i = 0; i < mesh.nodes; ++i) node_global[i] = static_cast<PetscInt>(number[i]);
  if (mpi_size() == 1) return;

  // The owner's number is the least one that is offered: the others offer none.
  std::vector<long long> offered;
  offered.reserve(shared.size());
  for (int i : shared) offered.push_back(owned[i] ? node_global[i] : std::numeric_limits<long long>::max());
  const std::vector<long long> numbers = least_over_ranks(keys, offered);
  for (size_t k = 0; k < shared.size(); ++k) node_global[shared[k]] = static_cast<PetscInt>(numbers[k]);

  PetscLayout layout;
  SILT_PETSC(PetscLayoutCreateFromSizes(PETSC_COMM_WORLD, owned_nodes, PETSC_DETERMINE, 1, &layout));
  SILT_PETSC(PetscSFCreate(PETSC_COMM_WORLD, exchange_.out()));
  SILT_PETSC(PetscSFSetGraphLayout(exchange_, layout, nodes, nullptr, PETSC_COPY_VALUES, node_global.data()));
  SILT_PETSC(PetscLayoutDestroy(&layout));
}

void LagrangeSpace::interpolate(const double* vertices, double* values, int components) const {
  std::copy(vertices, vertices + static_cast<size_t>(mesh.nodes) * components, values);
  for (int i = mesh.nodes; i < nodes; ++i) {
    const double weight = 1.0 / (parent_start[i + 1] - parent_start[i]);
    for (int c = 0; c < components; ++c) {
      double sum = 0;
      for (int k = parent_start[i]; k < parent_start[i + 1]; ++k)
        sum += vertices[static_cast<size_t>(parents[k]) * components + c];
      values[static_cast<size_t>(i) * components + c] = weight * sum;
    }
  }
}

void LagrangeSpace::sum_shared(double* values, int components) const {
  if (mpi_size() == 1 || components == 0) return;
  if (order == 1) return mesh.sum_shared(values, components);
  const MPI_Datatype unit = doubles(components);
  std::vector<double> sums(static_cast<size_t>(owned_nodes) * components, 0.0);
  SILT_PETSC(PetscSFReduceBegin(exchange_, unit, values, sums.data(), MPI_SUM));
  SILT_PETSC(PetscSFReduceEnd(exchange_, unit, values, sums.data(), MPI_SUM));
  SILT_PETSC(PetscSFBcastBegin(exchange_, unit, sums.data(), values, MPI_REPLACE));
  SILT_PETSC(PetscSFBcastEnd(exchange_, unit, sums.data(), values, MPI_REPLACE));
}

}  // namespace silt
