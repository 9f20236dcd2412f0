#pragma once
#include <string>
#include <vector>

#include "base/element.hpp"
#include "base/vector.hpp"

namespace silt {

/// The nodal fields of an earlier run on its own mesh, as its output holds them (`<output>/fluid/000012.h5`, and the
/// mesh beside it), to be evaluated at other places. Every rank reads the whole file, so any number of ranks serves.
class FieldFile {
 public:
  /// Throws UserError naming `option` when the file cannot be read or is no output of the fluid. Collective.
  FieldFile(const std::string& option, const std::string& path);

  bool has(const std::string& field) const;
  /// [places][components] the field at each place, by the elements' own functions. A place outside the mesh takes the
  /// value of the nearest point of the mesh when it lies no further off than a cell's size (meshes of one curved
  /// boundary differ); further off: UserError, on every rank. Collective.
  std::vector<double> sample(const std::string& field, int components, const std::vector<Vec3>& places) const;

 private:
  struct Place {
    int cell = -1;
    double xi[3] = {0, 0, 0};
  };
  void read_mesh();
  void make_bins();
  /// Nearest point of a cell to x: reference coordinates within the cell; returns the distance, m.
  double nearest(int cell, const Vec3& x, double* xi) const;
  Place find(const Vec3& x) const;
  [[noreturn]] void refuse(const std::string& what) const;

  std::string option_, path_;
  Cell cell_ = Cell::hexahedron;
  int dimension_ = 3, corners_ = 8;
  std::vector<double> points_;  ///< [points][3] m
  std::vector<int> cells_;      ///< [cells][corners_], nodes in our order
  std::vector<double> sizes_;   ///< [cells] m, longest edge
  // Bins of cells, to find those near a place.
  double lower_[3] = {0, 0, 0}, inverse_[3] = {0, 0, 0};
  int bins_[3] = {1, 1, 1};
  std::vector<int> bin_start_, bin_cells_;
};

}  // namespace silt
