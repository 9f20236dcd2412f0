#include "base/field_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include "base/error.hpp"
#include "base/petsc.hpp"

namespace silt {
namespace {

/// An HDF5 identifier that is closed at the end of its scope.
class Object {
 public:
  Object(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Object() {
    if (id_ >= 0) close_(id_);
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// All numbers of a dataset and its components; empty when it cannot be read.
template <class T>
std::vector<T> read_all(const std::string& path, const std::string& name, hid_t type, int& components) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Object file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Object set(file < 0 ? -1 : H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Object space(set < 0 ? -1 : H5Dget_space(set), H5Sclose);
  hsize_t size[2] = {0, 1};
  const int dimensions = space < 0 ? 0 : H5Sget_simple_extent_ndims(space);
  if (dimensions != 1 && dimensions != 2) return {};
  H5Sget_simple_extent_dims(space, size, nullptr);
  components = static_cast<int>(size[1]);
  std::vector<T> values(size[0] * size[1]);
  if (H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) values.clear();
  return values;
}

/// Place in the file's cell (XDMF's order, around) of each node of ours (lexicographic).
std::array<int, 8> file_order(Cell cell) {
  if (cell == Cell::quadrilateral || cell == Cell::hexahedron) return {0, 1, 3, 2, 4, 5, 7, 6};
  return {0, 1, 2, 3, 4, 5, 6, 7};
}

}  // namespace

FieldFile::FieldFile(const std::string& option, const std::string& path) : option_(option), path_(path) {
  if (mpi_any(!std::filesystem::is_regular_file(path))) refuse("does not exist");
  read_mesh();
  make_bins();
}

void FieldFile::refuse(const std::string& what) const {
  throw UserError(fmt::format("option -{}: '{}' {}", option_, path_, what));
}

void FieldFile::read_mesh() {
  // A run that went on after a restart has written its mesh anew, with the number of its first output.
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::string mesh = (folder / "mesh.h5").string();
  const int number = std::atoi(std::filesystem::path(path_).stem().c_str());
  for (int k = number; k > 0; --k)
    if (const auto later = folder / fmt::format("mesh_{}.h5", k); std::filesystem::is_regular_file(later)) {
      mesh = later.string();
      break;
    }
  int three = 0, corners = 0;
  points_ = read_all<double>(mesh, "points", H5T_NATIVE_DOUBLE, three);
  const auto cells = read_all<std::int64_t>(mesh, "cells", H5T_NATIVE_INT64, corners);
  if (mpi_any(points_.empty() || cells.empty() || three != 3))
    refuse(fmt::format("is no output of a fluid: its mesh {} cannot be read", mesh));
  const auto nodes = static_cast<std::int64_t>(points_.size() / 3);
  const auto strange = [&](std::int64_t node) { return node < 0 || node >= nodes; };
  const bool known = corners == 3 || corners == 4 || corners == 8;
  if (mpi_any(!known || std::any_of(cells.begin(), cells.end(), strange)))
    refuse(fmt::format("is damaged: the cells of its mesh {} have nodes that are not there", mesh));
  corners_ = corners;
  double depth = 0;
  for (std::size_t k = 2; k < points_.size(); k += 3) depth = std::max(depth, std::abs(points_[k]));
  cell_ = corners == 3   ? Cell::triangle
          : corners == 8 ? Cell::hexahedron
          : depth > 0    ? Cell::tetrahedron
                         : Cell::quadrilateral;
  dimension_ = cell_dimension(cell_);
  const auto order = file_order(cell_);
  cells_.resize(cells.size());
  for (std::size_t c = 0; c < cells.size(); c += corners)
    for (int a = 0; a < corners; ++a) cells_[c + a] = static_cast<int>(cells[c + order[a]]);
  // Simplices of the file may be turned the other way round: our reference coordinates need no sign.
}

void FieldFile::make_bins() {
  const std::size_t count = cells_.size() / corners_;
  std::vector<std::array<double, 6>> boxes(count);
  double upper[3];
  for (int d = 0; d < 3; ++d) lower_[d] = 1e300, upper[d] = -1e300;
  sizes_.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    auto& box = boxes[c];
    box = {1e300, 1e300, 1e300, -1e300, -1e300, -1e300};
    for (int a = 0; a < corners_; ++a)
      for (int d = 0; d < 3; ++d) {
        const double x = points_[3 * static_cast<std::size_t>(cells_[c * corners_ + a]) + d];
        box[d] = std::min(box[d], x);
        box[3 + d] = std::max(box[3 + d], x);
      }
    sizes_[c] = 0;
    for (int d = 0; d < 3; ++d) {
      lower_[d] = std::min(lower_[d], box[d]);
      upper[d] = std::max(upper[d], box[3 + d]);
      sizes_[c] = std::max(sizes_[c], box[3 + d] - box[d]);
    }
    for (int d = 0; d < 3; ++d) box[d] -= 0.5 * sizes_[c], box[3 + d] += 0.5 * sizes_[c];
  }
  const double per_side = std::pow(static_cast<double>(count), 1.0 / dimension_);
  for (int d = 0; d < 3; ++d) {
    const double length = upper[d] - lower_[d];
    bins_[d] = d < dimension_ ? std::clamp(static_cast<int>(per_side), 1, 400) : 1;
    inverse_[d] = length > 0 ? bins_[d] / length : 0;
  }
  const auto bin = [&](int d, double x) {
    return std::clamp(static_cast<int>((x - lower_[d]) * inverse_[d]), 0, bins_[d] - 1);
  };
  const auto for_each_bin = [&](const std::array<double, 6>& box, auto f) {
    for (int k = bin(2, box[2]); k <= bin(2, box[5]); ++k)
      for (int j = bin(1, box[1]); j <= bin(1, box[4]); ++j)
        for (int i = bin(0, box[0]); i <= bin(0, box[3]); ++i) f((k * bins_[1] + j) * bins_[0] + i);
  };
  bin_start_.assign(static_cast<std::size_t>(bins_[0]) * bins_[1] * bins_[2] + 1, 0);
  for (const auto& box : boxes) for_each_bin(box, [&](int b) { ++bin_start_[b + 1]; });
  for (std::size_t b = 1; b < bin_start_.size(); ++b) bin_start_[b] += bin_start_[b - 1];
  bin_cells_.resize(bin_start_.back());
  std::vector<int> next(bin_start_.begin(), bin_start_.end() - 1);
  for (std::size_t c = 0; c < count; ++c)
    for_each_bin(boxes[c], [&](int b) { bin_cells_[next[b]++] = static_cast<int>(c); });
}

double FieldFile::nearest(int cell, const Vec3& x, double* xi) const {
  const int* node = &cells_[static_cast<std::size_t>(cell) * corners_];
  const bool simplex = cell_ == Cell::triangle || cell_ == Cell::tetrahedron;
  for (int d = 0; d < 3; ++d) xi[d] = d < dimension_ ? (simplex ? 0.25 : 0.5) : 0;
  Vec3 place = Vec3::Zero();
  for (int iteration = 0; iteration < 12; ++iteration) {
    double N[8], dN[8][3];
    shape(cell_, xi, N, dN);
    Mat3 J = Mat3::Zero();
    place.setZero();
    for (int a = 0; a < corners_; ++a) {
      const auto corner = vec3(&points_[3 * static_cast<std::size_t>(node[a])]);
      place += N[a] * corner;
      J += corner * vec3(dN[a]).transpose();
    }
    if (dimension_ == 2) J(2, 2) = 1;
    const Vec3 more = J.inverse() * (x - place);
    double largest = 0;
    for (int d = 0; d < dimension_; ++d) {
      const double before = xi[d];
      xi[d] = std::clamp(xi[d] + more[d], simplex ? -1.0 : 0.0, 1.0);
      largest = std::max(largest, std::abs(xi[d] - before));
    }
    if (simplex) {  // back into the cell along the gradient of what exceeds it
      for (int d = 0; d < dimension_; ++d) xi[d] = std::max(xi[d], 0.0);
      double sum = 0;
      for (int d = 0; d < dimension_; ++d) sum += xi[d];
      if (sum > 1)
        for (int d = 0; d < dimension_; ++d) xi[d] /= sum;
      break;  // an affine map needs no second step
    }
    if (largest < 1e-14) break;
  }
  double N[8], dN[8][3];
  shape(cell_, xi, N, dN);
  place.setZero();
  for (int a = 0; a < corners_; ++a) place += N[a] * vec3(&points_[3 * static_cast<std::size_t>(node[a])]);
  return (x - place).norm();
}

FieldFile::Place FieldFile::find(const Vec3& x) const {
  int b[3];
  for (int d = 0; d < 3; ++d) b[d] = std::clamp(static_cast<int>((x[d] - lower_[d]) * inverse_[d]), 0, bins_[d] - 1);
  const int bin = (b[2] * bins_[1] + b[1]) * bins_[0] + b[0];
  Place best;
  double least = 1e300;
  for (int k = bin_start_[bin]; k < bin_start_[bin + 1]; ++k) {
    const int cell = bin_cells_[k];
    double xi[3];
    const double distance = nearest(cell, x, xi);
    if (distance < least && distance <= sizes_[cell]) {
      least = distance;
      best.cell = cell;
      std::copy_n(xi, 3, best.xi);
      if (distance < 1e-9 * sizes_[cell]) break;
    }
  }
  return best;
}

bool FieldFile::has(const std::string& field) const {
  int components = 0;
  return !mpi_any(read_all<double>(path_, field, H5T_NATIVE_DOUBLE, components).empty());
}

std::vector<double> FieldFile::sample(const std::string& field, int components, const std::vector<Vec3>& places) const {
  int there = 0;
  const auto values = read_all<double>(path_, field, H5T_NATIVE_DOUBLE, there);
  if (mpi_any(there != components || values.size() != points_.size() / 3 * components))
    refuse(fmt::format("has no field {} with {} component{}", field, components, components > 1 ? "s" : ""));
  std::vector<double> result(places.size() * components, 0.0);
  bool missing = false;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Place place = find(places[k]);
    missing = missing || place.cell < 0;
    if (place.cell < 0) continue;
    double N[8], dN[8][3];
    shape(cell_, place.xi, N, dN);
    for (int a = 0; a < corners_; ++a)
      for (int d = 0; d < components; ++d)
        result[k * components + d] +=
            N[a] *
            values[static_cast<std::size_t>(cells_[static_cast<std::size_t>(place.cell) * corners_ + a]) * components +
                   d];
  }
  if (mpi_any(missing)) refuse("does not cover this mesh: parts of it lie outside the earlier one");
  return result;
}

}  // namespace silt
