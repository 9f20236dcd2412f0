#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/mesh.hpp"

namespace silt::test {

/// A mesh of mapped hexahedra, made by way of a Gmsh file: those cells (i, j, k) of a grid for which `keep` holds,
/// corners moved by `map`, every boundary facet named by `name` of its centre. `node` may replace a grid point by
/// another one: cells of layers that are not kept then share their points, or leave a slit.
struct Grid {
  std::array<int, 3> cells{1, 1, 1};
  std::function<bool(int, int, int)> keep = [](int, int, int) { return true; };
  std::function<std::array<int, 3>(int, int, int)> node = [](int i, int j, int k) { return std::array{i, j, k}; };
  std::function<Vec3(const Vec3&)> map = [](const Vec3& x) { return x; };
  std::function<std::string(const Vec3&)> name = [](const Vec3&) { return std::string("shell"); };
};

inline Mesh grid_mesh(const Grid& grid) {
  const std::string file = "silt_test_grid.msh";
  if (mpi_rank() == 0) {
    const auto& n = grid.cells;
    const auto node = [&](int i, int j, int k) {
      const auto at = grid.node(i, j, k);
      return at[0] + (n[0] + 1) * (at[1] + (n[1] + 1) * at[2]);
    };
    std::vector<Vec3> points;
    for (int k = 0; k <= n[2]; ++k)
      for (int j = 0; j <= n[1]; ++j)
        for (int i = 0; i <= n[0]; ++i) points.push_back(grid.map(Vec3(i, j, k)));
    std::map<int, int> number;
    const auto used = [&](int id) { return number.emplace(id, static_cast<int>(number.size()) + 1).first->second; };
    std::map<std::string, int> tags;
    std::string elements;
    int count = 0;
    const auto add = [&](int type, int tag, const std::vector<int>& nodes) {
      elements += fmt::format("{} {} 2 {} {}", ++count, type, tag, tag);
      for (int id : nodes) elements += fmt::format(" {}", used(id));
      elements += "\n";
    };
    std::map<std::vector<int>, std::vector<int>> outside;  // facets that one cell only has, by their sorted nodes
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          if (!grid.keep(i, j, k)) continue;
          std::vector<int> corners;
          for (int dz : {0, 1})
            for (int c : {0, 1, 3, 2}) corners.push_back(node(i + (c & 1), j + (c >> 1), k + dz));
          add(5, 100, corners);
          static const int sides[6][4] = {{0, 3, 7, 4}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                          {3, 2, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};
          for (const auto& side : sides) {
            std::vector<int> nodes, sorted;
            for (int a : side) nodes.push_back(corners[a]);
            sorted = nodes;
            std::sort(sorted.begin(), sorted.end());
            if (!outside.emplace(sorted, nodes).second) outside.erase(sorted);
          }
        }
    for (const auto& [sorted, nodes] : outside) {
      Vec3 centre = Vec3::Zero();
      for (int a : nodes) centre += 0.25 * points[a];
      add(3, tags.emplace(grid.name(centre), static_cast<int>(tags.size()) + 1).first->second, nodes);
    }
    std::ofstream out(file);
    out.precision(17);
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" << tags.size() + 1 << "\n";
    for (const auto& [text, tag] : tags) out << "2 " << tag << " \"" << text << "\"\n";
    out << "3 100 \"domain\"\n$EndPhysicalNames\n$Nodes\n" << number.size() << "\n";
    for (const auto& [id, label] : number)
      out << label << " " << points[id][0] << " " << points[id][1] << " " << points[id][2] << "\n";
    out << "$EndNodes\n$Elements\n" << count << "\n" << elements << "$EndElements\n";
  }
  MPI_Barrier(PETSC_COMM_WORLD);
  MeshOptions options;
  options.type = "file";
  options.file = file;
  Mesh mesh(options);
  MPI_Barrier(PETSC_COMM_WORLD);
  if (mpi_rank() == 0) std::remove(file.c_str());
  return mesh;
}

inline Mesh box_mesh(const std::string& cell, Vec3 lower, Vec3 upper, std::vector<int> cells,
                     std::vector<int> periodic = {0, 0, 0}) {
  MeshOptions options;
  options.cell = cell;
  options.lower = lower;
  options.upper = upper;
  options.cells = std::move(cells);
  options.periodic = std::move(periodic);
  return Mesh(options);
}

}  // namespace silt::test
