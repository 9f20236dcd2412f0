#pragma once
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "base/mesh.hpp"
#include "base/nodal_matrix.hpp"

namespace silt::test {

inline MeshOptions box(const std::string& cell, std::vector<int> cells, Vec3 upper = Vec3::Ones(),
                       std::vector<int> periodic = {0, 0, 0}) {
  MeshOptions options;
  options.cell = cell;
  options.cells = std::move(cells);
  options.upper = upper;
  options.periodic = std::move(periodic);
  if (options.cells.size() == 2) options.upper[2] = 0;
  return options;
}

/// Bends the cells of a box smoothly, keeping its sides: quadrilaterals and hexahedra are no longer affine.
inline void bend(Mesh& mesh) {
  const auto move = [&](double* x) {
    Vec3 s = Vec3::Zero();
    for (int d = 0; d < mesh.dimension; ++d) s[d] = (x[d] - mesh.lower[d]) / (mesh.upper[d] - mesh.lower[d]);
    double wave = 0.1;
    for (int d = 0; d < mesh.dimension; ++d) wave *= std::sin(2 * std::numbers::pi * s[d]);
    for (int d = 0; d < mesh.dimension; ++d) x[d] += (d + 1) * wave * (mesh.upper[d] - mesh.lower[d]) / 3;
  };
  for (std::size_t k = 0; k < mesh.cell_coordinates.size(); k += 3) move(&mesh.cell_coordinates[k]);
  for (std::size_t k = 0; k < mesh.node_coordinates.size(); k += 3) move(&mesh.node_coordinates[k]);
}

/// The same pseudo-random value at a shared node on every rank.
inline double noise(const Mesh& mesh, int node, int seed) {
  std::mt19937 random(static_cast<unsigned>(mesh.node_global[node] * 977 + seed));
  random.discard(3);
  return std::uniform_real_distribution<double>(-1, 1)(random);
}

inline double total(const Mesh& mesh, const std::vector<double>& a, const std::vector<double>& b) {
  return mesh.dot(a.data(), b.data(), 1);
}

struct Kind {
  const char* cell;
  std::vector<int> cells;
  bool bent;
};
inline const std::vector<Kind> kinds = {{"triangle", {9, 7}, false},      {"quadrilateral", {9, 7}, false},
                                        {"quadrilateral", {9, 7}, true},  {"tetrahedron", {6, 5, 4}, false},
                                        {"tetrahedron", {6, 5, 4}, true}, {"hexahedron", {6, 5, 4}, false},
                                        {"hexahedron", {6, 5, 4}, true},  {"hexahedron", {12, 5, 2}, false}};

}  // namespace silt::test
