#include "particles/walls/facet_shapes.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/petsc.hpp"
#include "particles/walls/stl_file.hpp"

namespace silt {
namespace {

SurfaceFacet facet(const std::array<Vec3, 3>& corner, bool reversed) {
  SurfaceFacet result;
  result.corners = 3;
  result.corner = {corner[0], reversed ? corner[2] : corner[1], reversed ? corner[1] : corner[2], Vec3::Zero()};
  return result;
}

/// `triangles`: corners anticlockwise seen from outside the body.
FacetShape shape_of(const std::vector<std::array<Vec3, 3>>& triangles, WallSideChoice side, const Surface& domain,
                    double round_off, double smooth_angle) {
  std::vector<SurfaceFacet> facets;
  FacetShape shape;
  for (const auto& corner : triangles) {
    if (side != WallSideChoice::outside) facets.push_back(facet(corner, false));
    if (side != WallSideChoice::inside) facets.push_back(facet(corner, true));
    for (const Vec3& x : corner) shape.box.add(x);
  }
  shape.both = side == WallSideChoice::both;
  auto surface = std::make_shared<Surface>(std::move(facets), domain.lower, domain.upper, domain.periodic, round_off);
  shape.room = std::make_shared<Room>(*surface, std::vector<bool>{true});
  shape.wall = FacetedWall(WallShape(*surface, {true}, smooth_angle), smooth_angle);
  shape.surface = std::move(surface);
  return shape;
}

/// The facets of a file, read and checked by one rank.
std::vector<StlFacet> checked(const std::string& file, bool closed, const std::string& prefix) {
  std::vector<StlFacet> facets;
  std::string mistake;
  if (mpi_rank() == 0) {
    try {
      facets = read_stl(file);
      check_stl(facets, closed, file);
    } catch (const UserError& error) {
      mistake = fmt::format("option -{}_file: {}", prefix, error.what());
    }
  }
  int sizes[2] = {static_cast<int>(mistake.size()), static_cast<int>(facets.size())};
  MPI_Bcast(sizes, 2, MPI_INT, 0, PETSC_COMM_WORLD);
  mistake.resize(sizes[0]);
  MPI_Bcast(mistake.data(), sizes[0], MPI_CHAR, 0, PETSC_COMM_WORLD);
  if (!mistake.empty()) throw UserError(mistake);
  facets.resize(sizes[1]);
  static_assert(sizeof(StlFacet) == 12 * sizeof(double));
  MPI_Datatype type;
  MPI_Type_contiguous(12, MPI_DOUBLE, &type);
  MPI_Type_commit(&type);
  MPI_Bcast(facets.data(), sizes[1], type, 0, PETSC_COMM_WORLD);
  MPI_Type_free(&type);
  return facets;
}

}  // namespace

FacetShape box_shape(const Vec3& lower, const Vec3& upper, WallSideChoice side, const Surface& domain,
                     const std::string& prefix, double smooth_angle) {
  for (int d = 0; d < 3; ++d)
    if (!(upper[d] > lower[d]))
      throw UserError(fmt::format("option -{}_upper: {:g} must be above -{}_lower {:g} in direction {}", prefix,
                                  upper[d], prefix, lower[d], "xyz"[d]));
  std::vector<std::array<Vec3, 3>> triangles;
  for (int d = 0; d < 3; ++d)
    for (int end = 0; end < 2; ++end) {
      const int a = (d + 1) % 3, b = (d + 2) % 3;
      std::array<Vec3, 4> corner;
      for (int k = 0; k < 4; ++k) {
        corner[k][d] = end ? upper[d] : lower[d];
        corner[k][a] = k == 1 || k == 2 ? upper[a] : lower[a];
        corner[k][b] = k >= 2 ? upper[b] : lower[b];
      }
      if (end == 0) std::swap(corner[1], corner[3]);
      triangles.push_back({corner[0], corner[1], corner[2]});
      triangles.push_back({corner[0], corner[2], corner[3]});
    }
  return shape_of(triangles, side, domain, 1e-15, smooth_angle);
}

FacetShape stl_shape(const std::string& file, double scale, const Vec3& offset, WallSideChoice side,
                     const Surface& domain, const std::string& prefix, double smooth_angle) {
  std::vector<std::array<Vec3, 3>> triangles;
  for (const auto& read : checked(file, side != WallSideChoice::both, prefix)) {
    auto& corner = triangles.emplace_back();
    for (int k = 0; k < 3; ++k) corner[k] = scale * read.corner[k] + offset;
  }
  return shape_of(triangles, side, domain, 1e-7, smooth_angle);
}

}  // namespace silt
