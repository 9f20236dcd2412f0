#pragma once
#include <mpi.h>

#include <vector>

#include "particles/neighbours.hpp"
#include "particles/store.hpp"

namespace silt {

/// The ghosts of a rank: copies of other ranks' particles near its own. Their positions are those of the owner, not
/// shifted across periodic sides, so that distances between nearest images have the same bits on both ranks.
class Halo {
 public:
  explicit Halo(MPI_Comm communicator) : communicator_(communicator) {}

  /// Fetches the ghosts: every other rank's particles whose surface, across periodic sides too, is nearer than `gap` to
  /// that of an owned one, and no others. `own`: bins of the owned particles in the grid; `reach`: at least the
  /// distance of the centres of any such two. Collective.
  void build(Store& store, const Periods& periods, const CellGrid& grid, const Bins& own, double reach, double gap);
  /// Begins to refresh position, velocity, spin and the columns that change in every step of the ghosts; finish() ends
  /// it. In between the ghosts are those of before. `way`: m, no owned particle has come further since the last
  /// begin(). Collective among neighbours.
  void begin(const Store& store, double way);
  /// Between begin() and finish(): lets the messages go on, which wait for their ranks to look at them.
  void poke();
  /// Nothing where nothing has begun. Returns how far any ghost may have come since the last begin(), m.
  double finish(Store& store);
  bool under_way() const { return !requests_.empty(); }
  /// Bytes of ghosts that this rank sends in one begin(), besides the way to each neighbour.
  std::size_t bytes(const Store& store) const {
    return send_index_.size() * (motion_width_ + store.columns.ghost_width(false)) * sizeof(double);
  }

 private:
  static constexpr int motion_width_ = 9;  ///< doubles of a ghost in begin(), before its columns
  struct Offer;
  /// Ranks whose particles may touch this one's, with what this rank would send.
  std::vector<Offer> offer(const Store& store, const Periods& periods, double reach);
  /// Has the others take of the offers what they need.
  void agree(std::vector<Offer>& offers, const Periods& periods, const CellGrid& grid, const Bins& own, double gap);
  void fetch(Store& store);
  /// Where the record of ghost `first`, of the n-th neighbour, stands in a buffer of begin(): behind each neighbour's
  /// there is the way.
  std::size_t place(int first, std::size_t n, int width) const { return static_cast<std::size_t>(first) * width + n; }

  MPI_Comm communicator_;
  std::vector<int> send_rank_, send_start_, send_index_;  ///< per neighbour a run of send_index_
  std::vector<int> receive_rank_, receive_start_;
  std::vector<double> send_buffer_, receive_buffer_;
  std::vector<MPI_Request> requests_;  ///< not empty between begin() and finish()
};

}  // namespace silt
