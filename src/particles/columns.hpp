#pragma once
#include <functional>
#include <string>
#include <vector>

#include "particles/aligned.hpp"

namespace silt {

struct Seed;
class Rearrangement;

/// When the copies of a particle on other ranks (ghosts) get the values of a column.
enum class GhostValues {
  none,        ///< never: their rows are zero
  at_rebuild,  ///< when the neighbour lists are made: for values that do not change between
  every_step   ///< in every substep, with position and velocity
};

/// A quantity that particles carry besides their motion because a model asks for it: temperature, charge, dipole
/// moment.
struct ColumnRequest {
  std::string name;  ///< as in the output
  int width = 1;     ///< doubles a particle
  GhostValues ghosts = GhostValues::none;
  bool output = true;                                        ///< written to the particle series
  std::function<void(const Seed&, double* row)> start = {};  ///< value of a new particle; zero without it
  bool needed = true;                                        ///< a restart refuses a file without it, else zero
};

/// The named columns of a run. Models register theirs before the first step; without any there is nothing to store or
/// to send. Rows follow their particles through sorting, migration, snapshots and restarts; indices of particles are
/// those of Store, columns are numbered in the order of registration.
class Columns {
 public:
  /// A new column, or the number of the one of the same name and width that is there already (it then keeps the wider
  /// of the two demands on ghosts). The `particles` there are get its starting value zero. Throws std::logic_error for
  /// the same name with another width.
  int add(const ColumnRequest& request, int particles = 0);
  /// Number of a column, -1 when nobody asked for it.
  int find(const std::string& name) const;
  int count() const { return static_cast<int>(columns_.size()); }
  const ColumnRequest& request(int column) const { return columns_[column].request; }
  /// Where a column begins in the row of gather().
  int offset(int column) const;
  /// Doubles a particle, over all columns.
  int width() const { return width_; }

  /// [owned + ghosts][width]
  double* values(int column) { return columns_[column].values.data(); }
  const double* values(int column) const { return columns_[column].values.data(); }
  double* row(int column, int p) { return values(column) + static_cast<long>(p) * columns_[column].request.width; }
  const double* row(int column, int p) const {
    return values(column) + static_cast<long>(p) * columns_[column].request.width;
  }

  // What the machinery of the particles does with them.

  /// Makes room for `particles` and two that pad.
  void reserve(int particles);
  /// Zeroes the rows from `first` to `last`, exclusive.
  void clear(int first, int last);
  /// The starting values of a new particle p.
  void start(int p, const Seed& seed);
  /// All values of particle p in one row of width() doubles, and back.
  void gather(int p, double* row) const;
  void scatter(int p, const double* row);
  void reorder(const Rearrangement& order);
  /// Of the values, as counted by their containers. B
  std::size_t bytes() const;
  /// Doubles that a ghost gets, at a rebuild or in every step.
  int ghost_width(bool rebuild) const;
  /// The values a ghost gets.
  void gather_ghost(int p, bool rebuild, double* row) const;
  void scatter_ghost(int p, bool rebuild, const double* row);
  /// The rows of the first `particles`, [particles][width()], and back.
  std::vector<double> save(int particles) const;
  void restore(const std::vector<double>& saved, int particles);

 private:
  struct Column {
    ColumnRequest request;
    Aligned<double> values;
    bool for_ghosts(bool rebuild) const {
      return request.ghosts == GhostValues::every_step || (rebuild && request.ghosts == GhostValues::at_rebuild);
    }
  };
  std::vector<Column> columns_;
  int width_ = 0, room_ = 0;
};

}  // namespace silt
