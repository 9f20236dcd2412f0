#include "particles/halo.hpp"

#include <algorithm>
#include <cstdint>

#include "particles/log_event.hpp"
#include "particles/occupied_cells.hpp"

namespace silt {
namespace {

constexpr int tag = 81;

OccupiedCells::Extent extent_of(const Store& store) {
  OccupiedCells::Extent extent{};
  extent.particles = store.owned;
  for (int p = 0; p < store.owned; ++p)
    for (int d = 0; d < 3; ++d) {
      const double x = store.motion[p].position[d];
      extent.lower[d] = p == 0 ? x : std::min(extent.lower[d], x);
      extent.upper[d] = p == 0 ? x : std::max(extent.upper[d], x);
    }
  return extent;
}

}  // namespace

struct Halo::Offer {
  int rank;
  std::vector<int> particles;
  std::vector<double> spheres;       ///< x, y, z, radius of each
  std::vector<unsigned char> taken;  ///< 1 for those the other rank needs
};

std::vector<Halo::Offer> Halo::offer(const Store& store, const Periods& periods, double reach) {
  int size = 1, me = 0;
  MPI_Comm_size(communicator_, &size);
  MPI_Comm_rank(communicator_, &me);
  using Extent = OccupiedCells::Extent;
  constexpr int width = sizeof(Extent) / sizeof(double);
  const Extent mine = extent_of(store);
  std::vector<Extent> all(size);
  MPI_Allgather(&mine, width, MPI_DOUBLE, all.data(), width, MPI_DOUBLE, communicator_);
  std::vector<Offer> offers;
  for (int rank = 0; rank < size; ++rank)
    if (rank != me && mine.particles > 0 && all[rank].particles > 0 &&
        distance_square(mine, all[rank], periods) < reach * reach)
      offers.push_back({rank, {}, {}, {}});

  OccupiedCells cells(mine, reach);
  for (int p = 0; p < store.owned; ++p) cells.mark(store.motion[p].position);
  std::vector<OccupiedCells> theirs;
  theirs.reserve(offers.size());
  requests_.clear();
  for (const Offer& one : offers) {
    auto& bits = theirs.emplace_back(all[one.rank], reach).bits();
    MPI_Irecv(bits.data(), static_cast<int>(bits.size()), MPI_UINT64_T, one.rank, tag, communicator_,
              &requests_.emplace_back());
    MPI_Isend(cells.bits().data(), static_cast<int>(cells.bits().size()), MPI_UINT64_T, one.rank, tag, communicator_,
              &requests_.emplace_back());
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  for (std::size_t n = 0; n < offers.size(); ++n) {
    theirs[n].spread();
    for (int p = 0; p < store.owned; ++p) {
      const Motion& motion = store.motion[p];
      if (!theirs[n].near(motion.position, periods)) continue;
      offers[n].particles.push_back(p);
      offers[n].spheres.insert(offers[n].spheres.end(), motion.position, motion.position + 4);
    }
  }
  return offers;
}

void Halo::agree(std::vector<Offer>& offers, const Periods& periods, const CellGrid& grid, const Bins& own,
                 double gap) {
  requests_.clear();
  for (Offer& one : offers) {
    one.taken.resize(one.particles.size());
    MPI_Irecv(one.taken.data(), static_cast<int>(one.taken.size()), MPI_UNSIGNED_CHAR, one.rank, tag + 2, communicator_,
              &requests_.emplace_back());
    MPI_Isend(one.spheres.data(), static_cast<int>(one.spheres.size()), MPI_DOUBLE, one.rank, tag + 1, communicator_,
              &requests_.emplace_back());
  }
  std::vector<std::vector<unsigned char>> answers(offers.size());
  std::vector<double> spheres;
  for (std::size_t n = 0; n < offers.size(); ++n) {
    MPI_Status status;
    int count = 0;
    MPI_Probe(offers[n].rank, tag + 1, communicator_, &status);
    MPI_Get_count(&status, MPI_DOUBLE, &count);
    spheres.resize(count);
    MPI_Recv(spheres.data(), count, MPI_DOUBLE, offers[n].rank, tag + 1, communicator_, MPI_STATUS_IGNORE);
    int needed = 0;
    for (int k = 0; k < count; k += 4) {
      answers[n].push_back(any_within(grid, own, periods, &spheres[k], spheres[k + 3], gap));
      needed += answers[n].back();
    }
    MPI_Isend(answers[n].data(), count / 4, MPI_UNSIGNED_CHAR, offers[n].rank, tag + 2, communicator_,
              &requests_.emplace_back());
    if (needed == 0) continue;
    receive_rank_.push_back(offers[n].rank);
    receive_start_.push_back(receive_start_.back() + needed);
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  for (const Offer& one : offers) {
    for (std::size_t k = 0; k < one.particles.size(); ++k)
      if (one.taken[k]) send_index_.push_back(one.particles[k]);
    if (static_cast<int>(send_index_.size()) == send_start_.back()) continue;
    send_rank_.push_back(one.rank);
    send_start_.push_back(static_cast<int>(send_index_.size()));
  }
}

void Halo::build(Store& store, const Periods& periods, const CellGrid& grid, const Bins& own, double reach,
                 double gap) {
  store.ghosts = 0;
  store.id.resize(store.owned);
  send_rank_.clear(), send_index_.clear(), receive_rank_.clear();
  send_start_.assign(1, 0), receive_start_.assign(1, 0);
  int size = 1;
  MPI_Comm_size(communicator_, &size);
  if (size == 1) return;
  static const PetscLogEvent event = log_event("SiltGhostLists");
  const Logged logged(event);
  auto offers = offer(store, periods, reach);
  agree(offers, periods, grid, own, gap);
  fetch(store);
}

void Halo::fetch(Store& store) {
  store.ghosts = receive_start_.back();
  store.reserve(store.all());
  store.columns.clear(store.owned, store.all());
  store.id.resize(store.all());
  const int width = 13 + store.columns.ghost_width(true);  // motion, rotation, id and columns
  send_buffer_.resize(send_index_.size() * width);
  receive_buffer_.resize(static_cast<std::size_t>(store.ghosts) * width);
  for (std::size_t k = 0; k < send_index_.size(); ++k) {
    double* record = &send_buffer_[k * width];
    __builtin_memcpy(record, &store.motion[send_index_[k]], sizeof(Motion));
    __builtin_memcpy(record + 8, &store.rotation[send_index_[k]], sizeof(Rotation));
    __builtin_memcpy(record + 12, &store.id[send_index_[k]], sizeof(double));
    store.columns.gather_ghost(send_index_[k], true, record + 13);
  }
  requests_.clear();
  for (std::size_t n = 0; n < receive_rank_.size(); ++n)
    MPI_Irecv(&receive_buffer_[static_cast<std::size_t>(receive_start_[n]) * width],
              (receive_start_[n + 1] - receive_start_[n]) * width, MPI_DOUBLE, receive_rank_[n], tag + 3, communicator_,
              &requests_.emplace_back());
  for (std::size_t n = 0; n < send_rank_.size(); ++n)
    MPI_Isend(&send_buffer_[static_cast<std::size_t>(send_start_[n]) * width],
              (send_start_[n + 1] - send_start_[n]) * width, MPI_DOUBLE, send_rank_[n], tag + 3, communicator_,
              &requests_.emplace_back());
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  requests_.clear();
  for (int k = 0; k < store.ghosts; ++k) {
    const double* record = &receive_buffer_[static_cast<std::size_t>(k) * width];
    __builtin_memcpy(&store.motion[store.owned + k], record, sizeof(Motion));
    __builtin_memcpy(&store.rotation[store.owned + k], record + 8, sizeof(Rotation));
    __builtin_memcpy(&store.id[store.owned + k], record + 12, sizeof(double));
    store.columns.scatter_ghost(store.owned + k, true, record + 13);
    store.present[store.owned + k] = store.previous[store.owned + k] = Load{};
  }
}

void Halo::begin(const Store& store, double way) {
  static const PetscLogEvent event = log_event("SiltGhosts");  // on every rank, in the same order
  if (send_rank_.empty() && receive_rank_.empty()) return;
  const Logged logged(event);
  const int width = motion_width_ + store.columns.ghost_width(false);
  constexpr int ahead = 16;  // they lie anywhere in memory
  const int last = static_cast<int>(send_index_.size()) - 1;
  requests_.clear();
  for (std::size_t n = 0; n < receive_rank_.size(); ++n)
    MPI_Irecv(&receive_buffer_[place(receive_start_[n], n, width)],
              (receive_start_[n + 1] - receive_start_[n]) * width + 1, MPI_DOUBLE, receive_rank_[n], tag + 4,
              communicator_, &requests_.emplace_back());
  for (std::size_t n = 0; n < send_rank_.size(); ++n) {
    double* record = &send_buffer_[place(send_start_[n], n, width)];
    for (int k = send_start_[n]; k < send_start_[n + 1]; ++k, record += width) {
      const int coming = send_index_[std::min(k + ahead, last)];
      __builtin_prefetch(&store.motion[coming]);
      __builtin_prefetch(&store.rotation[coming]);
      const Motion& motion = store.motion[send_index_[k]];
      for (int d = 0; d < 3; ++d) {
        record[d] = motion.position[d];
        record[3 + d] = motion.velocity[d];
        record[6 + d] = store.rotation[send_index_[k]].spin[d];
      }
      if (width > motion_width_) store.columns.gather_ghost(send_index_[k], false, record + motion_width_);
    }
    *record = way;
    MPI_Isend(&send_buffer_[place(send_start_[n], n, width)], (send_start_[n + 1] - send_start_[n]) * width + 1,
              MPI_DOUBLE, send_rank_[n], tag + 4, communicator_, &requests_.emplace_back());
  }
}

void Halo::poke() {
  int done;
  MPI_Testall(static_cast<int>(requests_.size()), requests_.data(), &done, MPI_STATUSES_IGNORE);
}

double Halo::finish(Store& store) {
  static const PetscLogEvent event = log_event("SiltGhostsEnd");
  if (requests_.empty()) return 0;
  const Logged logged(event);
  const int width = motion_width_ + store.columns.ghost_width(false);
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  requests_.clear();
  double way = 0;
  for (std::size_t n = 0; n < receive_rank_.size(); ++n) {
    const double* record = &receive_buffer_[place(receive_start_[n], n, width)];
    for (int k = store.owned + receive_start_[n]; k < store.owned + receive_start_[n + 1]; ++k, record += width) {
      Motion& motion = store.motion[k];
      for (int d = 0; d < 3; ++d) {
        motion.position[d] = record[d];
        motion.velocity[d] = record[3 + d];
        store.rotation[k].spin[d] = record[6 + d];
      }
      if (width > motion_width_) store.columns.scatter_ghost(k, false, record + motion_width_);
      store.present[k] = Load{};  // sums up forces that their owner computes too
    }
    way = std::max(way, *record);
  }
  return way;
}

}  // namespace silt
