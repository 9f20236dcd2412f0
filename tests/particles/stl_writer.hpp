#pragma once
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "base/petsc.hpp"
#include "base/vector.hpp"

namespace silt::test {

using Triangle = std::array<Vec3, 3>;

inline std::vector<Triangle> quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {{a, b, c}, {a, c, d}};
}

/// The surface of a box, normals outwards, facets 1, 2: floor; 3, 4: top.
inline std::vector<Triangle> box_triangles(const Vec3& l, const Vec3& u) {
  const auto at = [&](int x, int y, int z) { return Vec3(x ? u[0] : l[0], y ? u[1] : l[1], z ? u[2] : l[2]); };
  std::vector<Triangle> all;
  const auto add = [&](const std::vector<Triangle>& two) { all.insert(all.end(), two.begin(), two.end()); };
  add(quad(at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)));
  add(quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)));
  add(quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)));
  add(quad(at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)));
  add(quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)));
  add(quad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)));
  return all;
}

/// The shell of a cylinder along y about (0, 0) with n facets round, corners on the circle, normals outwards, open
/// ends.
inline std::vector<Triangle> shell_triangles(double radius, double from, double to, int n) {
  std::vector<Triangle> all;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * k / n, b = 2 * std::numbers::pi * (k + 1) / n;
    const auto at = [&](double angle, double y) { return Vec3(radius * std::cos(angle), y, radius * std::sin(angle)); };
    for (const auto& t : quad(at(a, from), at(a, to), at(b, to), at(b, from))) all.push_back(t);
  }
  return all;
}

/// Writes an STL file (by rank 0; all wait).
inline void write_stl(const std::string& file, const std::vector<Triangle>& triangles, bool binary = false) {
  if (mpi_rank() == 0) {
    std::ofstream stream(file, std::ios::binary);
    if (binary) {
      const std::string header(80, ' ');
      stream.write(header.data(), 80);
      const auto count = static_cast<std::uint32_t>(triangles.size());
      stream.write(reinterpret_cast<const char*>(&count), 4);
    } else {
      stream << "solid test\n";
    }
    for (const auto& t : triangles) {
      const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
      if (binary) {
        float numbers[12];
        for (int d = 0; d < 3; ++d) {
          numbers[d] = static_cast<float>(n[d]);
          for (int k = 0; k < 3; ++k) numbers[3 + 3 * k + d] = static_cast<float>(t[k][d]);
        }
        stream.write(reinterpret_cast<const char*>(numbers), sizeof numbers);
        stream.write("\0\0", 2);
      } else {
        stream << fmt::format("facet normal {} {} {}\n outer loop\n", n[0], n[1], n[2]);
        for (const Vec3& x : t) stream << fmt::format("  vertex {:.17g} {:.17g} {:.17g}\n", x[0], x[1], x[2]);
        stream << " endloop\nendfacet\n";
      }
    }
    if (!binary) stream << "endsolid test\n";
  }
  MPI_Barrier(PETSC_COMM_WORLD);
}

}  // namespace silt::test
