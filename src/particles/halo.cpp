#include "particles/halo.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "particles/log_event.hpp"

namespace silt {
namespace {

constexpr int tag = 71;

/// Box around a rank's particles; empty when lower > upper.
struct Bounds {
  std::array<double, 3> lower, upper;
};

/// Squared distance of x from the box, or from its nearest periodic image.
double distance_square(const Bounds& box, const double* x, const Periods& periods) {
  double square = 0;
  for (int d = 0; d < 3; ++d) {
    double gap = std::max({box.lower[d] - x[d], x[d] - box.upper[d], 0.0});
    const double length = periods.length[d];
    if (length > 0) {
      gap = std::min(gap, std::max({box.lower[d] - (x[d] - length), (x[d] - length) - box.upper[d], 0.0}));
      gap = std::min(gap, std::max({box.lower[d] - (x[d] + length), (x[d] + length) - box.upper[d], 0.0}));
    }
    square += gap * gap;
  }
  return square;
}

}  // namespace

void Halo::build(Store& store, const Periods& periods, double cutoff) {
  int size = 1, me = 0;
  MPI_Comm_size(communicator_, &size);
  MPI_Comm_rank(communicator_, &me);
  store.ghosts = 0;
  store.id.resize(store.owned);
  send_rank_.clear(), send_index_.clear(), receive_rank_.clear();
  send_start_.assign(1, 0), receive_start_.assign(1, 0);
  if (size == 1) return;

  constexpr double far = std::numeric_limits<double>::max();
  Bounds mine{{far, far, far}, {-far, -far, -far}};
  for (int p = 0; p < store.owned; ++p)
    for (int d = 0; d < 3; ++d) {
      mine.lower[d] = std::min(mine.lower[d], store.motion[p].position[d]);
      mine.upper[d] = std::max(mine.upper[d], store.motion[p].position[d]);
    }
  std::vector<Bounds> box(size);
  MPI_Allgather(&mine, 6, MPI_DOUBLE, box.data(), 6, MPI_DOUBLE, communicator_);

  const double square = cutoff * cutoff;
  std::vector<int> sends(size, 0), receives(size, 0);
  for (int rank = 0; rank < size; ++rank) {
    if (rank == me || box[rank].lower[0] > box[rank].upper[0]) continue;
    for (int p = 0; p < store.owned; ++p)
      if (distance_square(box[rank], store.motion[p].position, periods) < square) send_index_.push_back(p);
    sends[rank] = static_cast<int>(send_index_.size()) - send_start_.back();
    if (sends[rank] == 0) continue;
    send_rank_.push_back(rank);
    send_start_.push_back(static_cast<int>(send_index_.size()));
  }
  MPI_Alltoall(sends.data(), 1, MPI_INT, receives.data(), 1, MPI_INT, communicator_);
  for (int rank = 0; rank < size; ++rank)
    if (receives[rank] > 0) {
      receive_rank_.push_back(rank);
      receive_start_.push_back(receive_start_.back() + receives[rank]);
    }

  static const PetscLogEvent event = log_event("SiltGhostLists");
  const Logged logged(event);
  store.ghosts = receive_start_.back();
  store.reserve(store.all());
  store.columns.clear(store.owned, store.all());
  store.id.resize(store.all());
  const int width = 13 + store.columns.ghost_width(true);  // a Motion, the id and the columns
  send_buffer_.resize(send_index_.size() * width);
  receive_buffer_.resize(static_cast<std::size_t>(store.ghosts) * width);
  for (std::size_t k = 0; k < send_index_.size(); ++k) {
    double* record = &send_buffer_[k * width];
    __builtin_memcpy(record, &store.motion[send_index_[k]], sizeof(Motion));
    __builtin_memcpy(record + 12, &store.id[send_index_[k]], sizeof(double));
    store.columns.gather_ghost(send_index_[k], true, record + 13);
  }
  requests_.clear();
  for (std::size_t n = 0; n < receive_rank_.size(); ++n)
    MPI_Irecv(&receive_buffer_[static_cast<std::size_t>(receive_start_[n]) * width],
              (receive_start_[n + 1] - receive_start_[n]) * width, MPI_DOUBLE, receive_rank_[n], tag, communicator_,
              &requests_.emplace_back());
  for (std::size_t n = 0; n < send_rank_.size(); ++n)
    MPI_Isend(&send_buffer_[static_cast<std::size_t>(send_start_[n]) * width],
              (send_start_[n + 1] - send_start_[n]) * width, MPI_DOUBLE, send_rank_[n], tag, communicator_,
              &requests_.emplace_back());
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  for (int k = 0; k < store.ghosts; ++k) {
    const double* record = &receive_buffer_[static_cast<std::size_t>(k) * width];
    __builtin_memcpy(&store.motion[store.owned + k], record, sizeof(Motion));
    __builtin_memcpy(&store.id[store.owned + k], record + 12, sizeof(double));
    store.columns.scatter_ghost(store.owned + k, true, record + 13);
    store.present[store.owned + k] = store.previous[store.owned + k] = Load{};
  }
}

void Halo::forward(Store& store) {
  if (send_rank_.empty() && receive_rank_.empty()) return;
  static const PetscLogEvent event = log_event("SiltGhosts");
  const Logged logged(event);
  const int width = motion_width_ + store.columns.ghost_width(false);
  requests_.clear();
  for (std::size_t n = 0; n < receive_rank_.size(); ++n)
    MPI_Irecv(&receive_buffer_[static_cast<std::size_t>(receive_start_[n]) * width],
              (receive_start_[n + 1] - receive_start_[n]) * width, MPI_DOUBLE, receive_rank_[n], tag + 1, communicator_,
              &requests_.emplace_back());
  for (std::size_t n = 0; n < send_rank_.size(); ++n) {
    for (int k = send_start_[n]; k < send_start_[n + 1]; ++k) {
      const Motion& motion = store.motion[send_index_[k]];
      double* record = &send_buffer_[static_cast<std::size_t>(k) * width];
      for (int d = 0; d < 3; ++d) {
        record[d] = motion.position[d];
        record[3 + d] = motion.velocity[d];
        record[6 + d] = motion.spin[d];
      }
      store.columns.gather_ghost(send_index_[k], false, record + motion_width_);
    }
    MPI_Isend(&send_buffer_[static_cast<std::size_t>(send_start_[n]) * width],
              (send_start_[n + 1] - send_start_[n]) * width, MPI_DOUBLE, send_rank_[n], tag + 1, communicator_,
              &requests_.emplace_back());
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  for (int k = 0; k < store.ghosts; ++k) {
    const double* record = &receive_buffer_[static_cast<std::size_t>(k) * width];
    Motion& motion = store.motion[store.owned + k];
    for (int d = 0; d < 3; ++d) {
      motion.position[d] = record[d];
      motion.velocity[d] = record[3 + d];
      motion.spin[d] = record[6 + d];
    }
    store.columns.scatter_ghost(store.owned + k, false, record + motion_width_);
    store.present[store.owned + k] = Load{};  // sums up forces that their owner computes too
  }
}

}  // namespace silt
